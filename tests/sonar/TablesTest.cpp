// Tables that stand for a function, compared with the function at random places: each within its stated bound.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

#include "components/acoustics/Backscatter.hpp"
#include "components/acoustics/BeamPattern.hpp"
#include "components/acoustics/Curve.hpp"
#include "components/acoustics/Plate.hpp"
#include "components/acoustics/Seabed.hpp"
#include "components/sonar/bins/EchoShape.hpp"
#include "components/sonar/multipath/PathPatterns.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/surfaces/WallLaws.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Weightings.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using acoustics::Weighting;
using std::numbers::pi;
using test::getLaw;

double decibels(double ratio) { return 10 * std::log10(ratio); }

struct Random {
    std::mt19937 engine{17};
    double between(double low, double high) { return std::uniform_real_distribution(low, high)(engine); }
};

/** The greatest difference of a table from its function. */
struct Worst {
    const char* table;
    double off = 0;
    void take(double difference) { off = std::max(off, std::abs(difference)); }
    ~Worst() { std::cout << table << ": at most " << off << "\n"; }
};

TEST(TablesTest, AnAdaptiveTableIsWithinItsBoundOfSmoothNarrowAndSteepFunctions) {
    Random random;
    const std::function<double(double)> functions[] = {
        [](double x) { return x * x; }, [](double x) { return std::exp(-std::pow((x - 0.3) / 0.002, 2)); },
        [](double x) { return std::abs(std::sin(300 * x)); }, [](double x) { return x < 0.7123 ? 1.0 : 2.0; },
        [](double) { return 0.0; }};
    for (const auto& function : functions) {
        const acoustics::AdaptiveTable table(function, -0.5, 1.5, {0.01, 1e-4}, 1024);
        Worst worst{"adaptive table, in its bounds"};
        for (int i = 0; i < 20000; ++i) {
            const double x = random.between(-0.5, 1.5), value = function(x);
            if (std::abs(x - 0.7123) < 1e-6) continue;  // the step itself
            worst.take((table.at(x) - value) / (0.01 * std::abs(value) + 1e-4));
        }
        EXPECT_LT(worst.off, 1);
        EXPECT_EQ(table.at(-7), function(-0.5));
        EXPECT_EQ(table.at(7), function(1.5));
    }
    EXPECT_TRUE(acoustics::AdaptiveTable().empty());
}

/** Random plates of metal, glass and plastics at random frequencies and angles: tables within 0.1 dB, or -70 dB; the
 *  exact share is that of the plate. */
TEST(TablesTest, TheTransmissionOfWalls) {
    Random random;
    constexpr types::Shell matters[] = {{0, 2500, 5600, 3400, 1e-3, false},
                                        {0, 7850, 5900, 3230, 2e-3, false},
                                        {0, 1190, 2700, 1340, 5e-3, false},
                                        {0, 1300, 900, 0, 0.05, false},
                                        {0, 2700, 6300, 3100, 5e-4, false}};
    Worst worst{"transmission of walls, two way [dB]"};
    size_t beyond = 0, all = 0;
    for (int trial = 0; trial < 40; ++trial) {
        types::Material material;
        material.shell = matters[trial % 5];
        material.shell->thickness = std::exp(random.between(std::log(2e-4), std::log(0.02)));
        SonarConfig config = test::getSonar({.beams = 1, .width_deg = 1});
        config.speed_of_sound = 1500;
        config.frequency_khz = std::exp(random.between(std::log(50), std::log(1200)));
        const WallLaw law = makeWallLaw(material, config);
        const acoustics::Plate plate{material.shell->thickness, material.shell->density, material.shell->sound_speed,
                                     material.shell->shear_speed, material.shell->loss};
        for (int i = 0; i < 400; ++i) {
            const double cosine = i == 0 ? 1 : random.between(0.05, 1);
            const double exact = law.exactly(cosine);
            if (!law.rings()) {
                const double formula = std::pow(std::norm(acoustics::plateResponse(plate, {1025, 1500}, {1025, 1500},
                                                                                   1e3 * *config.frequency_khz, cosine)
                                                              .transmitted),
                                                2);
                ASSERT_NEAR(exact / formula, 1, 1e-9);
                ASSERT_NEAR(law.exactly_once(cosine), std::sqrt(exact), 1e-9);
            }
            if (exact < 1e-6) continue;
            const double off = decibels(law.passedAt(cosine) / exact);
            worst.take(off);
            ++all;
            beyond += std::abs(off) > 0.11 ? 1 : 0;
        }
    }
    EXPECT_EQ(beyond, 0u) << "of " << all;
}

TEST(TablesTest, TheBackscatterOfSeabedsAndMeasuredStrengths) {
    Random random;
    Worst steep{"backscatter of seabeds from 1 deg of grazing on [dB]"}, grazing{"from 0.2 to 1 deg [dB]"},
        measured{"measured strengths [dB]"};
    size_t beyond = 0, all = 0;
    for (const char* const name :
         {"rough_rock", "cobble", "coarse_sand", "medium_sand", "very_fine_sand", "silt", "clay"})
        for (const double khz : {30.0, 100.0, 400.0, 1000.0}) {
            SonarConfig config;
            config.frequency_khz = khz;
            config.speed_of_sound = 1500;
            types::Geometry geometry;
            geometry.materials = {
                {.name = "floor", .seabed = name},
                {.name = "measured", .measured = {{5, -45}, {30, -30}, {60, -28}, {75, -20}, {90, -5}}}};
            const MaterialLaws laws = makeMaterialLaws(config, geometry);
            const acoustics::SeabedBackscatter law(acoustics::seabedNamed(name).value(), khz, 1500);
            acoustics::Curve curve;
            for (const auto& point : geometry.materials[1].measured)
                curve.x.push_back(point.x), curve.y.push_back(point.y);
            for (int i = 0; i < 400; ++i) {
                const double angle_deg = i % 4 == 0 ? random.between(0.2, 1) : random.between(1, 90);
                const double angle = types::radians(angle_deg), cosine = std::sin(angle);
                const double off = decibels(laws.overCosine(0, cosine) * cosine / law.crossSection(angle));
                (angle_deg < 1 ? grazing : steep).take(off);
                ++all;
                beyond += std::abs(off) > 0.05 ? 1 : 0;
                if (angle_deg > 1)
                    measured.take(
                        decibels(laws.overCosine(1, cosine) * cosine / acoustics::measuredSection(curve, angle)));
            }
        }
    EXPECT_LT(beyond, all / 100) << "kinks of a law, as at the critical angle";
    EXPECT_LT(steep.off, 1);
    EXPECT_LT(grazing.off, 0.05);
    EXPECT_LT(measured.off, 0.5);
}

TEST(TablesTest, PatternsOfMirroredPathsAndOfPictures) {
    Random random;
    Worst way{"patterns of paths, in 0.05 dB or 1e-5"}, picture{"patterns of pictures, of the axis"};
    for (int trial = 0; trial < 12; ++trial) {
        SonarConfig config = test::getSonar({.beams = 8, .width_deg = 60, .height_deg = 40});
        const Weighting weighting = trial % 2 == 0 ? Weighting::Uniform : Weighting::Taylor;
        config.beam_pattern.emplace().transmit.elevation = getLaw(weighting, random.between(0.25, 30));
        config.beam_pattern->transmit.azimuth = getLaw(Weighting::Uniform, random.between(0.5, 90));
        config.beam_pattern->receive.azimuth = getLaw(Weighting::Hann, 5);
        config.visibility = Visibility::Cpu;
        const auto scene = test::openWater();
        const RenderPlan plan = makeRenderPlan(config, *scene);
        const PathPatterns patterns(plan);
        const PathPatterns::Direction ahead = patterns.toDirection({1, 0, 0});
        const double reach = std::sin(types::radians(plan.sampled.beam_height_deg) / 2);
        for (int i = 0; i < 3000; ++i) {
            const double sine = random.between(-reach, reach), azimuth = random.between(-pi, pi),
                         level = std::sqrt(1 - sine * sine);
            const PathPatterns::Direction sent =
                patterns.toDirection({level * std::cos(azimuth), level * std::sin(azimuth), sine});
            const double exact =
                plan.directivity->sentElevation(std::asin(sine)) * plan.directivity->sentAzimuth(azimuth);
            way.take((patterns.power(sent, ahead) - exact) / (2 * 0.0116 * exact + 2e-5));
        }
        config.visibility = Visibility::Gl;
        config.device = "software";
        const RenderPlan images = makeRenderPlan(config, *scene);
        const PingEffects effects(images, *scene);
        const EchoRules rules = makeEchoRules(images, effects);
        for (int i = 0; i < 3000; ++i) {
            const double at = random.between(0, ELEVATION_STEPS),
                         sine = rules.elevation_reach * (2 * at / ELEVATION_STEPS - 1);
            const auto k = std::min(static_cast<size_t>(at), size_t{ELEVATION_STEPS - 1});
            const double given =
                std::lerp(rules.elevation_powers[k], rules.elevation_powers[k + 1], at - static_cast<double>(k));
            picture.take(given - images.directivity->elevation(std::asin(sine)));
        }
    }
    EXPECT_LT(way.off, 1);
    EXPECT_LT(picture.off, 5e-3);
}

TEST(TablesTest, TheShapeOfAnEchoAndTheFieldOfElements) {
    Random random;
    Worst shape{"means of a pulse's response, of its peak"},
        elements{"fields of elements, of the sum of their magnitudes"};
    for (int trial = 0; trial < 20; ++trial) {
        acoustics::PulseConfig config;
        config.bandwidth_khz = random.between(2, 100);
        config.window = static_cast<acoustics::PulseWindow>(trial % 4);
        const acoustics::Pulse pulse(config, 1500);
        const EchoShape echo(pulse);
        for (int i = 0; i < 300; ++i) {
            const double low = random.between(-0.8, 0.8) * echo.reach(),
                         high = low + random.between(0.01, 1) * pulse.resolution();
            if (high < echo.reach()) shape.take(echo.mean(low, high) - pulse.mean(low, high));
        }
        std::vector<std::complex<double>> parts;
        double sum = 0;
        for (int m = 0; m < 8 + 13 * trial; ++m) {
            parts.push_back(std::polar(random.between(0, 1), random.between(0, 2 * pi)));
            sum += std::abs(parts.back());
        }
        const acoustics::ElementField field(parts);
        for (int i = 0; i < 200; ++i) {
            const double u = random.between(-40, 40);
            std::complex<double> exact = 0;
            for (size_t m = 0; m < parts.size(); ++m)
                exact += parts[m] * std::polar(1.0, 2 * pi * u * acoustics::elementPlace(m, parts.size()));
            elements.take(std::abs(field.at(u) - exact) / sum);
        }
    }
    EXPECT_LT(shape.off, 1e-3);
    EXPECT_LT(elements.off, 1e-4);
}

}  // namespace
}  // namespace insonify::sonar
