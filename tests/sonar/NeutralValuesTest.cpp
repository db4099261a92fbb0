// Effects with neutral values change no bit of a ping, whether energies or fields are summed, of any kind of sonar.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/tasks/AltimeterTask.hpp"
#include "components/sonar/tasks/SideScanTask.hpp"
#include "components/sonar/tasks/Sonar3dTask.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Weightings.hpp"

namespace insonify::sonar {
namespace {

/** A value of an effect that means that it does nothing. */
struct Neutral {
    const char* name;
    std::function<void(SonarConfig&)> set;
};

std::vector<Neutral> neutrals() {
    return {
        {"volume",
         [](SonarConfig& c) {
             c.volume = {{{}, {}, -200}};
         }},
        {"volume in layers",
         [](SonarConfig& c) {
             c.volume = {{{}, 5, -200}, {5, {}, -200}};
         }},
        {"absorption", [](SonarConfig& c) { c.absorption.emplace().db_per_m = 0; }},
        {"ring-down",
         [](SonarConfig& c) {
             if (!c.pulse) c.pulse.emplace().duration_us = 1;
             c.pulse->ring_down = acoustics::RingDownConfig{-3000, 1};
         }},
        {"a pulse far shorter than a bin", [](SonarConfig& c) { c.pulse.emplace().duration_us = 1; }},
        {"multipath", [](SonarConfig& c) { c.multipath.emplace().bounces = 0; }},
        {"mirrors in a scene without any", [](SonarConfig& c) { c.multipath.emplace().bounces = 2; }},
        {"imperfections", [](SonarConfig& c) { c.imperfections.emplace(); }},
        {"imperfections' crosstalk", [](SonarConfig& c) { c.imperfections.emplace().crosstalk_db = -200; }},
        {"edges in a scene without any", [](SonarConfig& c) { c.effects["edge_diffraction"]; }},
        {"crosstalk", [](SonarConfig& c) { c.crosstalk.emplace(); }},
        {"walls in a scene without any", [](SonarConfig& c) { c.max_walls = 1; }},
        {"fields without coherence",
         [](SonarConfig& c) {
             if (!c.speckle) c.speckle.emplace().coherent = false;
         }},
    };
}

types::GeometryPtr floorAndBall() {
    return test::makeScene({test::ground(-3), test::sphere(0.5, 16)}, -10, {{}, {6, 1, -1.5}});
}

struct Kind {
    std::string name;
    SonarConfig config;
};

std::vector<Kind> kinds() {
    SonarConfig fan =
        test::getSonar({.beams = 9, .width_deg = 50, .height_deg = 40, .bins = 120, .rows = 48, .columns = 2});
    fan.visibility = Visibility::Cpu;
    fan.frequency_khz = 400;
    SonarConfig patterned = fan;
    patterned.beam_pattern.emplace().receive.azimuth = test::getLaw(acoustics::Weighting::Hann, 6);
    patterned.beam_pattern->transmit.elevation = test::getLaw(acoustics::Weighting::Gaussian, 30);
    SonarConfig cones = fan;
    cones.beam_geometry = BeamGeometry::Conical;
    AltimeterConfig altimeter;
    altimeter.sonar = fan;
    altimeter.sonar.field_of_view_deg.reset();
    altimeter.sonar.beam_width_deg = 20;
    SideScanConfig side_scan;
    side_scan.sonar = fan;
    side_scan.sonar.field_of_view_deg.reset();
    side_scan.sonar.beam_width_deg = 2;
    side_scan.sonar.beam_height_deg = 60;
    Sonar3dConfig grid;
    grid.sonar = fan;
    grid.sonar.field_of_view_deg.reset();
    grid.sonar.beam_height_deg = 5;
    grid.sonar.quality.rows = grid.sonar.quality.columns_per_beam = 4;
    grid.vertical = {6, 30};
    grid.horizontal = {4, 40};
    return {{"fan", fan},
            {"patterned fan", patterned},
            {"cones", cones},
            {"altimeter", altimeter.beam()},
            {"side-scan", side_scan.acrossTrack()},
            {"grid", grid.upright()}};
}

TEST(NeutralValuesTest, ChangeNoBitOfAnyKindOfSonarWithEnergiesAndWithFields) {
    const auto scene = floorAndBall();
    types::Snapshot snapshot = test::makeSnapshot(scene, {}, 0.1, 0.4);
    snapshot.water_surface = 30;
    snapshot.targets = {{{5, 0.4, -1}, -20}};
    for (const bool coherent : {false, true})
        for (const Kind& kind : kinds()) {
            SonarConfig plain = kind.config;
            if (coherent) plain.speckle.emplace().coherent = true;
            const types::Sonar without = test::makePing(plain, snapshot);
            for (const Neutral& neutral : neutrals()) {
                SonarConfig with = plain;
                neutral.set(with);
                EXPECT_EQ(test::makePing(with, snapshot).bins, without.bins)
                    << neutral.name << " in a " << kind.name << (coherent ? ", fields" : ", energies");
            }
        }
}

/** A volume above its least strength is heard: the cases above do not pass because it is never read. */
TEST(NeutralValuesTest, ValuesThatAreNotNeutralChangeThePing) {
    const types::Snapshot snapshot = test::makeSnapshot(floorAndBall(), {}, 0.1, 0.4);
    for (const bool coherent : {false, true}) {
        SonarConfig plain = kinds().front().config;
        if (coherent) plain.speckle.emplace().coherent = true;
        SonarConfig with = plain;
        with.volume = {{{}, {}, -50}};
        EXPECT_NE(test::makePing(with, snapshot).bins, test::makePing(plain, snapshot).bins);
        with = plain;
        with.imperfections.emplace().crosstalk_db = -30;
        EXPECT_NE(test::makePing(with, snapshot).bins, test::makePing(plain, snapshot).bins);
    }
}

}  // namespace
}  // namespace insonify::sonar
