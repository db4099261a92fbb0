// Pings whose echoes interfere (ACOUSTICS.md 5.21). Statistical laws result from sums of scatterers; none is put in.
// Each law is compared with a wrong law, which must fail by the same measure.
#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <glm/gtc/matrix_transform.hpp>
#include <iostream>
#include <numbers>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/SpeckleStatistics.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

using test::makePing;
using namespace sonar;
using ::testing::ElementsAreArray;
using types::radians;

/** Returns boxes of 1 deg by 0.05 m over a level bottom: each bin is a resolution cell. */
SonarConfig boxes() {
    SonarConfig config;
    config.speed_of_sound = 1500;
    config.range_rounding = RangeRounding::Exact;
    config.range = 20;
    config.range_min = 8;
    config.bin_count = 400;
    config.beam_count = 90;
    config.field_of_view_deg = 90;
    config.beam_height_deg = 40;
    config.frequency_khz = 500;
    config.quality.rows = 128;
    config.quality.columns_per_beam = 2;
    config.visibility = Visibility::Cpu;
    return config;
}

SonarConfig coherent(SonarConfig config, int scatterers_per_cell = 10, std::optional<double> per_m2 = {}) {
    config.speckle = SpeckleConfig{true, scatterers_per_cell, per_m2};
    return config;
}

types::Snapshot overBottom(glm::dvec3 place = {}, double yaw = 0) {
    return test::makeSnapshot(test::makeScene({test::ground(-3)}), place, yaw);
}

/** Returns the intensity of each bin over its mean. */
SpeckleField getField(const SonarConfig& config, const types::Snapshot& snapshot) {
    SonarConfig energies = config;
    energies.speckle.reset();
    return overMeans(makePing(config, snapshot), makePing(energies, snapshot));
}

double computeMean(const SpeckleField& field) {
    double sum = 0, count = 0;
    for (const double value : field.relative)
        if (std::isfinite(value)) sum += value, ++count;
    return sum / count;
}

/** Returns the correlation of the intensities of two pings from different places. */
double alike(const SonarConfig& config, const types::Snapshot& a, const types::Snapshot& b) {
    return likewise(getField(config, a), getField(config, b)).intensities;
}

TEST(SpecklePingTest, WithoutCoherenceNothingChanges) {
    SonarConfig config = boxes();
    const types::Sonar absent = makePing(config, overBottom());
    config.speckle = SpeckleConfig{};
    EXPECT_THAT(makePing(config, overBottom()).bins, ElementsAreArray(absent.bins));
    EXPECT_NE(makePing(coherent(boxes()), overBottom()).bins, absent.bins);
}

TEST(SpecklePingTest, ManyScatterersAreRayleighAndKeepTheMean) {
    const SpeckleField field = getField(coherent(boxes()), overBottom());
    const SpeckleFigures figures = computeFigures(field);
    std::cout << "mean " << computeMean(field) << ", scintillation " << figures.scintillation.value
              << ", distance from Rayleigh " << figures.rayleigh_distance << "\n";
    EXPECT_NEAR(computeMean(field), 1, 0.03);
    EXPECT_NEAR(figures.scintillation.value, 1, 4 * figures.scintillation.error);
    EXPECT_LT(figures.rayleigh_distance, rayleigh_distance_limit);
    EXPECT_NEAR(figures.along[1], 0, 0.03);
    EXPECT_NEAR(figures.across[1], 0, 0.03);
    const SpeckleFigures few = computeFigures(getField(coherent(boxes(), 20, 100.0), overBottom()));
    EXPECT_GT(few.rayleigh_distance, rayleigh_distance_limit);
}

/** Returns a fan across the track whose beams are half a degree along it. */
SonarConfig acrossTheTrack() {
    SonarConfig config = boxes();
    config.range_min = 10;
    config.range = 25;
    config.bin_count = 256;
    config.bearings_deg = {-60, 60};
    config.beam_width_deg = 60;
    config.beam_height_deg = 0.5;
    config.quality.rows = 4;
    config.quality.columns_per_beam = 1024;
    return config;
}

TEST(SpecklePingTest, LinesOfASideScanAreRayleighThoughTheirFanIsWide) {
    double sum = 0, squares = 0, count = 0;
    for (int line = 0; line < 24; ++line) {
        types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::ground(-7)}), {0.5 * line, 0, 0}, 0);
        snapshot.sonar.orientation *= glm::angleAxis(radians(90), glm::dvec3(0, 1, 0));
        const types::Sonar field = makePing(coherent(acrossTheTrack()), snapshot),
                           mean = makePing(acrossTheTrack(), snapshot);
        for (size_t i = 0; i < field.bins.size(); ++i) {
            if (mean.bins[i] <= 0) continue;
            const double relative = static_cast<double>(field.bins[i]) / static_cast<double>(mean.bins[i]);
            ++count, sum += relative, squares += relative * relative;
        }
    }
    ASSERT_GT(count, 5000);
    EXPECT_NEAR(sum / count, 1, 0.05);
    EXPECT_NEAR(squares * count / (sum * sum) - 1, 1, 0.1) << "scintillation index";
}

TEST(SpecklePingTest, EveryFanAndPatternKeepsTheMean) {
    SonarConfig conical = coherent(boxes());
    conical.beam_geometry = BeamGeometry::Conical;
    EXPECT_NEAR(computeMean(getField(conical, overBottom())), 1, 0.03);
    SonarConfig patterned = coherent(boxes());
    patterned.beam_pattern.emplace();
    patterned.beam_pattern->receive.azimuth.emplace().width_deg = 1.5;
    patterned.beam_pattern->transmit.elevation.emplace().width_deg = 30;
    EXPECT_NEAR(computeMean(getField(patterned, overBottom())), 1, 0.03);
    for (const double bandwidth : {5.0, 12.0, 20.0}) {
        SonarConfig chirp = patterned;
        chirp.pulse.emplace().bandwidth_khz = bandwidth;
        chirp.pulse->window = acoustics::PulseWindow::Hann;
        EXPECT_NEAR(computeMean(getField(chirp, overBottom())), 1, 0.04) << bandwidth;
    }
    SonarConfig tone = coherent(boxes());
    tone.pulse.emplace().duration_us = 173;
    EXPECT_NEAR(computeMean(getField(tone, overBottom())), 1, 0.04);
}

TEST(SpecklePingTest, AStillSceneGivesTheSamePingAndAnotherBottomDoesNot) {
    const SonarConfig config = coherent(boxes());
    const types::Snapshot here = overBottom();
    EXPECT_EQ(makePing(config, here).bins, makePing(config, here).bins);
    types::Snapshot far = overBottom({5e5, 4.5e6, 0});
    auto moved = test::makeScene({test::ground(-3)}, 0, {{5e5, 4.5e6, 0}});
    far.geometry = moved;
    EXPECT_GT(alike(config, here, far), 0.999) << "a scene that is elsewhere in the world";
    EXPECT_LT(std::abs(alike(config, here, overBottom({30, 20, 0}))), 0.04);
}

TEST(SpecklePingTest, SpeckleDoesNotDependOnQualityOrTriangles) {
    const SonarConfig config = coherent(boxes());
    SonarConfig finer = config;
    finer.quality.rows = 512;
    finer.quality.columns_per_beam = 4;
    const SpeckleField coarse = getField(config, overBottom()), fine = getField(finer, overBottom());
    std::cout << "quality: " << likewise(coarse, fine).intensities << ", scintillation "
              << computeFigures(coarse).scintillation.value << " and " << computeFigures(fine).scintillation.value
              << "\n";
    EXPECT_GT(likewise(coarse, fine).intensities, 0.98);
    EXPECT_NEAR(computeFigures(coarse).scintillation.value, computeFigures(fine).scintillation.value, 0.02);
    types::Snapshot pieces = overBottom();
    std::vector<glm::vec3> corners;
    std::vector<uint32_t> indices;
    for (int x = 0; x <= 100; ++x)
        for (int y = 0; y <= 100; ++y) {
            corners.push_back({-30 + 0.6f * static_cast<float>(x), -30 + 0.6f * static_cast<float>(y), -3});
            if (x == 0 || y == 0) continue;
            const auto at = static_cast<uint32_t>(101 * x + y);
            for (const uint32_t corner : {at - 102, at - 1, at - 101, at - 101, at - 1, at}) indices.push_back(corner);
        }
    pieces.geometry = test::makeScene({test::getMesh(corners, indices)});
    EXPECT_GT(alike(config, overBottom(), pieces), 0.98);
}

/** Returns a line that transmits in all directions and receives with an aperture, of beams 0.25 deg apart. */
SonarConfig lineArray(double aperture) {
    SonarConfig config = coherent(boxes());
    config.beam_count = 360;
    config.beam_pattern.emplace();
    config.beam_pattern->floor_db = -40;
    config.beam_pattern->receive.azimuth.emplace().aperture_m = aperture;
    return config;
}

TEST(SpecklePingTest, DecorrelatesSidewaysLikeTheShiftedAperture) {
    // van Cittert and Zernike: the field's correlation is the autocorrelation of the aperture at twice the shift, that
    // of intensities its square, which is a half at 0.146 of the aperture.
    const double aperture = 0.1;
    const SonarConfig config = lineArray(aperture);
    const types::Snapshot here = overBottom();
    const auto after = [&](double way) {
        SonarConfig ahead = config;
        ahead.field_of_view_deg = 30;  // only beams ahead: the others see the aperture at a slant
        ahead.beam_count = 120;
        return alike(ahead, here, overBottom({0, way, 0}));
    };
    for (const double share : {0.05, 0.1, 0.146, 0.2, 0.3}) {
        const double theory = std::pow(1 - 2 * share, 2);
        std::cout << share << " of the aperture: " << after(share * aperture) << ", theory " << theory << "\n";
        EXPECT_NEAR(after(share * aperture), theory, 0.05) << share;
    }
    EXPECT_LT(after(0.6 * aperture), 0.06);
}

TEST(SpecklePingTest, MovesWithAPureShiftInRange) {
    // Over a bin of 0.05 m towards the bottom ahead: each bin's content moves to the previous bin, where little else
    // changes.
    SonarConfig config = coherent(boxes());
    config.field_of_view_deg = 4;
    config.beam_count = 4;
    config.beam_height_deg = 1;
    const auto wall = [&](double shift) {
        types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::ground(-3)}), {shift, 0, 0}, 0, 0);
        return getField(config, snapshot);
    };
    config.beam_height_deg = 40;
    const SpeckleField here = wall(0);
    SpeckleField nearer = wall(0.05);
    for (size_t beam = 0; beam < nearer.beam_count; ++beam)
        for (size_t bin = nearer.bin_count; bin-- > 0;)
            nearer.relative[beam * nearer.bin_count + bin] =
                bin > 0 ? nearer.relative[beam * nearer.bin_count + bin - 1] : std::nan("");
    EXPECT_GT(likewise(here, nearer).intensities, 0.6);
    EXPECT_LT(likewise(here, wall(0.05)).intensities, 0.3);
}

/** Returns the part of a field beyond a range, where the pulse spreads it from both sides. */
SpeckleField beyond(SpeckleField field, double range, const SonarConfig& config) {
    const auto first = static_cast<size_t>(range / config.range * config.bin_count);
    for (size_t i = 0; i < field.relative.size(); ++i)
        if (i % field.bin_count < first) field.relative[i] = std::nan("");
    return field;
}

TEST(SpecklePingTest, NeighboursCorrelateAccordingToPulseAndPattern) {
    // For a chirp without a window, the square of the sinc of the distance over c / 2B; for an aperture that of the
    // difference of sines over wavelength / L.
    SonarConfig chirp = coherent(boxes());
    chirp.pulse.emplace().bandwidth_khz = 1500.0 / (2 * 0.2) / 1e3;  // resolves 0.2 m: bins are a quarter of it
    const SpeckleFigures along = computeFigures(beyond(getField(chirp, overBottom()), 10, chirp));
    std::cout << "a quarter and a half of the range resolution: " << along.along[1] << ", " << along.along[2] << "\n";
    EXPECT_NEAR(along.along[1], 0.81, 0.04);
    EXPECT_NEAR(along.along[2], 0.41, 0.05);
    SonarConfig array = lineArray(0.003 / radians(1));  // resolves 1 deg ahead: beams are a quarter of it
    array.field_of_view_deg = 30;
    array.beam_count = 120;
    const SpeckleFigures across = computeFigures(getField(array, overBottom()));
    std::cout << "of the beam's: " << across.across[1] << ", " << across.across[2] << "\n";
    EXPECT_NEAR(across.across[1], 0.81, 0.04);
    EXPECT_NEAR(across.across[2], 0.41, 0.05);
}

TEST(SpecklePingTest, DoesNotDependOnThreads) {
    SonarConfig pattern = lineArray(0.003 / radians(1));
    pattern.pulse.emplace().bandwidth_khz = 10;
    for (const SonarConfig& config : {coherent(boxes()), coherent(boxes(), 10, 400), pattern}) {
        const types::Snapshot snapshot = overBottom();
        const auto bins = [&](int threads) {
            RenderOptions options;
            options.threads = threads;
            SonarRenderer renderer(config, snapshot.geometry, options);
            types::Sonar ping;
            renderer.render(snapshot, ping);
            return ping.bins;
        };
        EXPECT_GT(computeMean(getField(config, snapshot)), 0.5);
        EXPECT_EQ(bins(1), bins(2));
        EXPECT_EQ(bins(1), bins(5));
    }
}

TEST(SpecklePingTest, EqualScatterersHaveAScintillationIndexOfTwoMinusTheirFraction) {
    // N equal scatterers at random in one cell: <I^2> / <I>^2 = 2 - 1/N (Stanton, Lee and Baik 2018).
    SonarConfig config = coherent(boxes());
    config.beam_count = 1;
    config.field_of_view_deg = 10;
    config.range = 12;
    config.range_min = 8;
    config.bin_count = 12;
    types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::ground(-500)}));
    SonarRenderer renderer(config, snapshot.geometry);
    uint32_t state = 1;
    const auto random = [&] { return static_cast<double>((state = state * 1664525u + 1013904223u) >> 8) / (1 << 24); };
    for (const int count : {1, 2, 3, 4, 10, 100}) {
        constexpr int pings = 4000;
        double sum = 0, squares = 0;
        for (int i = 0; i < pings; ++i) {
            snapshot.targets.clear();
            for (int n = 0; n < count; ++n) {
                const double range = 10.05 + 0.9 * random(), azimuth = radians(9) * (random() - 0.5);
                snapshot.targets.push_back({{range * std::cos(azimuth), range * std::sin(azimuth), 0}, 0});
            }
            types::Sonar ping;
            renderer.render(snapshot, ping);
            const double intensity = static_cast<double>(ping.bins[10]);
            sum += intensity;
            squares += intensity * intensity;
        }
        const double index = pings * squares / (sum * sum);
        std::cout << count << " equal scatterers: " << index << "\n";
        EXPECT_NEAR(index, 2 - 1.0 / count, 0.12) << count << " scatterers";
    }
}

TEST(SpecklePingTest, FewScatterersAreKDistributedByTheirNumberInACell) {
    // Abraham and Lyons 2002: the shape is the number in a cell, which doubles with the width of the beam and with the
    // range.
    const double density = 400;
    const auto shapeBetween = [&](const SonarConfig& config, double near, double far) {
        const SpeckleField field = getField(config, overBottom());
        double squares = 0, sum = 0, count = 0;
        for (size_t beam = 0; beam < field.beam_count; ++beam)
            for (size_t bin = 0; bin < field.bin_count; ++bin) {
                const double range = (static_cast<double>(bin) + 0.5) * config.range / config.bin_count;
                if (range < near || range > far || !std::isfinite(field.at(beam, bin))) continue;
                sum += field.at(beam, bin);
                squares += field.at(beam, bin) * field.at(beam, bin);
                ++count;
            }
        return 2 / (squares * count / (sum * sum) - 2);
    };
    SonarConfig narrow = coherent(boxes(), 20, density);
    narrow.range = 40;
    narrow.bin_count = 400;
    narrow.beam_count = 360;  // 0.25 deg by 0.1 m
    SonarConfig wide = narrow;
    wide.beam_count = 180;
    const double near = shapeBetween(narrow, 9, 13), far = shapeBetween(narrow, 19, 24),
                 wider = shapeBetween(wide, 9, 13);
    std::cout << "shapes: " << near << ", farther off " << far << ", wider " << wider << "\n";
    EXPECT_NEAR(near, density * 0.1 * 11 * radians(0.25), 0.25 * near);
    EXPECT_NEAR(far / near, 21.5 / 11, 0.5);
    EXPECT_NEAR(wider / near, 2, 0.5);
}

TEST(SpecklePingTest, ScatteringWaterHasSpeckleToo) {
    SonarConfig config = coherent(boxes());
    config.volume = {VolumeLayer{{}, {}, -50}};
    const types::Snapshot open = test::makeSnapshot(test::makeScene({test::ground(-500)}));
    const SpeckleField field = getField(config, open);
    EXPECT_NEAR(computeMean(field), 1, 0.03);
    EXPECT_NEAR(computeFigures(field).scintillation.value, 1, 0.05);
    EXPECT_EQ(makePing(config, open).bins, makePing(config, open).bins);
}

TEST(SpecklePingTest, WaterInFrontOfABottomIsInTheReceivingBeam) {
    // Most samples of two beams side by side see the same triangle.
    SonarConfig config = coherent(boxes());
    config.volume = {VolumeLayer{{}, {}, -10}};
    const SpeckleField field = getField(config, overBottom());
    const auto bins = static_cast<size_t>(config.bin_count);
    double sums[2] = {}, counts[2] = {};
    for (size_t i = 0; i < field.relative.size(); ++i)
        if (std::isfinite(field.relative[i])) sums[i / bins % 2] += field.relative[i], ++counts[i / bins % 2];
    EXPECT_NEAR(sums[0] / counts[0], 1, 0.04) << "beams of even numbers";
    EXPECT_NEAR(sums[1] / counts[1], 1, 0.04) << "beams of odd numbers";
}

TEST(SpecklePingTest, WaterAndMirrorsAddEnergiesBecauseTheirFieldsAreIndependent) {
    SonarConfig config = coherent(boxes());
    config.volume = {VolumeLayer{{}, {}, -20}};
    config.multipath.emplace().surface.emplace();
    types::Snapshot snapshot = overBottom();
    snapshot.water_surface = 0.5;
    SonarConfig straight = config;
    straight.multipath.reset();
    straight.speckle.reset();
    const SpeckleField by_mirrors = overMeans(makePing(config, snapshot), makePing(straight, snapshot));
    EXPECT_GT(computeMean(by_mirrors), 1.05) << "mirrors add nothing that could be seen";
    EXPECT_NEAR(computeMean(getField(config, snapshot)), 1, 0.03);
}

TEST(SpecklePingTest, ATargetUnderAFlatSurfaceHasTheFringesOfLloydsMirror) {
    // Out and back by the straight path or by the surface, which inverts the pressure: the square of the sum.
    SonarConfig config = coherent(boxes());
    config.frequency_khz = 20;
    config.range = 60;
    config.bin_count = 30;  // all returns are in one bin
    config.beam_count = 1;
    config.field_of_view_deg = 10;
    config.multipath.emplace().surface.emplace();
    types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::ground(-500)}));
    snapshot.water_surface = 2;
    snapshot.targets = {{{40, 0, 0}, 0}};
    SonarRenderer renderer(config, snapshot.geometry);
    const double wavelength = 1500 / 20e3;
    int compared = 0;
    double worst = 0, without = 0;
    for (double depth = 1; depth < 4; depth += 0.02) {
        snapshot.targets[0].position.z = -depth;
        types::Sonar ping;
        renderer.render(snapshot, ping);
        const double direct = std::hypot(40, depth), mirrored = std::hypot(40, 4 + depth);
        const auto way = [&](double length) {
            return std::polar(1 / length, 2 * std::numbers::pi * std::fmod(length / wavelength, 1));
        };
        const double fringe = std::norm(way(direct) - way(mirrored));
        if (fringe < 0.1 / (direct * direct)) continue;  // near a null small errors matter
        const double level = 10 * std::log10(static_cast<double>(ping.bins[20]));
        worst = std::max(worst, std::abs(level - 20 * std::log10(fringe)));
        without =
            std::max(without, std::abs(level - 20 * std::log10(1 / (direct * direct) + 1 / (mirrored * mirrored))));
        ++compared;
    }
    std::cout << "Lloyd's mirror: at most " << worst << " dB off, without interference " << without << " dB\n";
    EXPECT_GT(compared, 100);
    EXPECT_LT(worst, 1);
    EXPECT_GT(without, 5);
}

TEST(SpecklePingTest, StiffCasesAreFinite) {
    const auto isFinite = [](const types::Sonar& ping) {
        return std::ranges::all_of(ping.bins, [](float bin) { return std::isfinite(bin) && bin >= 0; });
    };
    SonarConfig grazing = coherent(boxes());
    grazing.range = 2000;
    grazing.range_min = 0.1;
    grazing.beam_height_deg = 170;
    EXPECT_TRUE(isFinite(makePing(grazing, overBottom())));
    EXPECT_TRUE(isFinite(makePing(coherent(boxes(), 1, 1e-6), overBottom())));
    EXPECT_TRUE(isFinite(makePing(coherent(boxes(), 200, 1e9), overBottom())));
    SonarConfig around = coherent(boxes());
    around.range_min = 0;
    around.field_of_view_deg = 360;
    around.beam_height_deg = 180;
    around.bin_count = 1;
    EXPECT_TRUE(isFinite(makePing(around, test::makeSnapshot(test::makeScene({test::sphere(5, 30)})))));
    EXPECT_TRUE(isFinite(makePing(around, test::makeSnapshot(test::makeScene({test::ground(0)})))));
}

TEST(SpecklePingTest, ReportsMissingRequirements) {
    using testing::Contains, testing::HasSubstr;
    EXPECT_THAT(test::countRefusals(coherent(boxes())), testing::IsEmpty());
    SonarConfig silent = coherent(boxes());
    silent.frequency_khz.reset();
    EXPECT_THAT(test::countRefusals(silent), Contains(HasSubstr("without frequency_khz")));
    SonarConfig rasterised = coherent(boxes());
    rasterised.visibility = Visibility::Gl;
    EXPECT_THAT(test::countRefusals(rasterised), Contains(HasSubstr("needs rays")));
    SonarConfig mean = coherent(boxes());
    mean.model = Model::Cerqueira2017;
    EXPECT_THAT(test::countRefusals(mean), Contains(HasSubstr("cerqueira2017")));
}

/** The speckle of an object is its own: other objects may come, go and change places in the list. */
TEST(SpecklePingTest, AnObjectKeepsItsSpeckleWhenOthersAreAddedAndChangeTheirOrder) {
    SonarConfig config = coherent(boxes());
    config.range_min = 1;
    auto alone = std::make_shared<types::Geometry>(*test::makeScene({test::ground(-3)}));
    alone->objects[0].name = "floor";
    const types::Sonar first = makePing(config, test::makeSnapshot(alone));
    const auto both = [&](bool floor_last, const char* other) {
        auto scene = std::make_shared<types::Geometry>(
            *test::makeScene({test::ground(-3), test::disc(1, 0.1f)}, 0, {{}, {-50, 0, 0}}));
        scene->objects[0].name = "floor";
        scene->objects[1].name = other;
        if (floor_last) std::swap(scene->objects[0], scene->objects[1]);
        return makePing(config, test::makeSnapshot(scene));
    };
    EXPECT_EQ(both(false, "thing").bins, first.bins);
    EXPECT_EQ(both(true, "thing").bins, first.bins);
    EXPECT_EQ(both(true, "another").bins, first.bins);
    alone->objects[0].name = "bottom";
    EXPECT_NE(makePing(config, test::makeSnapshot(std::make_shared<types::Geometry>(*alone))).bins, first.bins);
}

/** Two places of one mesh, and two objects of one name, have their own speckle. */
TEST(SpecklePingTest, EqualObjectsOfOneNameHaveTheirOwnSpeckle) {
    SonarConfig config = coherent(boxes());
    config.range_min = 1;
    const auto withNames = [&](const char* one, const char* other) {
        auto scene = std::make_shared<types::Geometry>(*test::makeScene({test::ground(-3), test::ground(-3)}));
        scene->objects[0].name = one;
        scene->objects[1].name = other;
        types::Snapshot snapshot = test::makeSnapshot(scene);
        snapshot.moved = {{0, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -1000))}};  // only the second is near
        return makePing(config, snapshot);
    };
    EXPECT_NE(withNames("floor", "floor").bins, withNames("other", "floor").bins) << "the second of its name";
    EXPECT_EQ(withNames("a", "floor").bins, withNames("b", "floor").bins);
}

}  // namespace
}  // namespace insonify::study
