// Pings of materials that follow a table or have a lobe, compared with closed forms and target strengths
// (ACOUSTICS.md 3.5 to 3.8). Each form has a deliberately wrong variant, which must fail by the same measure.
#include <gmock/gmock.h>

#include <numbers>
#include <numeric>

#include "components/acoustics/Seabed.hpp"
#include "components/sonar/renderer/PlanReport.hpp"
#include "tests/support/ClosedForms.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;
using test::everyRenderer;
using test::expectForm;
using test::makePing;
using types::radians;

SonarConfig floorSonar(double fov_deg, double height_deg, double bin, int bins, int rows = 512) {
    SonarConfig config;
    config.speed_of_sound = 1500;
    config.range_rounding = RangeRounding::Exact;
    config.range = bin * bins;
    config.bin_count = bins;
    config.beam_count = 1;
    config.field_of_view_deg = fov_deg;
    config.beam_height_deg = height_deg;
    config.quality.rows = rows;
    config.quality.columns_per_beam = std::max(2, static_cast<int>(rows * fov_deg / height_deg));
    return config;
}

types::Snapshot changed(types::GeometryPtr scene, const auto& change) {
    auto geometry = std::make_shared<types::Geometry>(*scene);
    change(geometry->materials.front());
    return test::makeSnapshot(geometry);
}

/** A flat bottom under a level fan: area r delta dr at range r. */
test::Form makeBottom(double height, double elevation, double delta, const std::function<double(double)>& section) {
    return [=](double near, double far) {
        const double first = height / std::sin(elevation);
        return far <= first ? 0.0 : test::integral(std::max(near, first), far, [=](double r) {
            return section(std::asin(height / r)) * delta * std::pow(r, -3);
        });
    };
}

/** Returns 10 log10 of the echo of a target at `range` [dB]. */
double targetStrength(const types::Sonar& ping, double range) {
    return 10 * std::log10(std::accumulate(ping.bins.begin(), ping.bins.end(), 0.0) * std::pow(range, 4));
}

/** Makes a smooth or rough mirror without diffuse scattering. */
void makeShiny(types::Material& material, float reflection, float slope) {
    material.lambert_db = -200;
    material.reflection = reflection;
    material.roughness_slope = slope;
}

TEST(BackscatterPingTest, ASeabedEchoesByTheLawOfItsReportAtTheSonarsFrequency) {
    SonarConfig config = floorSonar(1, 40, 0.15, 200);
    config.frequency_khz = 100;
    const auto snapshot =
        changed(test::makeScene({test::ground(-5)}), [](types::Material& m) { m.seabed = "medium_sand"; });
    const acoustics::SeabedBackscatter sand(acoustics::seabedNamed("medium_sand").value(), 100, 1500);
    const auto right = makeBottom(5, radians(20), radians(1), [&](double angle) { return sand.crossSection(angle); });
    const auto lambert = makeBottom(5, radians(20), radians(1), [](double angle) {
        return std::pow(10, types::Material{}.lambert_db / 10) * std::pow(std::sin(angle), 2);
    });
    for (const SonarConfig& way : everyRenderer(config)) expectForm(makePing(way, snapshot), right, lambert);
}

TEST(BackscatterPingTest, ASeabedOfASonarWithoutAFrequencyFollowsLambert) {
    const SonarConfig config = floorSonar(1, 40, 0.15, 200);
    const auto plain = test::makeSnapshot(test::makeScene({test::ground(-5)}, -16.7f));
    const auto sand = changed(plain.geometry, [](types::Material& m) { m.seabed = "medium_sand"; });
    EXPECT_EQ(makePing(config, sand).bins, makePing(config, plain).bins);
    const types::Plan plan = report(makeRenderPlan(config, *sand.geometry), *sand.geometry);
    EXPECT_THAT(plan.omitted,
                testing::Contains(testing::Field(
                    &types::Omission::reason, "no frequency_khz; sediments follow Lambert's law by their lambert_db")));
}

TEST(BackscatterPingTest, AMeasuredTableEchoesAsMeasured) {
    const auto snapshot = changed(test::makeScene({test::ground(-5)}), [](types::Material& m) {
        m.measured = {{0, -40}, {10, -30}, {30, -22}, {90, -5}};
    });
    const auto levelAt = [](double deg) {
        return deg < 10 ? -40 + deg : deg < 30 ? -30 + 0.4 * (deg - 10) : -22 + 17.0 / 60 * (deg - 30);
    };
    const auto right = makeBottom(5, radians(20), radians(1),
                                  [&](double angle) { return std::pow(10, levelAt(angle * 180 / pi) / 10); });
    const auto half = makeBottom(5, radians(20), radians(1),
                                 [&](double angle) { return std::pow(10, levelAt(angle * 90 / pi) / 10); });
    for (const SonarConfig& way : everyRenderer(floorSonar(1, 40, 0.15, 200)))
        expectForm(makePing(way, snapshot), right, half);
}

TEST(BackscatterPingTest, ASphereHasItsTargetStrengthWithAnyNumberOfRows) {
    const float reflection = 0.9f;
    const auto snapshot = changed(test::makeScene({test::sphere(0.5, 128)}, 0, {{50.5, 0, 0}}),
                                  [&](types::Material& m) { makeShiny(m, reflection, 0.1f); });
    const double right = 10 * std::log10(reflection * reflection * 0.25 / 4);
    for (int rows : {64, 256, 2048})
        for (const SonarConfig& way : everyRenderer(floorSonar(2, 2, 1, 60, rows)))
            EXPECT_NEAR(targetStrength(makePing(way, snapshot), 50), right, 0.5) << rows;
    const auto lambert = changed(snapshot.geometry, [](types::Material& m) { m.lambert_db = 0, m.reflection = 0; });
    EXPECT_GT(std::abs(targetStrength(makePing(floorSonar(2, 2, 1, 60), lambert), 50) - right), 3)
        << "the form sees a law";
}

TEST(BackscatterPingTest, ASphereOfSmoothMatterHasTheTargetStrengthOfItsReflection) {
    SonarConfig config = floorSonar(2, 2, 1, 60);
    config.frequency_khz = 900;
    const auto strength = [&](const SonarConfig& way, const char* matter) {
        return targetStrength(
            makePing(way, changed(test::makeScene({test::sphere(0.5, 128)}, 0, {{50.5, 0, 0}}),
                                  [&](types::Material& m) { m.matter = matter, m.lambert_db = -20; })),
            50);
    };
    const double steel = (46.315 - 1.5375) / (46.315 + 1.5375),
                 rock = (2562 * 3.75e-3 - 1.5375) / (2562 * 3.75e-3 + 1.5375);
    for (const SonarConfig& way : everyRenderer(config)) {
        EXPECT_NEAR(strength(way, "steel"), 10 * std::log10(steel * steel * 0.25 / 4), 0.6) << "0.05 of it scattered";
        EXPECT_NEAR(strength(way, "rock"), 10 * std::log10(rock * rock * 0.25 * 2 / 3), 0.5) << "by Lambert's law";
    }
    config.frequency_khz.reset();
    EXPECT_NEAR(strength(config, "steel"), 10 * std::log10(0.01 * 2 * pi * 0.25 / 3), 0.5)
        << "by its lambert_db without a frequency";
}

TEST(BackscatterPingTest, AnEllipsoidHasTheTargetStrengthOfItsRadiiOfCurvature) {
    const double a = 0.6, b = 0.3, c = 0.4;  // semi-axes; seen along a
    auto geometry = std::make_shared<types::Geometry>(*test::makeScene({test::sphere(1, 256)}));
    geometry->objects[0].world_from_object = glm::dmat4(a, 0, 0, 0, 0, b, 0, 0, 0, 0, c, 0, 50 + a, 0, 0, 1);
    const auto snapshot = changed(geometry, [](types::Material& m) { makeShiny(m, 1, 0.1f); });
    const double right = 10 * std::log10(b * b / a * (c * c / a) / 4);
    for (int rows : {64, 512})
        for (const SonarConfig& way : everyRenderer(floorSonar(2, 2, 1, 60, rows)))
            EXPECT_NEAR(targetStrength(makePing(way, snapshot), 50), right, 0.5) << rows;
    EXPECT_GT(std::abs(10 * std::log10(b * c / 4) - right), 0.5) << "of semi-axes instead";
}

TEST(BackscatterPingTest, APlateAtNormalIncidenceHasItsTargetStrength) {
    const double side = 0.4, wavelength = 1500 / 30e3, area = side * side;
    SonarConfig config = floorSonar(2, 2, 1, 60);
    config.frequency_khz = 30;
    const auto snapshot = changed(test::makeScene({test::quad({50, -0.2f, -0.2f}, {0, 0.4f, 0}, {0, 0, 0.4f})}),
                                  [](types::Material& m) { makeShiny(m, 1, 0); });
    const double right = 10 * std::log10(area * area / (wavelength * wavelength));
    for (int rows : {64, 256, 2048}) {
        config.quality.rows = config.quality.columns_per_beam = rows;
        for (const SonarConfig& way : everyRenderer(config))
            EXPECT_NEAR(targetStrength(makePing(way, snapshot), 50), right, 0.5) << rows;
    }
    config.frequency_khz = 60;
    EXPECT_NEAR(targetStrength(makePing(config, snapshot), 50), right + 6.02, 0.5) << "it depends on the frequency";
}

TEST(BackscatterPingTest, ARoughCylinderBroadsideHasItsTargetStrength) {
    const double radius = 0.25, length = 1, slope = 0.1;
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    const uint32_t around = 256;
    for (uint32_t i = 0; i < around; ++i) {
        const double angle = 2 * pi * i / around;
        for (const double z : {-length / 2, length / 2})
            positions.push_back(glm::dvec3(50.25 + radius * std::cos(angle), radius * std::sin(angle), z));
        const uint32_t a = 2 * i, b = (2 * i + 2) % (2 * around);
        indices.insert(indices.end(), {a, b, a + 1, a + 1, b, b + 1});
    }
    const auto snapshot = changed(test::makeScene({test::getMesh(positions, indices)}),
                                  [&](types::Material& m) { makeShiny(m, 1, static_cast<float>(slope)); });
    const double right = 10 * std::log10(radius * length / (4 * std::sqrt(pi) * slope));
    for (int rows : {64, 256, 1024})
        for (const SonarConfig& way : everyRenderer(floorSonar(2, 2, 1, 60, rows)))
            EXPECT_NEAR(targetStrength(makePing(way, snapshot), 50), right, 0.5) << rows;
}

TEST(BackscatterPingTest, AMirrorShowsTheSonarsImageWithAnyNumberOfSamples) {
    // The echo of a plane mirror is the sound of the mirrored sonar at twice the distance: R^2 / (2 D)^2.
    const auto snapshot = changed(test::makeScene({test::wall(10)}), [](types::Material& m) { makeShiny(m, 0.5f, 0); });
    const double right = 10 * std::log10(0.25 / 400);
    for (int rows : {16, 64, 512, 2048})
        for (int columns : {3, 64}) {
            SonarConfig config = floorSonar(20, 20, 1, 20, rows);
            config.frequency_khz = 750;
            config.quality.columns_per_beam = columns;
            for (const SonarConfig& way : everyRenderer(config)) {
                const types::Sonar ping = makePing(way, snapshot);
                const double level = 10 * std::log10(std::accumulate(ping.bins.begin(), ping.bins.end(), 0.0));
                EXPECT_NEAR(level, right, 0.5) << rows << " x " << columns;
            }
        }
}

TEST(BackscatterPingTest, ALobeEchoesWithoutALambertianPart) {
    const auto snapshot = changed(test::makeScene({test::wall(10)}), [](types::Material& m) {
        makeShiny(m, 0.5f, 0.1f);
        m.lambert_db = -1000;  // 0 as a float
    });
    for (const SonarConfig& way : everyRenderer(floorSonar(20, 20, 1, 20))) {
        const types::Sonar ping = makePing(way, snapshot);
        EXPECT_NEAR(10 * std::log10(std::accumulate(ping.bins.begin(), ping.bins.end(), 0.0)),
                    10 * std::log10(0.25 / 400), 0.5);
    }
}

}  // namespace
}  // namespace insonify::sonar
