// Sums, devices, sizes.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/stability/StabilityStudy.hpp"

namespace insonify::study {
namespace {

using sonar::SonarConfig;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Outcome manySamplesInABin() {
    SonarConfig config = fan(20, 20, 1, 12);
    config.bin_count = 1;
    setSamples(config, 4000, 2500);
    const Probe received = probe(config, lookingAt(sceneOf({facingWall(10)})));
    return within(1e-6, worstBeam(received, config, planeTruth({1, 0, 0}, 10)),
                  "1e7 pixels of a wall in one bin, against the closed form", received);
}

Outcome loudSamplesInABin() {
    SonarConfig config = fan(20, 20, 1, 12);
    config.bin_count = 1;
    setSamples(config, 2000, 1000);
    const auto geometry = copyOf(sceneOf({facingWall(10)}));
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
    return probe(config, lookingAt(sceneOf({levelGround(-4), facingWall(18)})));
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
    const auto geometry = std::make_shared<types::Geometry>(*sceneOf({ball}));
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
    const auto triangle = copyOf(sceneOf({quad({10, -400, -100}, {0, 800, 0}, {0, 0, 800})}));
    triangle->meshes[0].indices.resize(3);
    triangle->meshes[0].clusters[0].index_count = 3;
    const double start = seconds();
    Probe received = probe(config, lookingAt(triangle));
    received.conditions.push_back({"seconds", seconds() - start});
    const double deviation = received.energy() > 0 ? worstBeam(received, config, planeTruth({1, 0, 0}, 10)) : INFINITY;
    return within(1e-4, deviation, "one triangle, 16384 rows and 64 columns", received);
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

}  // namespace insonify::study
