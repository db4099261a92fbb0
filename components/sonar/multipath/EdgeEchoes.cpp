#include "components/sonar/multipath/EdgeEchoes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "components/acoustics/Wedge.hpp"
#include "components/sonar/surfaces/FacetLobes.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;

constexpr double main_lobe = 0.75 * pi;  ///< Max phase at the end of a length that echoes as a whole [rad].
constexpr double min_section = 1e-10;    ///< Fainter echoes, below -100 dB, are omitted [m^2].
constexpr int max_pieces = 16;           ///< Max points that represent the glinting part of a rough edge [1].

double square(double x) { return x * x; }

/** Returns 1 / L^2 of the part of a length that is in phase at a range [1/m^2]. */
double perSquareLength(double length, double wavelength, double range) {
    return 1 / square(length) + 2 / (wavelength * range);
}

/** An edge as one sonar sees it. */
struct SeenEdge {
    const PlacedEdge& edge;
    glm::dvec3 along;     ///< Unit direction.
    double length, foot;  ///< Length of the edge, and the sonar's projection on its line [m].
    double aside;         ///< Distance of the sonar from the line [m].
    double strength;      ///< (R D / 2 pi)^2 [1].

    glm::dvec3 at(double place) const { return edge.from + place * along; }
    double computeRange(double place) const { return std::hypot(aside, place - foot); }
    double cosineAt(double place) const { return std::abs(place - foot) / computeRange(place); }
    /** Returns the section of diffraction at one end [m^2]. */
    double endSection(double place) const { return strength * square(edge.wavelength / (4 * pi * cosineAt(place))); }
};

/** Appends the coherent echo along the edge, `share` of it. */
void appendSmooth(const SeenEdge& seen, double share, double per_square, std::vector<EdgeEcho>& echoes) {
    const double nearest = std::clamp(seen.foot, 0.0, seen.length);
    const double phase = 2 * pi / seen.edge.wavelength * seen.cosineAt(nearest) / std::sqrt(per_square);
    if (phase < main_lobe) {
        const double lobe = phase > 1e-6 ? square(std::sin(phase) / phase) : 1;
        echoes.push_back({seen.at(nearest), seen.strength / per_square * share * lobe});
        return;
    }
    for (const double end : {0.0, seen.length}) echoes.push_back({seen.at(end), share * seen.endSection(end)});
}

/** Appends the glint of relief that tilts the edge locally. */
void appendRough(const SeenEdge& seen, double share, double square_slope, double spacing,
                 std::vector<EdgeEcho>& echoes) {
    const double slope = std::sqrt(square_slope), reach = 2 * slope * seen.aside;
    const double low = std::max(0.0, seen.foot - reach), high = std::min(seen.length, seen.foot + reach);
    if (!(low < high)) return;
    const int count =
        static_cast<int>(std::clamp(std::ceil((high - low) / (spacing * seen.aside)), 1.0, 1.0 * max_pieces));
    const double piece = (high - low) / count;
    const auto integral = [&](double place) { return std::erf((place - seen.foot) / (slope * seen.aside)); };
    for (int i = 0; i < count; ++i) {
        const double from = low + i * piece;
        const double glint = seen.edge.wavelength * seen.aside / 4 * (integral(from + piece) - integral(from));
        echoes.push_back({seen.at(from + piece / 2), seen.strength * (1 - share) * glint});
    }
}

}  // namespace

double PlacedEdge::coefficient(const glm::dvec3& sonar) const {
    const glm::dvec3 along = glm::normalize(to - from), back = sonar - from;
    const glm::dvec3 across = back - glm::dot(back, along) * along, other = glm::cross(along, inward[0]);
    const auto computeAngle = [&](const glm::dvec3& v) {
        const double angle = std::atan2(glm::dot(v, other), glm::dot(v, inward[0]));
        return angle < 0 ? angle + 2 * pi : angle;
    };
    const double second = computeAngle(inward[1]), sonar_at = computeAngle(across);
    const bool is_sheet = glm::length(inward[1] - inward[0]) < 1e-3;
    const bool between = !is_sheet && sonar_at < second;  // in the water from the first face to the second
    const double exterior = is_sheet ? 2 * pi : between ? second : 2 * pi - second;
    if (exterior <= pi) return 0;
    const double from_first = is_sheet || between ? sonar_at : 2 * pi - sonar_at;
    const auto faces = reflection < 0 ? acoustics::WedgeFaces::Soft : acoustics::WedgeFaces::Rigid;
    const acoustics::WedgeEcho echo = acoustics::wedgeEcho(faces, exterior, std::clamp(from_first, 0.0, exterior));
    double sum = echo.fringe, passed = 1;
    const double range = glm::length(across), number = 2 * pi / wavelength;
    for (size_t k = 0; k < 2; ++k) {
        const double width = 1 / std::sqrt(perSquareLength(widths[k], wavelength, range));
        const double cosine = std::clamp(glm::dot(across, inward[k]) / range, -1.0, 1.0);
        if (are_enclosed[k] && number * width * std::abs(cosine) > main_lobe) sum += echo.optics[k];
        const double from_face = k == 0 ? from_first : exterior - from_first;
        if (from_face < pi / 2)
            passed = acoustics::grazingShare(is_sheet, number * widths[k] * range / (widths[k] + range), from_face);
    }
    return passed * passed * sum;
}

void appendEdgeEchoes(const PlacedEdge& edge, const glm::dvec3& sonar, double spacing, std::vector<EdgeEcho>& echoes) {
    const glm::dvec3 whole = edge.to - edge.from;
    const double length = glm::length(whole);
    if (!(length > 0) || edge.reflection == 0) return;
    const glm::dvec3 along = whole / length;
    const double foot = glm::dot(sonar - edge.from, along);
    const double aside = glm::length(sonar - edge.from - foot * along);
    if (!(aside > edge.wavelength)) return;
    const double strength = square(edge.reflection * edge.coefficient(sonar) / (2 * pi));
    const SeenEdge seen{edge, along, length, foot, aside, strength};
    const double range = seen.computeRange(std::clamp(foot, 0.0, length));
    const double per_square = perSquareLength(length, edge.wavelength, range);
    const double wave = square(edge.wavelength) * per_square / (4 * pi), all = edge.square_slope + wave;
    const double share = std::sqrt(wave / all);
    appendSmooth(seen, share, per_square, echoes);
    if (edge.square_slope > 0) appendRough(seen, share, all, spacing, echoes);
}

EdgeEchoes::EdgeEchoes(const RenderPlan& plan, const types::Geometry& geometry)
    : plan_(plan),
      geometry_(geometry),
      points_(plan, geometry),
      sightlines_(geometry, Sightlines::Lines::Many),
      walls_(plan),
      spacing_((plan.beams[plan.beams.size() - 1].high - plan.beams[0].low) / static_cast<double>(plan.beams.size())) {
    for (size_t i = 0; i < geometry.meshes.size(); ++i)
        of_meshes_.push_back(MeshFacts::of(geometry.meshes.shared(i))
                                 ->edges(worldFromMesh(geometry, i), plan.laws, plan.laws.sharp_turn.value()));
    for (const types::Object& object : geometry.objects) still_.push_back(object.world_from_object);
    for (size_t i = 0; i < geometry.objects.size(); ++i) addObject(i);
    places_ = still_;
    echoes_.reserve(max_pieces + 2);
}

void EdgeEchoes::updateShapes(const types::Snapshot& snapshot) {
    const auto deforms = [&](const OwnEdge& own) {
        return std::ranges::binary_search(snapshot.deformed, own.object, {}, &types::DeformedObject::object);
    };
    std::erase_if(edges_, deforms);
    for (const types::DeformedObject& deformed : snapshot.deformed) {
        const auto mesh = static_cast<size_t>(geometry_.objects[deformed.object].mesh);
        if (!of_meshes_[mesh]) continue;
        of_meshes_[mesh] = std::make_shared<const StraightEdges>(
            straightEdges(geometry_.meshes[mesh], worldFromMesh(geometry_, mesh), plan_.laws.sharp_turn.value()));
        addObject(deformed.object);
    }
    std::ranges::stable_sort(edges_, {}, &OwnEdge::object);
}

void EdgeEchoes::addObject(size_t object) {
    const auto mesh = static_cast<size_t>(geometry_.objects[object].mesh);
    if (!of_meshes_[mesh]) return;
    const glm::dmat3 mesh_from_world = glm::inverse(worldFromMesh(geometry_, mesh));
    for (const StraightEdge& own : of_meshes_[mesh]->edges) {
        PlacedEdge edge{.from = own.from, .to = own.to};
        edge.wavelength = plan_.laws.wavelength.value();
        for (size_t k = 0; k < 2; ++k) {
            const EdgeFace& face = own.faces[k];
            const auto material = static_cast<size_t>(face.material);
            const double power = 4 * pi * double{plan_.laws.records[material].law.y};
            edge.reflection += std::copysign(std::sqrt(power), double{geometry_.materials[material].reflection}) / 2;
            edge.square_slope += double{plan_.laws.records[material].law.z} / 2;
            edge.inward[k] = mesh_from_world * face.inward;
            edge.widths[k] = face.width;
            edge.are_enclosed[k] = face.is_enclosed;
        }
        if (edge.reflection != 0 && std::isfinite(glm::dot(edge.inward[0], edge.inward[1])))
            edges_.push_back({object, edge});
    }
}

size_t EdgeEchoes::add(PingInMaking& to) {
    const types::Snapshot& snapshot = to.snapshot;
    std::ranges::copy(still_, places_.begin());
    for (const types::MovedObject& moved : snapshot.moved) places_[moved.object] = moved.world_from_object;
    sightlines_.place(snapshot);
    const glm::dvec3& sonar = snapshot.sonar.position;
    const glm::dquat sonar_from_world = glm::conjugate(snapshot.sonar.orientation);
    size_t received = 0;
    for (const OwnEdge& own : edges_) {
        PlacedEdge edge = own.edge;
        const glm::dmat4& place = places_[own.object];
        edge.from = place * glm::dvec4(edge.from, 1);
        edge.to = place * glm::dvec4(edge.to, 1);
        const glm::dvec3 along = glm::normalize(edge.to - edge.from);
        for (size_t k = 0; k < 2; ++k) {
            const glm::dvec3 turned = glm::dmat3(place) * edge.inward[k];
            edge.inward[k] = turned - glm::dot(turned, along) * along;
            const double scale = glm::length(edge.inward[k]);
            edge.widths[k] *= scale;
            edge.inward[k] /= scale;
        }
        echoes_.clear();
        appendEdgeEchoes(edge, sonar, spacing_, echoes_);
        bool any = false;
        for (const EdgeEcho& echo : echoes_) {
            TargetPath path;
            path.length = glm::distance(sonar, echo.at);
            if (!(echo.section > min_section && path.length > 0 && path.length < plan_.grid.range_max)) continue;
            path.direction = sonar_from_world * ((echo.at - sonar) / path.length);
            if (!points_.mayReceive(path.direction)) continue;
            WallArrivals arrivals;
            path.power = walls_.passed(sightlines_, sonar, echo.at, path.walls, arrivals);
            path.ringing = arrivals.ringing;
            if (arrivals.areDelayed()) path.arrivals = &arrivals;
            if (path.power > 0) any |= points_.addAlong(path, 10 * std::log10(echo.section), to);
        }
        received += any ? 1 : 0;
    }
    return received;
}

}  // namespace insonify::sonar
