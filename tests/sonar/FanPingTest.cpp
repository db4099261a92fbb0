// Pings, truth and returns of random tables of bearings, with every effect. Rows do not depend on the order of the
// table, on the place of the fan about the seam, or on the other beams.
#include <gmock/gmock.h>

#include <functional>

#include "components/sonar/bins/Detection.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Surfaces.hpp"
#include "tests/support/Tables.hpp"
#include "types/geometry/Angle.hpp"
#include "types/samples/SonarReturns.hpp"

namespace insonify::sonar {
namespace {

using types::radians;

/** One effect, its configuration, and its needs. */
struct FanEffect {
    const char* name;
    std::function<void(SonarConfig&)> ask;
    bool rasterised = true;   ///< The rasterised path supports it.
    bool independent = true;  ///< A beam's echoes do not depend on the other beams of the fan.
    double alone = 0.03;      ///< Max error of a beam alone, in relative L2 [1].
    bool turns = true;        ///< Samples are at the same places in beams of any bearing.
    double agree = 0.05;      ///< Max difference of rays and pictures, in relative L2 [1].
};

BeamPatternConfig pattern() {
    BeamPatternConfig pattern;
    pattern.receive.azimuth.emplace().width_deg = 4;
    pattern.transmit.elevation.emplace().width_deg = 30;
    pattern.transmit.elevation->weighting = acoustics::Weighting::Gaussian;  // no sidelobes outside of the pictures
    return pattern;
}

std::vector<FanEffect> fanEffects() {
    const auto plain = [](SonarConfig&) {};
    const auto coherent = [](SonarConfig& c) {
        c.frequency_khz = 300;
        c.speckle = SpeckleConfig{true, 5, {}};
    };
    return {
        {"plain", plain},
        {"conical", [](SonarConfig& c) { c.beam_geometry = BeamGeometry::Conical; }, true, true, 0.03, true, 0.12},
        {"cerqueira2017", [](SonarConfig& c) { c.model = Model::Cerqueira2017; }, true, true, 0.03, false, 0.2},
        {"volume",
         [](SonarConfig& c) {
             c.volume = {{{}, {}, -30}};
         }},
        {"layers",
         [](SonarConfig& c) {
             c.volume = {{{}, 2, -30}, {2, {}, -40}};
         }},
        {"pattern", [](SonarConfig& c) { c.beam_pattern = pattern(); }, true, true, 0.1, false, 0.12},
        {"pattern and pulse",
         [](SonarConfig& c) {
             c.beam_pattern = pattern();
             c.pulse.emplace().bandwidth_khz = 2;
         },
         true, true, 0.1, false, 0.12},
        {"multipath",
         [](SonarConfig& c) {
             c.multipath.emplace().surface.emplace();
             c.multipath->bounces = 2;
         },
         false, false},
        {"motion", [](SonarConfig& c) { c.motion_in_ping = true; }, false, false},
        {"coherent", coherent, false, true, 0.05},
        {"coherent with pattern and pulse",
         [coherent](SonarConfig& c) {
             coherent(c);
             c.beam_pattern = pattern();
             c.pulse.emplace().bandwidth_khz = 2;
         },
         false, false, 0, false},
    };
}

/** A sonar of 100 bins of 0.2 m. */
SonarConfig sonar(const test::Table& table, const FanEffect& effect, Visibility visibility = Visibility::Cpu) {
    SonarConfig config;
    config.speed_of_sound = 1000;
    config.range = 20;
    config.bin_count = 100;
    config.beam_height_deg = 40;
    config.bearings_deg = table.bearings_deg;
    config.beam_width_deg = table.width_deg;
    config.quality.rows = 96;
    config.quality.columns_per_beam = 2;
    config.visibility = visibility;
    config.device = visibility == Visibility::Gl ? "software" : "";
    effect.ask(config);
    return config;
}

/** Seabed, balls, wall and three point targets, 3 m below the surface. No object is thinner than a sample. */
types::GeometryPtr resolved() {
    auto geometry = test::surfaces();
    std::erase_if(geometry->objects,
                  [](const types::Object& object) { return object.name == "plate" || object.name == "block"; });
    return geometry;
}

/** Returns the scene of a sonar that is rotated by `yaw` [rad]. */
types::Snapshot scene(double yaw = 0) {
    static const types::GeometryPtr geometry = resolved();
    types::Snapshot snapshot = test::makeSnapshot(geometry, {}, yaw);
    snapshot.targets = {{{8, 1, 0}, 5}, {{-9, 0.5, 0.2}, 5}, {{3, -9, -0.5}, 5}};
    snapshot.target_names = std::make_shared<const std::vector<std::string>>(3, "target");
    snapshot.water_surface = 3;
    snapshot.sonar.velocity = {1.5, 0.2, 0};
    snapshot.sonar.angular_velocity = {0, 0, 0.3};
    return snapshot;
}

struct Shown {
    types::Sonar ping;
    types::SonarTruth truth;
    types::SonarReturns returns;
};

Shown getShown(const SonarConfig& config, const types::Snapshot& snapshot, int threads = 2) {
    SonarRenderer renderer(config, snapshot.geometry, {.threads = threads});
    Shown shown;
    renderer.setTruth(shown.ping, &shown.truth);
    renderer.render(snapshot, shown.ping);
    shown.truth.objects.resize(snapshot.geometry->objects.size());
    Detector detector;
    detector.take(shown.ping, {}, DetectionRules::of(renderer.renderPlan()));
    std::vector<uint32_t> strongest;
    for (uint32_t beam = 0; beam < shown.ping.beam_count; ++beam) {
        const auto found = detector.strongest(beam);
        strongest.push_back(found ? static_cast<uint32_t>(found->bin) : shown.ping.bin_count);
    }
    shown.returns.take(shown.ping, shown.truth, strongest);
    return shown;
}

template <class T>
std::span<const T> getRow(const std::vector<T>& values, size_t row, size_t rows) {
    return std::span(values).subspan(row * (values.size() / rows), values.size() / rows);
}

/** Returns whether two rows are the same bit for bit; NaN equals NaN. */
template <class T>
bool same(std::span<const T> a, std::span<const T> b) {
    return std::ranges::equal(a, b, [](T x, T y) { return x == y || (x != x && y != y); });
}

/** Expects row `row` of one to equal row `other_row` of the other, in all outputs of a beam. */
void expectSameRow(const Shown& shown, size_t row, const Shown& other, size_t other_row) {
    const size_t beams = shown.ping.beam_count;
    EXPECT_EQ(shown.ping.bearings[row].rad, other.ping.bearings[other_row].rad);
    const auto compare = [&](const char* name, const auto& mine, const auto& theirs) {
        EXPECT_TRUE(same(getRow(mine, row, beams), getRow(theirs, other_row, beams))) << name << " of row " << row;
    };
    compare("bins", shown.ping.bins, other.ping.bins);
    compare("object", shown.truth.object, other.truth.object);
    compare("elevation", shown.truth.elevation, other.truth.elevation);
    compare("share", shown.truth.share, other.truth.share);
    compare("hits", shown.truth.hits, other.truth.hits);
    compare("grazing", shown.truth.grazing, other.truth.grazing);
    compare("path", shown.truth.path, other.truth.path);
    compare("shadow", shown.truth.shadow, other.truth.shadow);
    compare("first range", shown.returns.first_range, other.returns.first_range);
    compare("strongest level", shown.returns.strongest_level, other.returns.strongest_level);
}

double difference(std::span<const float> a, std::span<const float> b) {
    double error = 0, norm = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        error += std::pow(double{a[i]} - double{b[i]}, 2);
        norm += std::pow(double{b[i]}, 2);
    }
    return norm > 0 ? std::sqrt(error / norm) : std::sqrt(error);
}

bool isAhead(const test::Table& table) {
    return std::ranges::all_of(table.bearings_deg, [&](double b) { return std::abs(b) + table.width_deg / 2 < 90; });
}

/** Returns whether a straight array, which covers only bearings ahead, can have the fan. */
bool canHave(const test::Table& table, const SonarConfig& config) {
    return config.beam_geometry == BeamGeometry::Planar || isAhead(table);
}

struct FanPingTest : testing::TestWithParam<FanEffect> {
    void forTables(int rounds, const auto& use) const {
        std::mt19937 random(7);
        for (int round = 0; round < rounds; ++round)
            for (const test::Table& table : test::drawTables(random)) {
                SCOPED_TRACE(testing::PrintToString(table));
                if (canHave(table, sonar(table, GetParam()))) use(table, random);
            }
    }
};

TEST_P(FanPingTest, AnyOrderOfTheTableGivesTheSameRows) {
    forTables(2, [&](const test::Table& table, std::mt19937& random) {
        for (const Visibility visibility : {Visibility::Cpu, Visibility::Gl}) {
            if (visibility == Visibility::Gl && !GetParam().rasterised) continue;
            const Shown ascending = getShown(sonar(table, GetParam(), visibility), scene());
            std::vector<size_t> rows(table.bearings_deg.size());
            for (size_t i = 0; i < rows.size(); ++i) rows[i] = rows.size() - 1 - i;
            for (int order = 0; order < 2; ++order) {
                test::Table other = table;
                for (size_t i = 0; i < rows.size(); ++i) other.bearings_deg[i] = table.bearings_deg[rows[i]];
                const Shown shown = getShown(sonar(other, GetParam(), visibility), scene(), 1 + order);
                for (size_t i = 0; i < rows.size(); ++i) expectSameRow(shown, i, ascending, rows[i]);
                std::ranges::shuffle(rows, random);
            }
        }
    });
}

TEST_P(FanPingTest, AFanIsTheSameAnywhereAboutTheSeam) {
    if (!GetParam().turns) return;
    if (sonar({"", {0}, 1}, GetParam()).beam_geometry == BeamGeometry::Conical) return;  // covers only bearings ahead
    forTables(1, [&](const test::Table& table, std::mt19937& random) {
        const Shown here = getShown(sonar(table, GetParam()), scene());
        const double turn = std::uniform_real_distribution<double>(120, 240)(random);
        test::Table turned = table;
        for (double& bearing : turned.bearings_deg) bearing = test::wrappedDeg(bearing + turn);
        const Shown there = getShown(sonar(turned, GetParam()), scene(radians(-turn)));
        for (size_t row = 0; row < table.bearings_deg.size(); ++row)
            EXPECT_LT(difference(getRow(there.ping.bins, row, table.bearings_deg.size()),
                                 getRow(here.ping.bins, row, table.bearings_deg.size())),
                      0.03)
                << "row " << row << " turned by " << turn;
    });
}

TEST_P(FanPingTest, EachBeamIsTheSameAlone) {
    if (!GetParam().independent) return;
    forTables(1, [&](const test::Table& table, std::mt19937&) {
        const auto fine = [&](SonarConfig config) {
            config.quality.rows = 256;
            config.quality.columns_per_beam = 8;
            return config;
        };
        const Shown all = getShown(fine(sonar(table, GetParam())), scene());
        for (size_t row = 0; row < table.bearings_deg.size(); ++row) {
            const Shown alone =
                getShown(fine(sonar({"alone", {table.bearings_deg[row]}, table.width_deg}, GetParam())), scene());
            EXPECT_LT(difference(getRow(all.ping.bins, row, table.bearings_deg.size()), alone.ping.bins),
                      GetParam().alone)
                << "row " << row;
        }
    });
}

/** Returns the scene without one facet of each ball, whose facets are then planes for rays too: pictures have no
 *  limb. */
types::Snapshot withoutLimbs(types::Snapshot snapshot) {
    const auto geometry = std::make_shared<types::Geometry>(*snapshot.geometry);
    for (const types::Object& object : geometry->objects) {
        if (object.name.find("ball") == std::string::npos) continue;
        types::Mesh mesh = geometry->meshes[static_cast<size_t>(object.mesh)];
        mesh.indices.resize(mesh.indices.size() - 3);
        mesh.clusters.back().index_count -= 3;
        geometry->meshes[static_cast<size_t>(object.mesh)] = mesh;
    }
    snapshot.geometry = geometry;
    return snapshot;
}

TEST_P(FanPingTest, RaysAndPicturesAgree) {
    if (!GetParam().rasterised) return;
    forTables(1, [&](const test::Table& table, std::mt19937&) {
        const auto fine = [&](SonarConfig config) {
            config.quality.rows = 384;
            config.quality.columns_per_beam = 8;
            return config;
        };
        const Shown traced = getShown(fine(sonar(table, GetParam())), withoutLimbs(scene()));
        SonarConfig pictures = fine(sonar(table, GetParam(), Visibility::Gl));
        if (pictures.beam_pattern) pictures.quality.rows = 2048;  // of 150 deg, even in their tangent
        const Shown rasterised = getShown(pictures, withoutLimbs(scene()));
        EXPECT_LT(difference(rasterised.ping.bins, traced.ping.bins), GetParam().agree);
    });
}

INSTANTIATE_TEST_SUITE_P(Effects, FanPingTest, testing::ValuesIn(fanEffects()), [](const auto& effect) {
    std::string name = effect.param.name;
    std::ranges::replace(name, ' ', '_');
    return name;
});

/** Coherent beams that overlap or leave gaps keep the energy of the ping that sums energies. */
TEST(FanPingTest, CoherentSpeckleKeepsTheEnergyOfEveryTable) {
    std::mt19937 random(3);
    for (const test::Table& table : test::drawTables(random)) {
        SCOPED_TRACE(testing::PrintToString(table));
        SonarConfig energies = sonar(table, fanEffects().front());
        energies.frequency_khz = 300;
        energies.bin_count = 400;
        energies.quality.rows = 256;
        SonarConfig fields = energies;
        fields.speckle = SpeckleConfig{true, 10, {}};
        const types::Snapshot floor = test::makeSnapshot(test::makeScene({test::ground(-3)}));
        const types::Sonar mean = getShown(energies, floor).ping, speckled = getShown(fields, floor).ping;
        for (size_t row = 0; row < mean.beam_count; ++row) {
            double sum = 0, count = 0;
            for (size_t bin = 190; bin < 400; ++bin, ++count)  // the floor begins at bin 175
                sum += double{speckled.bins[row * 400 + bin]} / double{mean.bins[row * 400 + bin]};
            EXPECT_NEAR(sum / count, 1, 4 / std::sqrt(count)) << "beam " << row;
        }
    }
}

/** Scatterers have places on surfaces: a bin has the same, to the bit, whatever bins and blanking are about it. Patches
 *  that the first or the last bin cuts off have a corner off their plane. */
TEST(FanPingTest, ABinHasItsScatterersWhateverBinsAreAboutIt) {
    std::mt19937 random(11);
    const auto upTo = [&](double end) { return std::uniform_real_distribution<double>(0, end)(random); };
    size_t echoes = 0;
    for (int drawn = 0; drawn < 40; ++drawn) {
        SonarConfig config = test::getSonar({.beams = 2 + static_cast<int>(upTo(30)),
                                             .width_deg = 20 + upTo(140),
                                             .height_deg = 10 + upTo(50),
                                             .bins = 280,
                                             .rows = 1 << (3 + drawn % 5),
                                             .columns = 1 + static_cast<int>(upTo(4))});
        config.visibility = Visibility::Cpu;
        config.frequency_khz = 300;
        config.speckle = SpeckleConfig{true, 5, {}};
        if (drawn % 2 == 0) config.beam_geometry = BeamGeometry::Conical;
        const glm::dvec3 place(upTo(6), upTo(4) - 2, upTo(2));
        const types::Snapshot scene = test::makeSnapshot(test::surfaces(), place, upTo(6.28), upTo(0.6));
        const types::Sonar whole = test::makePing(config, scene);
        const int bins = 40 + static_cast<int>(upTo(200));
        SonarConfig part = config;
        part.range *= bins / 280.0;
        part.bin_count = bins;
        const types::Sonar ping = test::makePing(part, scene);
        for (size_t beam = 0; beam < ping.beam_count; ++beam)
            for (int bin = 0; bin < bins; ++bin) {
                const float got = ping.bins[beam * bins + bin], expected = whole.bins[beam * 280 + bin];
                ASSERT_EQ(got, expected) << "sonar " << drawn << ", beam " << beam << ", bin " << bin << " of " << bins;
                echoes += got > 0;
            }
    }
    EXPECT_GT(echoes, 5000u);
}

}  // namespace
}  // namespace insonify::sonar
