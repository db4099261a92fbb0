// Precision: ranges and world coordinates of any size, grazing, huge and thin triangles.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/stability/StabilityStudy.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

using sonar::SonarConfig;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Outcome manySamplesInABin() {
    SonarConfig config = fan(20, 20, 1, 12);
    config.bin_count = 1;
    setSamples(config, 4000, 2500);
    const Probe received = probe(config, lookingAt(makeScene({facingWall(10)})));
    return within(1e-6, worstBeam(received, config, planeTruth({1, 0, 0}, 10)),
                  "1e7 pixels of a wall in one bin, against the closed form", received);
}

Outcome loudSamplesInABin() {
    SonarConfig config = fan(20, 20, 1, 12);
    config.bin_count = 1;
    setSamples(config, 2000, 1000);
    const auto geometry = makeCopy(makeScene({facingWall(10)}));
    geometry->materials[0].lambert_db = 20;
    const Probe received = probe(config, lookingAt(geometry));
    return within(1e-6, std::abs(received.energy() / trueEnergy(config, 0, planeTruth({1, 0, 0}, 10)) / 100 - 1),
                  "2e6 pixels of the loudest material that a file may have, in one bin", received);
}

/** Returns the relative difference of the bins that two pings share, without the edges of echoes. */
double innerDifference(const types::Sonar& a, const types::Sonar& b) {
    double worst = 0;
    for (size_t i = 1; i + 1 < a.bins.size(); ++i) {
        const bool inside = a.bins[i - 1] > 0 && a.bins[i] > 0 && a.bins[i + 1] > 0;
        if (inside) worst = std::max(worst, off(a.bins[i], b.bins[i]));
    }
    return worst;
}

/** Renders ground and a wall, on one device and with one deposit. */
Probe planesBy(const char* device, sonar::Deposit where) {
    SonarConfig config = fan(130, 40, 61, 30);
    config.deposit = where;
    config.device = device;
    return probe(config, lookingAt(makeScene({levelGround(-4), facingWall(18)})));
}

Outcome processorAndShader() {
    const Probe reference = planesBy("software", sonar::Deposit::Cpu),
                shader = planesBy("software", sonar::Deposit::Gpu);
    return within(1e-4, innerDifference(shader.ping, reference.ping), "both on " + shader.device, shader);
}

Outcome softwareAndCard() {
    const Probe reference = planesBy("software", sonar::Deposit::Cpu);
    const Probe processor = planesBy("auto", sonar::Deposit::Cpu), shader = planesBy("auto", sonar::Deposit::Gpu);
    if (shader.device == reference.device) return {{}, "not run: one device, " + shader.device, 0, Verdict::NotRun};
    const double worst =
        std::max(innerDifference(processor.ping, reference.ping), innerDifference(shader.ping, reference.ping));
    return within(1e-4, worst, "processor and shader on " + shader.device + " against " + reference.device, shader);
}

Outcome manyTriangles() {
    const types::Mesh ball = sphere(1, 224);  // 200,000 triangles
    const auto geometry = std::make_shared<types::Geometry>(*makeScene({ball}));
    const size_t copies = 100'000'000 / geometry->triangleCount() + 1;
    for (size_t i = 1; i < copies; ++i) {
        types::Object& object = geometry->objects.emplace_back(geometry->objects[0]);
        object.name += std::to_string(i);
    }
    for (types::Object& object : geometry->objects) object.world_from_object[3] = {10, 0, 0, 1};
    SonarConfig config = fan(10, 10, 1, 12);
    setSamples(config, 1, 1);
    const double start = seconds();
    Probe received = probe(config, lookingAt(geometry));
    const double taken = seconds() - start;
    received.conditions.push_back({"triangles", static_cast<double>(geometry->triangleCount())});
    received.conditions.push_back({"seconds", taken});
    const bool right = received.firstReturn(0) >= 89 && received.firstReturn(0) <= 90;
    return within(60, right ? taken : INFINITY,
                  "500 balls in one place on one pixel; deviation is the time of set-up and ping, at most 60 s [s]",
                  received);
}

Outcome largeImage() {
    SonarConfig config = fan(20, 20, 1, 12);
    setSamples(config, 16384, 64);
    const auto triangle = makeCopy(makeScene({quad({10, -400, -100}, {0, 800, 0}, {0, 0, 800})}));
    triangle->meshes[0].indices.resize(3);
    triangle->meshes[0].clusters[0].index_count = 3;
    const double start = seconds();
    Probe received = probe(config, lookingAt(triangle));
    received.conditions.push_back({"seconds", seconds() - start});
    const double deviation = received.energy() > 0 ? worstBeam(received, config, planeTruth({1, 0, 0}, 10)) : INFINITY;
    return within(1e-4, deviation, "one triangle, 16384 rows and 64 columns", received);
}

using types::radians;

/** Returns ground, a ball, a wall and a tilted plate. */
types::GeometryPtr harbour(glm::dvec3 origin) {
    return makeScene(
        {levelGround(-5, 400), sphere(1.5, 64), facingWall(30, 12), quad({12, -9, -3}, {1, 5, 0}, {2, 0, 4})},
        {origin, origin + glm::dvec3(10, 3, -2), origin, origin});
}

/** Tests a plate 0.12 m to port and a wall 1999.85 m ahead to starboard. */
Outcome tenCentimetresAndTwoKilometres() {
    const auto geometry = makeScene({quad({0.12f, 0.0f, -0.1f}, {0, 0.1f, 0}, {0, 0, 0.2f}),
                                     quad({1999.85f, -300, -100}, {0, 300, 0}, {0, 0, 200})});
    sonar::SonarConfig config = fan(2, 2, 2, 2000);
    config.range_min = 0.05;
    setSamples(config, 256, 16);
    const Probe received = probe(config, lookingAt(geometry));
    const double far = off(received.energy(0), trueEnergy(config, 0, planeTruth({1, 0, 0}, 1999.85))),
                 near = off(received.energy(1), trueEnergy(config, 1, planeTruth({1, 0, 0}, 0.12)));
    const bool placed = received.firstReturn(1) == 1 && received.firstReturn(0) == 19998;
    return within(1e-3, placed ? std::max(near, far) : INFINITY,
                  fmt::format("first returns in bins {} and {}; energies off by {:.1e} and {:.1e}",
                              received.firstReturn(1), received.firstReturn(0), near, far),
                  received);
}

/** Returns the energy that a loud plane loses to a weak plane 1e-4 r behind it, at a pitch of 40 deg. */
double leak(double distance, bool hidden_first, Probe& received) {
    const glm::dvec3 normal(std::cos(radians(40)), 0, -std::sin(radians(40)));
    const auto plane = [&](double d) {
        const glm::vec3 up(std::sin(radians(40)) * d * 2, 0, std::cos(radians(40)) * d * 2), aside(0, d * 2, 0);
        return quad(-up - aside, aside + aside, up + up);
    };
    sonar::SonarConfig config = fan(30, 20, 8, 1000);
    config.range_min = 0.001;
    const auto alone = makeScene({plane(distance)}, {normal * distance});
    std::vector<glm::dvec3> places = {normal * distance, normal * (distance * 1.0001)};
    if (hidden_first) std::swap(places[0], places[1]);
    const auto both = makeCopy(makeScene({plane(distance), plane(distance)}, places));
    both->materials.push_back(both->materials[0]);
    both->materials[1].lambert_db = 20;
    both->meshes[hidden_first ? 0 : 1].clusters[0].material = 1;
    received = probe(config, lookingAt(both));
    return difference(received.ping, probe(config, lookingAt(alone)).ping);
}

Outcome planesCloseTogether() {
    Probe received;
    double worst = 0;
    for (const double distance : {0.01, 1.0, 600.0})
        for (const bool hidden_first : {false, true}) worst = std::max(worst, leak(distance, hidden_first, received));
    return within(1e-6, worst,
                  "100 times louder plane hidden 1e-4 r behind, at 0.01, 1 and 600 m, rasterised first or last",
                  received);
}

Outcome utmCoordinates() {
    const glm::dvec3 origin(5e5, 4.5e6, -20);
    const sonar::SonarConfig config = fan(120, 40, 64, 40);
    const Probe here = probe(config, lookingAt(harbour({}), {}, 0.1, 0.15)),
                there = probe(config, lookingAt(harbour(origin), origin, 0.1, 0.15));
    int moved = 0;
    for (uint32_t beam = 0; beam < here.ping.beam_count; ++beam)
        moved += here.firstReturn(beam) != there.firstReturn(beam);
    const double energy = off(there.energy(), here.energy()), bins = difference(there.ping, here.ping);
    return within(1e-6, moved ? INFINITY : energy,
                  fmt::format("energy off by {:.1e}, bins by {:.1e}, {} first returns moved", energy, bins, moved),
                  there);
}

Outcome instancesFarApart() {
    const auto ball = sphere(1.5, 64);
    auto both = makeCopy(makeScene({ball, ball}, {{10, 0, 0}, {1e6 + 10, 0, 0}}));
    both->objects[1].mesh = 0;
    const sonar::SonarConfig config = fan(20, 20, 8, 12);
    const Probe near = probe(config, lookingAt(both)), far = probe(config, lookingAt(both, {1e6, 0, 0}));
    return within(1e-6, difference(far.ping, near.ping),
                  "the instance 1e6 m away has the echoes of the instance at the origin", far);
}

/** Compares bins near the range at which a bottom 0.1 m below has an incidence with the closed form. */
Outcome grazing(double incidence_deg) {
    const double height = 0.1, range = std::round(height / std::cos(radians(incidence_deg)));
    sonar::SonarConfig config = fan(10, 4, 4, std::ceil(1.1 * range));
    config.range_min = 0.05;
    const Probe received = probe(config, lookingAt(makeScene({levelGround(-0.1f, 8000)})));
    const auto first = static_cast<uint32_t>(9 * range), last = static_cast<uint32_t>(11 * range);
    const Truth truth = planeTruth({0, 0, -1}, height);
    double energy = 0;
    for (uint32_t k = first; k < last; ++k) energy += received.ping.bins[k];
    const double expected = truth({radians(-5), radians(-2.5), radians(2)}, first * 0.1, last * 0.1);
    return within(0.01, off(energy, expected),
                  fmt::format("{:.0f} to {:.0f} m over a bottom {} m below", first * 0.1, last * 0.1, height),
                  received);
}

/** If range_min cuts through a pixel, the part beyond it is received exactly. */
Outcome blankingThroughAPixel() {
    const double height = 0.1;
    sonar::SonarConfig open = fan(10, 4, 4, 70), blanked = open;
    open.range_min = 0.05;
    blanked.range_min = 51.55;
    const auto scene = lookingAt(makeScene({levelGround(-0.1f, 8000)}));
    const Probe received = probe(blanked, scene), whole = probe(open, scene);
    const double row = 2 * std::tan(radians(2)) / 256;  // of elevation
    const auto clear = static_cast<uint32_t>(10 / (1 / blanked.range_min - row / height)) + 1;
    double worst = 0;
    for (uint32_t k = 516; k < 700; ++k) worst = std::max(worst, off(received.ping.bins[k], whole.ping.bins[k]));
    return within(1e-6, worst,
                  fmt::format("a bottom 0.1 m below, one row from 51.6 to {:.1f} m: every bin beyond range_min, one "
                              "row wide or farther, is what it is without",
                              0.1 * clear),
                  received);
}

Outcome wallThroughThreeFrusta() {
    const sonar::SonarConfig config = fan(160, 20, 160, 100);
    const Probe received = probe(config, lookingAt(makeScene({facingWall(5, 400)})));
    return within(
        1e-3, worstBeam(received, config, planeTruth({1, 0, 0}, 5)),
        fmt::format("worst of {} beams in {} frusta against the closed form", config.beam_count, received.plan.slabs),
        received);
}

Outcome groundThroughTheEyePlane() {
    const sonar::SonarConfig config = fan(360, 40, 180, 50);
    const Probe received = probe(config, lookingAt(makeScene({levelGround(-5)})));
    return within(1e-3, worstBeam(received, config, planeTruth({0, 0, -1}, 5)),
                  "two triangles below and all around, worst of 180 beams against the closed form", received);
}

Outcome hugeSeaFloor(float width) {
    const sonar::SonarConfig config = fan(130, 40, 64, 50);
    const Probe received = probe(config, lookingAt(makeScene({levelGround(-5, width)}), {}, 0.3));
    return within(0.01, worstBeam(received, config, planeTruth({0, 0, -1}, 5)),
                  "worst of 64 beams against the closed form", received);
}

/** Tests a strip a tenth of a pixel wide, moved through a pixel in 40 steps. */
Outcome sliver() {
    sonar::SonarConfig config = fan(20, 20, 1, 12);
    setSamples(config, 64, 64);
    const double pixel = 2 * std::tan(radians(10)) / 64 * 10;
    const auto geometry = makeScene({quad({10, 0, -0.5f}, {0, static_cast<float>(pixel / 10), 0}, {0, 0, 1})});
    types::Snapshot snapshot = lookingAt(geometry);
    Probe received = probe(config, snapshot);
    sonar::SonarRenderer renderer(config, geometry);
    double sum = 0, maximum = 0;
    for (int step = 0; step < 40; ++step) {
        snapshot.sonar.position.y = (step + 0.5) / 40 * pixel;
        renderer.render(snapshot, received.ping);
        sum += received.energy() / 40;
        maximum = std::max(maximum, received.energy());
    }
    double truth = 0;  // of (1 + v^2)^-3 over the strip, on the axis
    for (int i = 0; i < 1000; ++i) truth += std::pow(1 + std::pow((i + 0.5) / 1e4 - 0.05, 2), -3) * 1e-4;
    truth *= 0.01 * pixel / 100;
    received.conditions.push_back({"aliasing", maximum / truth});
    return within(0.02, off(sum, truth),
                  fmt::format("mean of 40 shifts; single pings have 0 to {:.1f} times the energy", maximum / truth),
                  received);
}

/** Tests walls that cross at the border of two frusta, each in front of the other on one side. */
Outcome wallsCrossingAtFrustumBorder() {
    const double lean = radians(20);
    const glm::dvec3 one(std::cos(lean), std::sin(lean), 0), other(std::cos(lean), -std::sin(lean), 0);
    const auto turned = [](const glm::dvec3& n) {
        return quad(glm::vec3(20 * n.y, -20 * n.x, -20), {-40 * n.y, 40 * n.x, 0}, {0, 0, 40});
    };
    const sonar::SonarConfig config = fan(80, 20, 40, 30);
    const Probe received = probe(config, lookingAt(makeScene({turned(one), turned(other)}, {{10, 0, 0}, {10, 0, 0}})));
    const double distance = 10 * std::cos(lean);
    double worst = 0;
    for (uint32_t beam = 0; beam < 40; ++beam)  // at positive azimuths the plane whose normal leans to port is nearer
        worst = std::max(
            worst, off(received.energy(beam), trueEnergy(config, beam, planeTruth(beam < 20 ? other : one, distance))));
    return within(1e-3, worst,
                  fmt::format("worst of 40 beams in {} frusta against the nearer plane", received.plan.slabs),
                  received);
}

}  // namespace

std::vector<StabilityCase> sumCases() {
    return {
        {41, "1e7 samples in one bin", "to 1e-6 of the closed form", manySamplesInABin},
        {44, "Processor and shader", "within 1e-4 except at the edges of echoes", processorAndShader},
        {44, "Software and graphics card", "within 1e-4 except at the edges of echoes", softwareAndCard},
        {55, "1e8 triangles on one pixel", "time-bounded", manyTriangles},
        {55, "One triangle, 16k rows", "to 1e-4 of the closed form", largeImage},
        {58, "2e6 samples of +20 dB in one bin", "to 1e-6 of the closed form: no wrap of the sums", loudSamplesInABin}};
}

std::vector<StabilityCase> precisionCases() {
    return {
        {1, "Ranges of 0.1 m and 2 km in one scene", "both first returns in their bin, energies to 1e-3",
         tenCentimetresAndTwoKilometres},
        {2, "Far over near of 1e6", "a plane 1e-4 r behind another has no echo, to 1e-6", planesCloseTogether},
        {3, "World coordinates of 5e5 and 4.5e6 m", "energy as at the origin to 1e-6, first returns the same",
         utmCoordinates},
        {4, "Instances 1e6 m apart", "each as at the origin, to 1e-6", instancesFarApart},
        {7, "Grazing at 89.9 deg", "finite, energy to 1 % of the closed form", [] { return grazing(89.9); }},
        {7, "Grazing at 89.99 deg", "finite, energy to 1 % of the closed form", [] { return grazing(89.99); }},
        {13, "A wall through three frusta", "every beam to 1e-3 of the closed form: no seam", wallThroughThreeFrusta},
        {13, "Ground that crosses the eye plane", "every beam to 1e-3 of the closed form", groundThroughTheEyePlane},
        {14, "Sea-floor quad of 1e8 m", "every beam to 1 % of the closed form", [] { return hugeSeaFloor(1e8f); }},
        {15, "Slivers thinner than a pixel", "right on average over shifts, to 2 %; aliasing reported", sliver},
        {16, "Walls that cross at a frustum border", "every beam to 1e-3 of the closed form",
         wallsCrossingAtFrustumBorder},
        {60, "Blanking that cuts through a pixel", "nothing beyond range_min is lost, to 1e-6", blankingThroughAPixel}};
}

}  // namespace insonify::study
