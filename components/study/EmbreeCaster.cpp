#include "components/study/EmbreeCaster.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>

namespace insonify::study {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr int packet = 8;

/** A perspective image of part of the fan: u = tan(azimuth - centre), v = tan(elevation) sqrt(1 + u u). */
struct Image {
    double centre, half_u, half_v;
    int columns, rows;
    glm::dmat3 world_from_image;
    double du() const { return 2 * half_u / columns; }
    double dv() const { return 2 * half_v / rows; }
};

std::vector<Image> imagesOf(const types::Pose& sonar, const sonar::SonarConfig& config) {
    const double fov = config.field_of_view_deg * degree;
    const int count = std::max(config.least_slabs, static_cast<int>(std::ceil(config.field_of_view_deg / 60 - 1e-9)));
    std::vector<Image> images;
    for (int i = 0; i < count; ++i) {
        const double half = fov / count / 2, centre = -fov / 2 + (2 * i + 1) * half;
        const auto turn = glm::angleAxis(centre, glm::dvec3(0, 0, 1));
        images.push_back({centre, std::tan(half), std::tan(config.beam_height_deg * degree / 2) / std::cos(half),
                          (config.columnsPerBeam() * config.beam_count + count - 1) / count, config.rows(),
                          glm::mat3_cast(sonar.orientation * turn)});
    }
    return images;
}

/** What a ray has met: the plane n.p = distance about the sonar, in image axes (n of any length), and its material. */
struct Hit {
    glm::dvec3 normal;
    double distance, mu;
};

double squareAbove(double x) { return x > 0 ? x * x : 0; }

/** ACOUSTICS.md 4.3: share of a trapezoid (box a times box b, about 0) below t. */
double below(double t, double a, double b) {
    if (std::min(a, b) < 1e-6 * std::max(a, b)) return std::clamp(t / std::max(a, b) + 0.5, 0.0, 1.0);
    return (squareAbove(t + (a + b) / 2) - squareAbove(t + (a - b) / 2) - squareAbove(t - (a - b) / 2) +
            squareAbove(t - (a + b) / 2)) /
           (2 * a * b);
}

}  // namespace

struct EmbreeCaster::Tree {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    glm::dvec3 origin;                                 ///< Of the tree, in the world.
    std::vector<std::array<glm::dvec3, 3>> triangles;  ///< About the origin.
    std::vector<float> mu;                             ///< Of each triangle.

    ~Tree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    void add(const types::Geometry& geometry, const types::Object& object, const glm::dmat4& world_from_object);
    void commit();
};

void EmbreeCaster::Tree::add(const types::Geometry& geometry, const types::Object& object,
                             const glm::dmat4& world_from_object) {
    glm::dmat4 place = world_from_object;
    place[3] -= glm::dvec4(origin, 0);
    const types::Mesh& mesh = geometry.meshes[static_cast<size_t>(object.mesh)];
    for (const types::Cluster& cluster : mesh.clusters) {
        const double strength = std::pow(10, geometry.materials[static_cast<size_t>(cluster.material)].lambert_db / 10);
        for (uint32_t i = cluster.first_index; i < cluster.first_index + cluster.index_count; i += 3) {
            auto& triangle = triangles.emplace_back();
            for (uint32_t corner = 0; corner < 3; ++corner)
                triangle[corner] = glm::dvec3(place * glm::dvec4(mesh.positions[mesh.indices[i + corner]], 1));
            mu.push_back(static_cast<float>(strength));
        }
    }
}

void EmbreeCaster::Tree::commit() {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const size_t count = triangles.size();
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * count));
    auto* indices = static_cast<uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), count));
    if (count > 0 && (!vertices || !indices)) throw std::runtime_error("Embree has no memory for the scene");
    for (size_t i = 0; i < 3 * count; ++i) {
        const glm::dvec3& p = triangles[i / 3][i % 3];
        for (int axis = 0; axis < 3; ++axis) vertices[3 * i + static_cast<size_t>(axis)] = static_cast<float>(p[axis]);
        indices[i] = static_cast<uint32_t>(i);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene);
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        throw std::runtime_error("Embree cannot build the scene: error " + std::to_string(error));
}

namespace {

/** One thread's part of a ping: every so many columns of each image, into sums of its own. */
template <class Tree>
class Caster {
public:
    Caster(const Tree& tree, const types::Pose& sonar, const sonar::SonarConfig& config)
        : tree_(tree),
          config_(config),
          from_(sonar.position - tree.origin),
          bins_(static_cast<size_t>(config.bin_count)),
          bin_width_(config.range / config.bin_count),
          sums_(bins_ * static_cast<size_t>(config.beam_count)) {}

    void castColumn(const Image& image, int column) {
        u_ = (column + 0.5) * image.du() - image.half_u;
        for (int row = 0; row < image.rows; row += packet) castPacket(image, row, std::min(packet, image.rows - row));
    }
    const std::vector<double>& sums() const { return sums_; }
    double kappaMax() const { return kappa_max_; }

private:
    void castPacket(const Image& image, int first_row, int count) {
        alignas(32) int valid[packet];
        alignas(32) RTCRayHit8 rays;
        for (int i = 0; i < packet; ++i) {
            valid[i] = i < count ? -1 : 0;
            const double v = (first_row + i + 0.5) * image.dv() - image.half_v;
            const glm::dvec3 d = glm::normalize(image.world_from_image * glm::dvec3(1, u_, v));
            rays.ray.org_x[i] = static_cast<float>(from_.x), rays.ray.org_y[i] = static_cast<float>(from_.y),
            rays.ray.org_z[i] = static_cast<float>(from_.z);
            rays.ray.dir_x[i] = static_cast<float>(d.x), rays.ray.dir_y[i] = static_cast<float>(d.y),
            rays.ray.dir_z[i] = static_cast<float>(d.z);
            rays.ray.tnear[i] = static_cast<float>(config_.range_min);
            rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
            rays.ray.mask[i] = 0xffffffffu;
            rays.ray.time[i] = 0, rays.ray.flags[i] = 0;
            rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcIntersect8(valid, tree_.scene, &context, &rays);
        for (int i = 0; i < count; ++i)
            if (rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
                depositPixel(image, (first_row + i + 0.5) * image.dv() - image.half_v,
                             hitOf(image, rays.hit.primID[i]));
    }

    Hit hitOf(const Image& image, uint32_t triangle) const {
        const auto& [a, b, c] = tree_.triangles[triangle];
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        return {glm::transpose(image.world_from_image) * normal, glm::dot(normal, a - from_), tree_.mu[triangle]};
    }

    /** Shares the pixel out to the beams that its column touches. */
    void depositPixel(const Image& image, double v, const Hit& hit) {
        const double low = u_ - image.du() / 2, high = u_ + image.du() / 2;
        const double fov = config_.field_of_view_deg * degree, width = fov / config_.beam_count;
        const auto beamAt = [&](double u) { return static_cast<int>((image.centre + std::atan(u) + fov / 2) / width); };
        const double half = std::atan(image.half_u);
        const auto edge = [&](int beam) {
            return std::tan(std::clamp(beam * width - fov / 2 - image.centre, -half, half));
        };
        const int last = std::min(beamAt(high), config_.beam_count - 1);
        for (int beam = std::max(0, beamAt(low)); beam <= last; ++beam) {
            const double from = std::max(low, edge(beam)), to = std::min(high, edge(beam + 1));
            if (to > from) depositCell(image, (from + to) / 2, to - from, v, hit, beam);
        }
    }

    /** The part of the pixel about (middle, v), between curves of constant elevation, cut off at the aperture. */
    void depositCell(const Image& image, double middle, double width, double v, const Hit& hit, int beam) {
        const glm::dvec3 q(1, u_, v);
        const double length = glm::length(q), facing = glm::dot(hit.normal, q), square = length * length;
        const double cosine = std::abs(facing) / (length * glm::length(hit.normal)),
                     inverse = facing / (hit.distance * length);
        if (!(cosine > 1e-4) || !(inverse > 0)) return;
        const double slope_u = inverse * (hit.normal.y / facing - u_ / square),
                     slope_v = inverse * (hit.normal.z / facing - v / square);
        const double lean = v * u_ / (1 + u_ * u_), moved = v + lean * (middle - u_);
        const double edge = std::tan(config_.beam_height_deg * degree / 2) * std::sqrt(1 + middle * middle);
        const double top = std::min(moved + image.dv() / 2, edge), bottom = std::max(moved - image.dv() / 2, -edge);
        if (!(top > bottom)) return;
        const double centre_v = (top + bottom) / 2;
        const double along = std::abs(slope_u + slope_v * lean) * width, across = std::abs(slope_v) * (top - bottom);
        const double centre = inverse + slope_u * (middle - u_) + slope_v * (centre_v - v);
        const double solid_angle = width * (top - bottom) * std::pow(1 + middle * middle + centre_v * centre_v, -1.5);
        spread(beam, centre, std::max(along, 1e-12 * inverse), across, solid_angle * hit.mu * cosine / inverse);
    }

    /** Energy goes as 1/r^3 over inverse range; `amount` is energy times r^3. */
    void spread(int beam, double centre, double a, double b, double amount) {
        const double near = std::min(centre + (a + b) / 2, 1 / config_.range_min),
                     far = std::max(centre - (a + b) / 2, 1 / config_.range);
        if (!(near > far)) return;
        kappa_max_ = std::max(kappa_max_, (1 / far - 1 / near) / bin_width_);
        double* bins = sums_.data() + static_cast<size_t>(beam) * bins_;
        double above = near, share_above = below(near - centre, a, b);
        for (auto bin = static_cast<size_t>(1 / (near * bin_width_)); above > far && bin < bins_; ++bin) {
            const double edge = std::max(1 / (static_cast<double>(bin + 1) * bin_width_), far);
            const double share = below(edge - centre, a, b), middle = (above + edge) / 2;
            if (edge < above) bins[bin] += amount * (share_above - share) * middle * middle * middle;
            above = edge, share_above = share;
        }
    }

    const Tree& tree_;
    const sonar::SonarConfig& config_;
    glm::dvec3 from_;
    size_t bins_;
    double bin_width_;
    std::vector<double> sums_;
    double u_ = 0, kappa_max_ = 0;
};

}  // namespace

EmbreeCaster::EmbreeCaster(const types::Snapshot& scene) : tree_(std::make_unique<Tree>()) {
    tree_->origin = scene.sonar.position;
    std::vector<glm::dmat4> places;
    for (const types::Object& object : scene.geometry->objects) places.push_back(object.world_from_object);
    for (const types::MovedObject& moved : scene.moved) places[moved.object] = moved.world_from_object;
    for (size_t i = 0; i < places.size(); ++i) tree_->add(*scene.geometry, scene.geometry->objects[i], places[i]);
    tree_->commit();
}

EmbreeCaster::~EmbreeCaster() = default;

void EmbreeCaster::render(const types::Pose& sonar, const sonar::SonarConfig& config, std::vector<float>& energies) {
    const std::vector<Image> images = imagesOf(sonar, config);
    const auto threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<Caster<Tree>> casters(static_cast<size_t>(threads), Caster<Tree>(*tree_, sonar, config));
    {
        std::vector<std::jthread> running;
        for (int t = 0; t < threads; ++t)
            running.emplace_back([&, t] {
                for (const Image& image : images)
                    for (int column = t; column < image.columns; column += threads)
                        casters[static_cast<size_t>(t)].castColumn(image, column);
            });
    }
    energies.assign(casters.front().sums().size(), 0);
    kappa_max_ = 0;
    for (size_t i = 0; i < energies.size(); ++i) {
        double sum = 0;
        for (const auto& caster : casters) sum += caster.sums()[i];
        energies[i] = static_cast<float>(sum);
    }
    for (const auto& caster : casters) kappa_max_ = std::max(kappa_max_, caster.kappaMax());
}

}  // namespace insonify::study
