// insonify study multipath
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <iterator>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "components/console/Console.hpp"
#include "components/console/Json.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/commands/StudyCommand.hpp"
#include "components/study/error/ErrorAnalysis.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {

/** A received value and its expected value. */
struct EchoPoint {
    double x, received, expected;
};
struct EchoCurve {
    std::string name, title, x_label, y_label;
    std::vector<EchoPoint> points;

    double worst() const;  ///< Returns the max difference.
};

struct MultipathResult {
    std::vector<EchoCurve> curves;
    std::vector<Claim> claims;
};

/** Compares echoes by way of mirrors with the image method and with the target strengths of corner reflectors
 *  (ACOUSTICS.md 5.23, 5.25). Cases: a point target and a flat bottom under a flat surface, a target next to a wall,
 *  and turned dihedrals and trihedrals. The first echo must not change. */
MultipathResult studyMultipath();

std::string csv(const MultipathResult& result);  ///< Returns a row per point of each curve.

namespace {

using std::numbers::pi;
using types::radians;

double decibels(double ratio) { return 10 * std::log10(ratio); }

/** Returns a sonar with bins of 0.1 m to 30 m, from 60 deg below to 60 deg above. */
sonar::SonarConfig listener(double fov_deg, int bounces) {
    sonar::SonarConfig config = fan(fov_deg, 120, 1, 30);
    setSamples(config, 1024);
    config.visibility = sonar::Visibility::Auto;
    if (bounces > 0) config.multipath.emplace().bounces = bounces;
    return config;
}

sonar::SonarConfig underSurface(double fov_deg) {
    sonar::SonarConfig config = listener(fov_deg, 1);
    config.multipath->surface.emplace();
    return config;
}

types::Snapshot under(double surface, types::GeometryPtr scene) {
    types::Snapshot snapshot = lookingAt(std::move(scene));
    snapshot.water_surface = surface;
    return snapshot;
}

/** Returns a small disc far behind. */
types::GeometryPtr openWater() { return makeScene({disc(1, 0.1)}, {{-500, 0, 0}}); }

/** Returns the material of a plate that is a mirror by its lobe. */
types::Material smooth() {
    types::Material material;
    material.lambert_db = -200;
    material.reflection = 1;
    material.roughness_slope = 0.0f;
    return material;
}

types::GeometryPtr ofMaterial(const types::GeometryPtr& scene, const types::Material& material) {
    const auto changed = makeCopy(scene);
    changed->materials = {material};
    return changed;
}

/** Tests a target at 12 m, 1 m down, from 3 m below the surface. */
void studyTarget(MultipathResult& result) {
    const double r1 = std::hypot(12, 1), r2 = std::hypot(12, 7);
    types::Snapshot snapshot = under(3, openWater());
    snapshot.targets = {{{12, 0, -1}, 0}};
    const Probe received = probe(underSurface(40), snapshot);
    EchoCurve level{"target", "Returns of a target by the surface", "range [m]", "level [dB]", {}};
    const std::array expected{EchoPoint{r1, 0, std::pow(r1, -4)}, EchoPoint{(r1 + r2) / 2, 0, 2 / (r1 * r1 * r2 * r2)},
                              EchoPoint{r2, 0, std::pow(r2, -4)}};
    std::vector<size_t> bins;
    for (size_t k = 0; k < received.ping.bin_count; ++k)
        if (received.ping.bins[k] > 0) bins.push_back(k);
    double off_by = bins.size() == expected.size() ? 0 : 1e3;
    for (size_t i = 0; i < std::min(bins.size(), expected.size()); ++i) {
        off_by = std::max(off_by, std::abs(static_cast<double>(bins[i]) + 0.5 - expected[i].x / 0.1));
        level.points.push_back(
            {expected[i].x, decibels(double{received.ping.bins[bins[i]]}), decibels(expected[i].expected)});
    }
    result.claims.push_back({"ranges of a target's three returns off, in bins", off_by, 0.5, true});
    result.claims.push_back({"levels of a target's three returns off [dB]", level.worst(), 0.3, true});
    result.curves.push_back(std::move(level));
}

/** Tests a bottom 4 m below, with the surface 2 m above: sums over slices of 1 m. */
void studyBottom(MultipathResult& result) {
    const double fov = radians(8), half = radians(60), step = 1e-3;
    const types::GeometryPtr scene = makeScene({levelGround(-4)});
    const Probe with = probe(underSurface(8), under(2, scene)), without = probe(listener(8, 0), under(2, scene));
    std::array<double, 30> expected{}, received{};
    const auto add = [&](double range, double energy) {
        if (range < 30) expected[static_cast<size_t>(range)] += energy;
    };
    for (double out = 8 / std::tan(half) + step / 2; out < 60; out += step) {
        const double r1 = std::hypot(out, 4), r2 = std::hypot(out, 8), area = out * fov * step;
        add((r1 + r2) / 2, 2 * area * 4 / r1 * 8 / r2 / (r1 * r1 * r2 * r2));
        add(r2, area * 64 * std::pow(r2, -6));
    }
    double nearer = 0;
    for (size_t k = 0; k < 300; ++k) {
        const double more = double{with.ping.bins[k]} - double{without.ping.bins[k]};
        received[k / 10] += more;
        if (k < 60) nearer += std::abs(more);
    }
    EchoCurve curve{"bottom", "Ghost of a flat bottom", "range [m]", "level of 1 m [dB]", {}};
    for (size_t k = 10; k < expected.size(); ++k)
        curve.points.push_back({static_cast<double>(k) + 0.5, decibels(received[k]), decibels(expected[k])});
    result.claims.push_back({"ghost of a flat bottom off [dB]", curve.worst(), 0.1, true});
    result.claims.push_back({"change of bins before any ghost", nearer, 0, true});
    result.curves.push_back(std::move(curve));
}

/** Tests a target next to a mirror that ends at different places: the three returns, or only the first. */
void studyWall(MultipathResult& result) {
    EchoCurve curve{"wall", "Returns of a target next to a mirror that ends", "end of the mirror [m]", "returns", {}};
    types::Material mirror;
    mirror.mirror = true;
    mirror.lambert_db = -200;
    for (double end = 4; end < 10; end += 0.5) {
        const auto wall = quad({-20, 4, -20}, {20 + end, 0, 0}, {0, 0, 40});
        types::Snapshot snapshot = lookingAt(ofMaterial(makeScene({wall}), mirror));
        snapshot.targets = {{{12, 1, 0}, 0}};
        const Probe received = probe(listener(170, 1), snapshot);
        const auto count = std::ranges::count_if(received.ping.bins, [](float bin) { return bin > 0; });
        curve.points.push_back({end, static_cast<double>(count), end > 12 * 4.0 / 7 ? 3.0 : 1.0});
    }
    result.claims.push_back({"returns too many or too few next to a mirror that ends", curve.worst(), 0, true});
    result.curves.push_back(std::move(curve));
}

constexpr double corner_range = 50, wavelength = 0.003, side = 0.1;

/** Returns the target strength of a small corner 50 m ahead [dB]. */
double computeStrength(const types::GeometryPtr& corner) {
    sonar::SonarConfig config = fan(0.4, 0.4, 1, 60);
    config.speed_of_sound = 1500;
    config.frequency_khz = 500;
    config.bin_count = 400;
    setSamples(config, 256, 256);
    config.visibility = sonar::Visibility::Auto;
    config.multipath.emplace().bounces = 2;
    return decibels(probe(config, lookingAt(corner)).energy() * std::pow(corner_range, 4));
}

glm::dmat3 turned(double yaw_deg) { return glm::mat3_cast(glm::angleAxis(radians(yaw_deg), glm::dvec3(0, 0, 1))); }

types::GeometryPtr dihedral(double yaw_deg) {
    const double h = std::numbers::sqrt2 / 2;
    const glm::dmat3 axes = turned(yaw_deg) * glm::dmat3{{-h, h, 0}, {-h, -h, 0}, {0, 0, 1}};
    const glm::vec3 edge(corner_range, 0, -side / 2), up(0, 0, side);
    return ofMaterial(makeScene({quad(edge, side * axes[0], up), quad(edge, side * axes[1], up)}), smooth());
}

/** Returns three perpendicular axes with equal angles to the sonar. */
glm::dmat3 trihedralAxes() {
    const double x = std::sqrt(1.0 / 3), r = std::sqrt(2.0 / 3);
    glm::dmat3 axes;
    for (int k = 0; k < 3; ++k) axes[k] = {-x, r * std::sin(2 * pi / 3 * k), r * std::cos(2 * pi / 3 * k)};
    return axes;
}

types::GeometryPtr trihedral(bool square, double yaw_deg) {
    const glm::dmat3 axes = turned(yaw_deg) * trihedralAxes();
    const glm::vec3 corner(corner_range, 0, 0);
    std::vector<types::Mesh> plates;
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 u(side * axes[k]), v(side * axes[(k + 1) % 3]);
        plates.push_back(square ? quad(corner, u, v) : getMesh({corner, corner + u, corner + v}, {0, 1, 2}));
    }
    return ofMaterial(makeScene(std::move(plates)), smooth());
}

/** Returns the aperture of a trihedral towards the sonar, from the sorted cosines of the direction [m^2]. */
double trihedralAperture(bool square, double yaw_deg) {
    const glm::dmat3 axes = turned(yaw_deg) * trihedralAxes();
    std::array<double, 3> cosines{-axes[0].x, -axes[1].x, -axes[2].x};
    std::ranges::sort(cosines);
    const auto [l, m, n] = cosines;
    const double sum = l + m + n;
    const double unit =
        square ? (m <= n / 2 ? 4 * l * m / n : l * (4 - n / m)) : (l + m <= n ? 4 * l * m / sum : sum - 2 / sum);
    return side * side * unit;
}

void studyCorner(MultipathResult& result, const std::string& name, const auto& scene, const auto& aperture) {
    EchoCurve curve{name, "Target strength of a " + name, "turned by [deg]", "target strength [dB]", {}};
    for (double yaw = -20; yaw <= 20; yaw += 5)
        curve.points.push_back({yaw, computeStrength(scene(yaw)), 20 * std::log10(aperture(yaw) / wavelength)});
    result.claims.push_back({"target strength of a " + name + " off over 40 deg [dB]", curve.worst(), 2, true});
    result.curves.push_back(std::move(curve));
}

}  // namespace

double EchoCurve::worst() const {
    double worst = 0;
    for (const EchoPoint& point : points) worst = std::max(worst, std::abs(point.received - point.expected));
    return worst;
}

MultipathResult studyMultipath() {
    MultipathResult result;
    studyTarget(result);
    studyBottom(result);
    studyWall(result);
    studyCorner(result, "dihedral", dihedral,
                [](double yaw) { return 2 * side * side * std::sin(radians(45 - std::abs(yaw))); });
    for (const bool square : {false, true})
        studyCorner(
            result, square ? "square trihedral" : "triangular trihedral",
            [&](double yaw) { return trihedral(square, yaw); },
            [&](double yaw) { return trihedralAperture(square, yaw); });
    return result;
}

std::string csv(const MultipathResult& result) {
    std::string text = "curve,x,heard,expected\n";
    for (const EchoCurve& curve : result.curves)
        for (const EchoPoint& point : curve.points)
            fmt::format_to(std::back_inserter(text), "{},{:.6g},{:.6g},{:.6g}\n", curve.name, point.x, point.received,
                           point.expected);
    return text;
}

namespace {

using console::Json;

Json toJson(const MultipathResult& result) {
    Json json{{"curves", Json::array()}, {"verdicts", Json::array()}};
    for (const EchoCurve& curve : result.curves) {
        Json points = Json::array();
        for (const EchoPoint& point : curve.points)
            points.push_back({{"x", point.x}, {"heard", point.received}, {"expected", point.expected}});
        json["curves"].push_back({{"name", curve.name},
                                  {"title", curve.title},
                                  {"x", curve.x_label},
                                  {"y", curve.y_label},
                                  {"worst", curve.worst()},
                                  {"points", std::move(points)}});
    }
    json["verdicts"] = getVerdicts(result.claims);
    return json;
}

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    if (!(file << text).flush()) throw std::runtime_error(path.string() + " cannot be written");
}

int runStudy(const std::string& out) {
    const MultipathResult result = studyMultipath();
    console::OutputFolder folder(out, "study_multipath");
    folder.keep();
    write(folder.path() / "multipath.csv", csv(result));
    console::write(toJson(result), (folder.path() / "multipath.json").string());
    for (const Claim& claim : result.claims)
        console::printResult("{}  {}: {:.3g}, at most {:.3g}\n", claim.verdict(), claim.text, claim.measured,
                             claim.bound);
    console::printResult("report in {}\n", folder.path().string());
    return std::ranges::any_of(result.claims, &Claim::fails) ? 1 : 0;
}

}  // namespace

void addMultipathStudy(CLI::App& study, console::Action& action) {
    const auto out = std::make_shared<std::string>();
    CLI::App* command = study.add_subcommand("multipath", "Echoes by way of mirrors against closed forms");
    command->add_option("--out", *out, "folder of the report");
    command->callback([out, &action] { action = [out] { return runStudy(*out); }; });
}

}  // namespace insonify::study
