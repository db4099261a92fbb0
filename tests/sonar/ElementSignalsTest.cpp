// Signals of a straight array's elements: beams formed from them match the sonar's own bins.
#include <gmock/gmock.h>

#include <cmath>

#include "components/sonar/bins/LineArray.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/TaskBench.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using acoustics::Weighting;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/** A straight array whose beams are 3 degrees wide. */
SonarConfig makeArray(Weighting weighting) {
    SonarConfig config;
    config.speed_of_sound = 1500;
    config.frequency_khz = 300;
    config.range = 9;
    config.bin_count = 200;
    config.beam_count = 33;
    config.field_of_view_deg = 60;
    config.beam_height_deg = 60;
    config.beam_geometry = BeamGeometry::Conical;
    config.beam_pattern.emplace().receive.azimuth.emplace().weighting = weighting;
    config.beam_pattern->receive.azimuth->width_deg = 3;
    config.beam_pattern->transmit.azimuth.emplace().weighting = Weighting::Gaussian;
    config.beam_pattern->transmit.azimuth->width_deg = 70;
    config.beam_pattern->floor_db = -40;
    config.pulse.emplace().bandwidth_khz = 20;
    config.speckle.emplace().coherent = true;
    config.elements.emplace();
    config.quality.rows = 64;
    config.quality.columns_per_beam = 2;
    return config;
}

/** A level bottom with a ball on it. */
types::Snapshot twoTargets() {
    return test::makeSnapshot(test::makeScene({test::ground(-2), test::sphere(0.5, 32)}, 0, {{}, {6, 1, -1.5}}));
}

struct Received {
    types::Sonar ping;
    types::SonarElements signals;
};

Received received(const SonarConfig& config, const types::Snapshot& snapshot = twoTargets()) {
    Received result;
    SonarRenderer renderer(config, snapshot.geometry);
    renderer.setElements(result.ping, &result.signals);
    renderer.render(snapshot, result.ping);
    return result;
}

/** Returns the bins of beams at the bearings of the ping.
 *  @param turn -1: with port and starboard exchanged */
std::vector<double> beamformed(const Received& received, const acoustics::Taper& taper, double turn = 1) {
    const types::SonarElements& signals = received.signals;
    const size_t count = signals.positions.size();
    const LineArray array(count, signals.positions[1] - signals.positions[0], signals.wavelength, taper);
    ComplexRows rows(count, signals.sample_count);
    for (size_t i = 0; i < rows.values.size(); ++i) rows.values[i] = {signals.in_phase[i], signals.quadrature[i]};
    std::vector<double> sines;
    for (const types::Angle& bearing : received.ping.bearings) sines.push_back(turn * std::sin(bearing.rad));
    const ComplexRows beams = array.form(rows, sines);
    const size_t per_bin = signals.sample_count / received.ping.bin_count;
    std::vector<double> bins(received.ping.bins.size());
    for (size_t i = 0; i < beams.values.size(); ++i)
        bins[i / per_bin] += std::norm(std::complex<double>(beams.values[i])) / static_cast<double>(per_bin);
    return bins;
}

/** The errors of the bins with at least a share of the mean at their range: the share of bins with an error above 0.5
 *  dB, and the error of the total energy [dB]. */
struct Off {
    double share = 0, energy_db = 0;
};

Off off(const types::Sonar& ping, const std::vector<double>& bins, double minimum = 1e-3) {
    double count = 0, wrong = 0, sum = 0, own_sum = 0;
    for (size_t k = 0; k < ping.bin_count; ++k) {
        double mean = 0;
        for (size_t beam = 0; beam < ping.beam_count; ++beam)
            mean += static_cast<double>(ping.bins[beam * ping.bin_count + k]) / ping.beam_count;
        for (size_t i = k; i < bins.size(); i += ping.bin_count) {
            const auto own = static_cast<double>(ping.bins[i]);
            if (own < minimum * mean || own == 0) continue;
            count += 1, sum += bins[i], own_sum += own;
            wrong += std::abs(10 * std::log10(bins[i] / own)) > 0.5;
        }
    }
    EXPECT_GT(count, 1000);
    return {wrong / count, 10 * std::log10(sum / own_sum)};
}

/** twoTargets() with other scatterers. */
types::Snapshot redrawn(int draw) {
    types::Snapshot snapshot = twoTargets();
    types::Geometry geometry = *snapshot.geometry;
    for (types::Object& object : geometry.objects) object.name += std::to_string(draw);
    snapshot.geometry = std::make_shared<types::Geometry>(std::move(geometry));
    return snapshot;
}

/** A mean over draws of the scatterers. */
class Mean {
public:
    void add(double value) { ++count_, sum_ += value, squares_ += value * value; }
    double value() const { return sum_ / count_; }
    /** Returns the standard error of the mean. */
    double error() const { return std::sqrt(std::max(0.0, squares_ / count_ - value() * value()) / (count_ - 1)); }

private:
    double count_ = 0, sum_ = 0, squares_ = 0;
};

/** Means of the bins above the mean at their range, of bins to 20 dB below it, and of the total energy. */
struct MeanOff {
    MeanOff(Weighting weighting, int columns, int draws) {
        SonarConfig config = makeArray(weighting);
        config.quality.columns_per_beam = columns;
        for (int draw = 0; draw < draws; ++draw) {
            const Received both = received(config, redrawn(draw));
            const std::vector<double> bins = beamformed(both, acoustics::Taper(weighting));
            above_mean.add(off(both.ping, bins, 1).share);
            all.add(off(both.ping, bins, 1e-2).share);
            energy_db.add(off(both.ping, bins).energy_db);
            EXPECT_GT(off(both.ping, beamformed(both, acoustics::Taper(weighting), -1), 1).share, 0.5)
                << "turned about";
            const Weighting other = weighting == Weighting::Uniform ? Weighting::Hann : Weighting::Uniform;
            EXPECT_GT(off(both.ping, beamformed(both, acoustics::Taper(other)), 1).share, 0.3) << "other weights";
        }
    }
    Mean above_mean, all, energy_db;
};

/** A bin in a fade differs more, so shares vary with the scatterers: bounds hold for the mean over all draws, three
 *  standard errors above the mean of these. The far sidelobes of elements differ from those of a continuous line, which
 *  matters without weights. */
TEST(ElementSignalsTest, BeamsFormedFromTheElementsMatchThePingsBins) {
    struct Bound {
        Weighting weighting;
        double above_mean, all;
    };
    for (const auto& [weighting, above_mean, all] :
         {Bound{Weighting::Uniform, 0.01, 0.1}, Bound{Weighting::Hann, 0.001, 0.004},
          Bound{Weighting::Taylor, 0.001, 0.03}}) {
        const MeanOff mean(weighting, 4, 12);
        EXPECT_LT(mean.above_mean.value() + 3 * mean.above_mean.error(), above_mean) << static_cast<int>(weighting);
        EXPECT_LT(mean.all.value() + 3 * mean.all.error(), all) << static_cast<int>(weighting);
        EXPECT_LT(std::abs(mean.energy_db.value()) + 3 * mean.energy_db.error(), 0.03) << static_cast<int>(weighting);
    }
}

/** A beam receives a cell with its mean power, elements receive it with its mean field, which is less: at a null it is
 *  none. So errors fall with the width of the cells. */
TEST(ElementSignalsTest, NarrowerCellsBringThemNearer) {
    for (const Weighting weighting : {Weighting::Uniform, Weighting::Hann, Weighting::Taylor}) {
        const MeanOff wide(weighting, 2, 12), narrow(weighting, 4, 12);
        EXPECT_LT(narrow.all.value(), 0.65 * wide.all.value()) << static_cast<int>(weighting);
        EXPECT_LE(narrow.above_mean.value(), 0.4 * wide.above_mean.value()) << static_cast<int>(weighting);
        EXPECT_NEAR(wide.energy_db.value(), -0.052, 0.01) << static_cast<int>(weighting);
        EXPECT_LT(std::abs(narrow.energy_db.value()), 0.4 * std::abs(wide.energy_db.value()));
    }
}

TEST(ElementSignalsTest, HavePositionsOfElementsAndRangesOfSamples) {
    const Received both = received(makeArray(Weighting::Uniform));
    const types::SonarElements& signals = both.signals;
    EXPECT_EQ(signals.diagnostic(), nullptr);
    EXPECT_EQ(signals.time, both.ping.time);
    EXPECT_NEAR(signals.wavelength, 0.005, 1e-12);
    const size_t count = signals.positions.size();
    EXPECT_NEAR(static_cast<double>(count), 0.8859 / std::sin(types::radians(1.5)), 1) << "half a wavelength apart";
    EXPECT_NEAR(signals.positions.back() - signals.positions.front(), static_cast<double>(count - 1) * 0.0025, 1e-3);
    EXPECT_NEAR(signals.positions.front(), -signals.positions.back(), 1e-12);
    EXPECT_EQ(signals.sample_count % both.ping.bin_count, 0u);
    EXPECT_NEAR(signals.range(signals.sample_count - 1) + 0.5 * signals.sample_spacing, 9, 0.01);
    EXPECT_NEAR(signals.range(0), 0.5 * signals.sample_spacing, 1e-12);
}

TEST(ElementSignalsTest, FewerElementsAreFartherApartAndReceiveTheSamePlaces) {
    SonarConfig config = makeArray(Weighting::Uniform);
    config.elements->count = 20;
    const types::SonarElements sparse = received(config).signals,
                               dense = received(makeArray(Weighting::Uniform)).signals;
    EXPECT_EQ(sparse.positions.size(), 20u);
    EXPECT_NEAR(20 * (sparse.positions[1] - sparse.positions[0]),
                static_cast<double>(dense.positions.size()) * (dense.positions[1] - dense.positions[0]), 1e-9);
}

TEST(ElementSignalsTest, RejectsInvalidArraysWithTheReason) {
    EXPECT_THAT(test::countRefusals(makeArray(Weighting::Taylor)), testing::IsEmpty());
    SonarConfig config = makeArray(Weighting::Uniform);
    config.speckle.reset();
    EXPECT_THAT(test::countRefusals(config),
                ElementsAre("elements: need speckle: {coherent: true}; without it energies are summed, "
                            "not fields"));
    config = makeArray(Weighting::Uniform);
    config.beam_geometry = BeamGeometry::Planar;
    EXPECT_THAT(test::countRefusals(config),
                ElementsAre("elements: need beam_geometry: conical, because a straight array receives cones"));
    config = makeArray(Weighting::Uniform);
    config.beam_pattern.reset();
    EXPECT_THAT(test::countRefusals(config),
                ElementsAre("elements: need beam_pattern.receive.azimuth, whose aperture they fill"));
    EXPECT_THAT(test::countRefusals(makeArray(Weighting::Gaussian)),
                ElementsAre(HasSubstr("a measured table, gaussian")));
    config = makeArray(Weighting::Uniform);
    config.elements->count = 20;
    config.elements->spacing_m = 0.01;
    EXPECT_THAT(test::countRefusals(config),
                ElementsAre(HasSubstr("elements: are 20 that are 0.01 m apart, 0.2 m in all; the aperture of "
                                      "beam_pattern.receive.azimuth is 0.0846")));
}

struct ElementPortTest : test::TaskBench<SonarTask, types::SnapshotPtr, types::SonarPtr> {
    ElementPortTest() : TaskBench(&SonarTask::snapshot, &SonarTask::ping) {}
    test::Reader<types::SonarElementsPtr> signals_;
};

TEST_F(ElementPortTest, ThePortWritesTheElementsOfEachPing) {
    task_.elements.connectTo(signals_.port, framework::ConnPolicy::buffer(4));
    startWith(makeArray(Weighting::Uniform));
    const types::SonarPtr ping = answerTo(std::make_shared<const types::Snapshot>(twoTargets()));
    types::SonarElementsPtr signals;
    ASSERT_TRUE(ping && signals_.port.readNew(signals));
    const Received expected = received(makeArray(Weighting::Uniform));
    EXPECT_EQ(ping->bins, expected.ping.bins) << "with or without the port";
    EXPECT_EQ(signals->in_phase, expected.signals.in_phase);
    EXPECT_EQ(signals->time, ping->time);
}

TEST_F(ElementPortTest, SignalsBelongToTheirPingWhileTheQualityIsChosenAndWatched) {
    task_.elements.connectTo(signals_.port, framework::ConnPolicy::buffer(4));
    SonarConfig config = makeArray(Weighting::Hann);
    config.quality = {};
    config.quality.max_samples = 100'000;
    startWith(config);
    for (int i = 0; i < 12; ++i) {
        types::Snapshot snapshot = twoTargets();
        snapshot.time.microseconds += i * 100'000;
        snapshot.sonar.position.x = 0.05 * i;
        const types::SonarPtr ping = answerTo(std::make_shared<const types::Snapshot>(snapshot));
        types::SonarElementsPtr signals;
        ASSERT_TRUE(ping && signals_.port.readNew(signals));
        const Received both{*ping, *signals};
        EXPECT_NEAR(off(both.ping, beamformed(both, acoustics::Taper(Weighting::Hann))).energy_db, 0, 0.2) << i;
        SonarConfig same = config;
        same.quality = {};
        same.quality.rows = task_.plan()->rows;
        same.quality.columns_per_beam = task_.plan()->columns_per_beam;
        const Received expected = received(same, snapshot);
        EXPECT_EQ(both.ping.bins, expected.ping.bins) << i;
        EXPECT_EQ(both.signals.in_phase, expected.signals.in_phase) << i << ": signals of another quality";
    }
}

TEST_F(ElementPortTest, RejectsAConnectedPortOfASonarWithoutElements) {
    task_.elements.connectTo(signals_.port, framework::ConnPolicy::buffer(4));
    SonarConfig config = makeArray(Weighting::Uniform);
    config.elements.reset();
    task_.config.set(config);
    EXPECT_FALSE(task_.configure());
    EXPECT_THAT(task_.lastError(), HasSubstr("is connected; the sonar has none: give it `elements`"));
}

}  // namespace
}  // namespace insonify::sonar
