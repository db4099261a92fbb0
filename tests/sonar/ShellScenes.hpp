#pragma once
// Walls that transmit sound, and small sonars before them, for the tests of shells.
#include <memory>
#include <vector>

#include "components/acoustics/Plate.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "components/sonar/surfaces/WallLaws.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"

namespace insonify::sonar {

constexpr double shell_khz = 200, water_speed = 1000;
constexpr types::Shell acrylic{0.004, 1190, 2700, 1340, 5e-3, false};

constexpr acoustics::Fluid shell_water{1025, water_speed};
/** Returns 0.5 m apart, five bins. */
constexpr types::Shell ringing_plate{1, 2500, 2000, 0, 0, false};

inline acoustics::Plate plate(const types::Shell& shell) {
    return {shell.thickness, shell.density, shell.sound_speed, shell.shear_speed, shell.loss};
}
inline acoustics::PlateResponse shellResponse(const types::Shell& shell, double cosine,
                                              const acoustics::Fluid& behind = shell_water) {
    return acoustics::plateResponse(plate(shell), shell_water, behind, 1000 * shell_khz, cosine);
}
inline acoustics::PlateReturns computeReturns(const types::Shell& shell) {
    return acoustics::plateReturns(plate(shell), shell_water, shell_water, 1000 * shell_khz, WallLaw::max_returns);
}

inline SonarConfig wallSonar(double width_deg, double height_deg, int beams, int bins = 300) {
    SonarConfig config = test::getSonar(
        {.beams = beams, .width_deg = width_deg, .height_deg = height_deg, .bins = bins, .rows = 256, .columns = 8});
    config.visibility = Visibility::Cpu;
    config.frequency_khz = shell_khz;
    return config;
}

/** Makes objects of which the first are shells; the others have a Lambert parameter of 0 dB. */
inline types::GeometryPtr makeShells(std::vector<types::Mesh> meshes, size_t shells,
                                     const types::Shell& shell = acrylic, std::vector<glm::dvec3> positions = {}) {
    for (size_t i = 0; i < shells; ++i)
        for (types::Cluster& cluster : meshes[i].clusters) cluster.material = 1;
    const auto scene = std::make_shared<types::Geometry>(*test::makeScene(std::move(meshes), 0, std::move(positions)));
    scene->materials.push_back(scene->materials.front());
    scene->materials[1].shell = shell;
    scene->materials[1].lambert_db = -10;
    return scene;
}

/** Returns the energy of a beam between two ranges [m]. */
inline double sumEnergy(const types::Sonar& ping, uint32_t beam, double from, double to) {
    double sum = 0;
    for (uint32_t k = 0; k < ping.bin_count; ++k)
        if (ping.binStart(k) >= from && ping.binStart(k) < to) sum += double{ping.bins[beam * ping.bin_count + k]};
    return sum;
}

}  // namespace insonify::sonar
