#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "components/sonar/base/Counters.hpp"
#include "components/sonar/renderer/Metrics.hpp"
#include "components/sonar/renderer/Quality.hpp"
#include "components/sonar/renderer/QualityKeeper.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "components/sonar/tasks/ScanningSonarTask.hpp"
#include "components/study/StudyScene.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::sonar {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

constexpr double forever = std::numeric_limits<double>::infinity();

SonarConfig small() {
    SonarConfig config;
    config.range = 30;
    config.bin_count = 150;
    config.beam_count = 16;
    config.field_of_view_deg = 60;
    config.device = "software";
    return config;
}

types::GeometryPtr floorAndWall() {
    const study::FractalFloor floor = {
        .points = 128, .side = 80, .slope = -1.7, .rms = 0.3, .centre_x = 0, .depth = 3, .seed = 1};
    return test::makeScene({study::getMesh(floor), test::wall(-4)}, -10);
}

/** Looks at the open floor, or at the wall behind. */
types::Snapshot outwards(const types::GeometryPtr& scene) { return test::makeSnapshot(scene, {}, 0, 0.14); }
types::Snapshot toTheWall(const types::GeometryPtr& scene) { return test::makeSnapshot(scene, {}, 3.14159, 0.14); }

TEST(QualityLadderTest, ChoosesTheCheapestThatReachesTheTargetElseTheFinestWithinTheCap) {
    const QualityLadder ladder(small());
    const ErrorModel model{{64, 2}, 0.3, 0.1};
    const Quality enough = ladder.choose(model, 0.1, forever);
    EXPECT_LE(enough.error, 0.1);
    EXPECT_GT(enough.rows, 64);
    EXPECT_EQ(enough.error, model.error(enough.rows, enough.columns_per_beam));
    EXPECT_LE(ladder.choose(model, 0.1, 0.9 * enough.samples()).samples(), 0.9 * enough.samples());
    EXPECT_GT(ladder.choose(model, 0.1, 0.9 * enough.samples()).error, 0.1);
    EXPECT_EQ(ladder.choose(model, 1, forever), Quality()) << "64 x 2 will do";
    EXPECT_EQ(ladder.choose(model, 0, 1), Quality()) << "never less than 64 x 2";
    EXPECT_EQ(ladder.choose(model, 0, 10 * 128 * 3, {64, 20}).columns_per_beam, 24) << "never below the minimum";
}

TEST(QualityLadderTest, RungsForABudgetAreAtMostATenthApart) {
    const QualityLadder ladder(small());
    const ErrorModel model{{64, 2}, 0.3, 0.1};
    for (double samples = 128; samples < 3e4; samples *= 1.05)
        EXPECT_GE(ladder.choose(model, 0, samples).samples(), samples / 1.12) << samples;
}

TEST(ClimbTest, TakesLessThanEightyPingsAndRendersThePingAtItsQuality) {
    const auto scene = floorAndWall();
    SonarConfig config = small();
    config.quality.target_error = 0.03;
    SonarRenderer renderer(config, scene);
    ErrorEstimator estimator(config, min_share * 0.03);
    types::Sonar ping;
    renderer.setQuality(64, 2);
    renderer.render(outwards(scene), ping);
    const ErrorModel model =
        climb(estimator, QualityLadder(config), renderer, outwards(scene), Quality(), {0.03}, ping);
    EXPECT_LE(model.at.error, 0.03);
    EXPECT_GT(model.at.samples(), 8 * Quality().samples());
    EXPECT_LT(estimator.rendered(), 80 * model.at.samples()) << "trials cost more than the pings they evaluate";
    types::Sonar same;
    renderer.setQuality(model.at.rows, model.at.columns_per_beam);
    renderer.render(outwards(scene), same);
    EXPECT_EQ(ping.bins, same.bins);
}

TEST(ClimbTest, AnEmptySeaHasNoErrorAtOnce) {
    const auto scene = test::makeScene({test::ground(500)});
    SonarConfig config = small();
    EXPECT_EQ(chooseQuality(config, test::makeSnapshot(scene)), Quality());
    EXPECT_EQ(chooseQuality(config, test::makeSnapshot(scene)).error, 0);
}

/** A task that gets a snapshot at a time. */
template <class Task>
class Fed {
public:
    template <class Config>
    explicit Fed(const Config& config) {
        in_.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(4));
        task.ping.connectTo(out_.port, framework::ConnPolicy::buffer(4));
        task.config.set(config);
        if (!task.configure() || !task.start()) throw std::runtime_error(task.lastError());
    }
    types::SonarPtr ping(types::Snapshot snapshot) {
        snapshot.time = types::Time::fromSeconds(0.1 * ++count_);
        in_.port.write(std::make_shared<types::Snapshot>(snapshot));
        task.update();
        types::SonarPtr ping;
        out_.port.readNew(ping);
        return ping;
    }
    Quality quality() const { return {task.plan()->rows, task.plan()->columns_per_beam, task.plan()->predicted_error}; }
    /** Returns the messages about a quality. */
    std::vector<std::string> notices() const {
        std::vector<std::string> all = types::lines(task.notices());
        std::erase_if(all, [](const std::string& notice) { return notice.find("quality") == std::string::npos; });
        return all;
    }

    Task task{"sonar"};

private:
    test::Writer<types::SnapshotPtr> in_;
    test::Reader<types::SonarPtr> out_;
    int count_ = 0;
};

TEST(QualityTaskTest, ReportsTheChoiceItsErrorAndCostAfterTheFirstEcho) {
    const auto scene = floorAndWall();
    Fed<SonarTask> sonar(small());
    sonar.ping(test::makeSnapshot(scene, {}, 0, -1.2));
    EXPECT_TRUE(std::isnan(sonar.quality().error)) << "it looks at the sky";
    EXPECT_EQ(sonar.quality(), Quality());
    EXPECT_THAT(sonar.notices(), testing::IsEmpty());
    sonar.ping(outwards(scene));
    EXPECT_LE(sonar.quality().error, 0.05) << "the default target";
    EXPECT_GT(sonar.quality().samples(), Quality().samples());
    const std::string samples = std::to_string(static_cast<int>(16 * sonar.quality().samples()));
    EXPECT_THAT(sonar.notices(),
                testing::ElementsAre(
                    AllOf(HasSubstr(samples + " samples per ping, predicted error 0.0"), HasSubstr("target 0.05"))));
}

TEST(QualityTaskTest, RespectsTheMaxSamplesAndReportsAMissedTargetOnce) {
    const auto scene = floorAndWall();
    SonarConfig config = small();
    config.quality.max_samples = 16 * 64 * 4;
    Fed<SonarTask> sonar(config);
    for (int i = 0; i < 30; ++i) sonar.ping(outwards(scene));
    EXPECT_LE(16 * sonar.quality().samples(), 16 * 64 * 4);
    EXPECT_GT(sonar.quality().error, 0.05);
    EXPECT_THAT(sonar.notices(), testing::ElementsAre(AllOf(HasSubstr("Warning: quality"), HasSubstr("predicted error"),
                                                            HasSubstr("misses the target of 0.05: max_samples 4096"))));
}

TEST(QualityTaskTest, ATargetAloneTakesTheSamplesThatItNeeds) {
    const auto scene = floorAndWall();
    SonarConfig config = small();
    config.quality.target_error = 0.01;
    Fed<SonarTask> sonar(config);
    sonar.ping(outwards(scene));
    EXPECT_LE(sonar.quality().error, 0.01);
    EXPECT_FALSE(config.maxSamples());
    EXPECT_EQ(small().maxSamples(), 400'000);
}

TEST(QualityTaskTest, IsChosenAgainWhenTheEchoesHaveChangedAndLoweredLater) {
    const auto scene = floorAndWall();
    Fed<SonarTask> sonar(small());
    sonar.ping(toTheWall(scene));
    EXPECT_EQ(sonar.quality(), Quality());
    for (int i = 0; i < 4; ++i) sonar.ping(outwards(scene));
    const Quality outside = sonar.quality();
    EXPECT_GT(outside.samples(), 4 * Quality().samples()) << "within four pings";
    EXPECT_LE(outside.error, 0.05);
    EXPECT_THAT(sonar.notices(), Contains(AllOf(HasSubstr("from 0."), HasSubstr(" s on quality: "))));
    for (int i = 0; i < 60; ++i) sonar.ping(toTheWall(scene));
    EXPECT_EQ(sonar.quality(), outside) << "not yet";
    for (int i = 0; i < 90; ++i) sonar.ping(toTheWall(scene));
    EXPECT_EQ(sonar.quality(), Quality()) << "once all of 64 pings and the checks after them were of the wall";
}

/** Returns the bins of a ping of this quality. */
std::vector<float> binsAt(const types::Snapshot& snapshot, const Quality& quality) {
    SonarConfig config = small();
    config.quality.rows = quality.rows;
    config.quality.columns_per_beam = quality.columns_per_beam;
    types::Sonar ping;
    SonarRenderer(config, snapshot.geometry).render(snapshot, ping);
    return ping.bins;
}

/** Renders pings while a sonar turns, and expects each to be of the quality that the plan states then. Ends once it has
 *  seen `enough` qualities. */
void expectThePlansQuality(const SonarConfig& config, size_t enough) {
    const auto scene = floorAndWall();
    Fed<SonarTask> sonar(config);
    std::set<double> samples;
    for (int i = 0; i < 40 && samples.size() < enough; ++i) {
        const types::Snapshot snapshot = test::makeSnapshot(scene, {}, 3.14 - 0.1 * i, 0.14);
        const types::SonarPtr ping = sonar.ping(snapshot);
        ASSERT_TRUE(ping);
        EXPECT_EQ(ping->bins, binsAt(snapshot, sonar.quality())) << i << ": the plan is of another ping";
        samples.insert(sonar.quality().samples());
    }
    EXPECT_GT(samples.size(), 1u) << "or nothing was compared";
}

TEST(QualityTaskTest, ThePlanStatesTheQualityOfThePingThatIsWritten) { expectThePlansQuality(small(), 40); }

TEST(QualityTaskTest, ThePlanStatesTheQualityOfThePingThatIsWrittenWithABudget) {
    SonarConfig config = small();
    config.quality.budget_ms = 2000;  // longer than a ping of few samples takes under any load, so the samples rise
    expectThePlansQuality(config, 3);
}

TEST(QualityTaskTest, AStillSceneKeepsItsBitsAndItsPrediction) {
    const auto scene = floorAndWall();
    for (const double yaw : {0.0, 0.7, 1.4, 3.14}) {
        Fed<SonarTask> sonar(small());
        const types::SonarPtr first = sonar.ping(test::makeSnapshot(scene, {}, yaw, 0.14));
        const double error = sonar.quality().error;
        for (int i = 0; i < 150; ++i) {
            EXPECT_EQ(sonar.ping(test::makeSnapshot(scene, {}, yaw, 0.14))->bins, first->bins) << yaw << ", " << i;
            EXPECT_EQ(sonar.quality().error, error) << yaw << ", " << i;
        }
        EXPECT_EQ(sonar.notices().size(), 1u) << yaw;
    }
}

/** What this thread has rendered: samples of pings, and of pings that they are compared with. */
double renderedSamples() {
    return static_cast<double>(thread_counts[static_cast<size_t>(Counter::Rays)] +
                               thread_counts[static_cast<size_t>(Counter::Pixels)]);
}

/** Returns the error of a ping, by one of a sonar with many samples, as the quality predicts it. */
double trueError(const types::Sonar& ping, SonarConfig config, const types::Snapshot& snapshot) {
    config.quality = {};
    config.quality.rows = 1500;
    config.quality.columns_per_beam = 96;
    types::Sonar fine;
    SonarRenderer(config, snapshot.geometry).render(snapshot, fine);
    const std::vector<double> reference(fine.bins.begin(), fine.bins.end());
    return compare(ping.bins, reference, {config.beam_count, config.bin_count, ping.binWidth(), 0}).rel_l2_tvg;
}

/** A ping may cost half more than the one before, and a comparison with a coarser one, 0.3 of it. */
TEST(QualityTaskTest, ChangedSettingsKeepTheQualityAndMoveItInSmallSteps) {
    const auto scene = floorAndWall();
    SonarConfig config = small();
    config.visibility = Visibility::Cpu;
    Fed<SonarTask> sonar(config);
    for (int i = 0; i < 5; ++i) sonar.ping(outwards(scene));
    double before = sonar.quality().samples();
    EXPECT_GT(before, 4 * Quality().samples());
    const auto ping = [&](const types::Snapshot& snapshot) {
        const double rendered = renderedSamples();
        const types::SonarPtr made = sonar.ping(snapshot);
        EXPECT_TRUE(made) << sonar.task.lastError();
        const double samples = sonar.quality().samples();
        EXPECT_LE(samples, 1.5 * before);
        EXPECT_LE(renderedSamples() - rendered, 1.35 * 16 * samples) << "it was searched for";
        before = samples;
        return made;
    };
    const char* ranges[] = {"12", "45", "20", "30"};
    for (int second = 0; second < 20; ++second) {
        sonar.task.config.set("range", ranges[second % 4]);
        if (second % 3 == 0) sonar.task.config.change({{"speed_of_sound", 1450 + second}, {"frequency_khz", 300}});
        for (int i = 0; i < 10; ++i) {
            const types::SonarPtr made = ping(outwards(scene));
            EXPECT_LE(sonar.quality().error, i > 5 ? 1.2 * 0.05 : 1) << "within five pings";
            if (i < 9) continue;
            EXPECT_LE(trueError(*made, sonar.task.sonarConfig(), outwards(scene)), 1.2 * 0.05) << second;
        }
    }
    const double outside = before;
    for (int i = 0; i < 400; ++i) ping(toTheWall(scene));
    const double inside = before;
    EXPECT_LT(inside, 0.5 * outside) << "it falls where fewer samples will do";
    for (int i = 0; i < 40; ++i) ping(outwards(scene));
    EXPECT_LE(sonar.quality().error, 1.2 * 0.05);
    EXPECT_GT(before, 2 * inside) << "and rises again";
}

TEST(ErrorModelTest, AnErrorMayBeSetAlsoWhereThereWasNone) {
    const ErrorModel model{{64, 4, 0.7}, 0.03, 0.04};
    EXPECT_NEAR(model.withError(0.1).error(64, 4), 0.1, 1e-15);
    EXPECT_NEAR(model.withError(0.1).error(128, 4), std::hypot(0.03, 0.08), 1e-15) << "in the same proportion";
    EXPECT_EQ(model.withError(0.1).at.error, 0.1);
    EXPECT_NEAR((ErrorModel{{64, 4, 0}}.withError(0.1).error(128, 8)), 0.05, 1e-15);
    EXPECT_EQ(model.withError(0).withError(0.2).error(64, 4), (ErrorModel{{64, 4, 0}}.withError(0.2).error(64, 4)));
}

TEST(QualityTaskTest, OtherChoicesOfQualityAreMadeAnew) {
    const auto scene = floorAndWall();
    Fed<SonarTask> sonar(small());
    sonar.ping(outwards(scene));
    const Quality first = sonar.quality();
    sonar.task.config.set("quality", "{target_error: 0.02}");
    sonar.ping(outwards(scene));
    EXPECT_LE(sonar.quality().error, 0.02);
    EXPECT_GT(sonar.quality().samples(), first.samples());
    sonar.task.config.set("quality", "null");
    sonar.ping(outwards(scene));
    EXPECT_EQ(sonar.quality(), first);
    sonar.task.config.set("quality", "{rows: 100, columns_per_beam: 3}");
    sonar.ping(outwards(scene));
    EXPECT_EQ(sonar.quality(), (Quality{100, 3}));
}

TEST(QualityTaskTest, ASwayingSonarDoesNotAlternateBetweenQualities) {
    const auto scene = floorAndWall();
    Fed<SonarTask> sonar(small());
    std::vector<double> samples;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 at(0.05 * std::sin(0.11 * i), 0, 0.02 * std::sin(0.3 * i));
        sonar.ping(test::makeSnapshot(scene, at, 0.02 * std::sin(0.17 * i), 0.14));
        const double now = sonar.quality().samples();
        if (samples.empty() || samples.back() != now) samples.push_back(now);
    }
    EXPECT_LE(samples.size(), 3u) << testing::PrintToString(samples);
    EXPECT_TRUE(std::ranges::is_sorted(samples)) << testing::PrintToString(samples);
}

TEST(QualityTaskTest, ARepeatedRunHasTheSamePingsBitForBit) {
    const auto scene = floorAndWall();
    const auto run = [&] {
        Fed<SonarTask> sonar(small());
        std::vector<std::vector<float>> pings;
        for (int i = 0; i < 24; ++i)
            pings.push_back(sonar.ping(test::makeSnapshot(scene, {}, 3.14 - 0.13 * i, 0.14))->bins);
        return std::pair(pings, sonar.notices());
    };
    EXPECT_EQ(run(), run());
}

TEST(QualityTaskTest, AHeadLowersTheQualityOnlyAfterAWholeTurn) {
    const auto scene = floorAndWall();
    ScanningSonarConfig config;
    config.sonar = small();
    config.sonar.beam_width_deg = 3;
    config.sonar.field_of_view_deg = SonarConfig().field_of_view_deg;
    config.head.step_deg = 3;  // 120 pings a turn
    Fed<ScanningSonarTask> sonar(config);
    std::vector<Quality> qualities;
    for (int i = 0; i < 240; ++i) {
        sonar.ping(test::makeSnapshot(scene, {}, 0, 0.14));
        qualities.push_back(sonar.quality());
    }
    EXPECT_GT(qualities[119].samples(), Quality().samples()) << "the floor echoed";
    for (size_t i = 1; i < qualities.size(); ++i)
        EXPECT_GE(qualities[i].samples(), qualities[i - 1].samples()) << "the floor echoes again at every turn: " << i;
}

TEST(QualityTaskTest, ASlowMachineLeadsToTheCoarsestQualityAndANotice) {
    const auto scene = test::makeScene({test::ground(-3)}, -10);
    SonarConfig config = small();
    config.quality.budget_ms = 0.1;  // less than the first context switch
    config.bin_count = 20000;
    Fed<SonarTask> sonar(config);
    for (int i = 0; i < 4; ++i) sonar.ping(test::makeSnapshot(scene));
    EXPECT_EQ(sonar.quality(), Quality());
    EXPECT_THAT(sonar.notices(), Contains(HasSubstr("Warning: the coarsest quality takes")));
}

/** A keeper with the times of a machine with a given time per sample [ms]. */
struct Kept {
    explicit Kept(const SonarConfig& with) : config(with), renderer(config, scene), keeper(config, 1) {
        renderer.setQuality(64, 2);
    }
    void pings(int count, double ms_per_sample, double period_ms = 0) {
        for (int i = 0; i < count; ++i) {
            renderer.render(outwards(scene), ping);
            const SonarConfig& at = renderer.renderPlan().config;
            ms = 16.0 * at.rows() * at.columnsPerBeam() * ms_per_sample;
            keeper.follow(renderer, outwards(scene), ping, ms, period_ms);
        }
    }

    types::GeometryPtr scene = floorAndWall();
    SonarConfig config;
    SonarRenderer renderer;
    QualityKeeper keeper;
    types::Sonar ping;
    double ms = 0;  ///< Time of the last ping.
};

TEST(QualityKeeperTest, UsesABudgetAndDoesNotExceedIt) {
    SonarConfig config = small();
    config.quality.budget_ms = 20;
    Kept kept(config);
    kept.pings(80, 4e-4);
    EXPECT_GE(kept.ms, 16);
    EXPECT_LE(kept.ms, 20);
    kept.pings(8, 12e-4);
    EXPECT_LE(kept.ms, 20);
    kept.pings(60, 4e-4);
    EXPECT_GE(kept.ms, 16);
    EXPECT_THAT(kept.keeper.consumeNotices(), Contains(HasSubstr("budget 20 ms")));
}

TEST(QualityKeeperTest, ThePeriodIsTheBudgetByDefault) {
    Kept kept(small());
    kept.pings(10, 1e-4, 1000);
    const double enough = kept.keeper.quality().samples();
    EXPECT_LE(kept.keeper.quality().error, 0.05);
    kept.pings(60, 1e-4, 0.6 * kept.ms);
    EXPECT_LT(kept.keeper.quality().samples(), 0.6 * enough);
    EXPECT_GT(kept.keeper.quality().error, 0.05);
    EXPECT_THAT(kept.keeper.consumeNotices(), Contains(AllOf(HasSubstr("Warning"), HasSubstr("ms allows no more"))));
    kept.pings(60, 1e-4, 1000);
    EXPECT_GE(kept.keeper.quality().samples(), 0.9 * enough);
}

TEST(QualityKeeperTest, ThePeriodIsNoBudgetIfATargetIsGiven) {
    SonarConfig config = small();
    config.quality.target_error = 0.05;
    Kept kept(config);
    kept.pings(30, 1, 1);
    EXPECT_LE(kept.keeper.quality().error, 0.05);
}

TEST(CulledTest, ThePlanStatesTheCulledPartOfTheScene) {
    SonarConfig config = small();
    config.field_of_view_deg = 180;  // three frusta
    Fed<SonarTask> sonar(config);
    const types::Mesh ball = test::sphere(0.5, 8);
    const auto geometry = test::makeScene({ball, ball, ball}, -10, {{10, 0, 0}, {-10, 0, 0}, {200, 0, 0}});
    sonar.ping(test::makeSnapshot(geometry));
    ASSERT_TRUE(sonar.task.plan()) << sonar.task.lastError();
    std::vector<std::string> names;
    for (const types::Omission& omission : sonar.task.plan()->omitted) names.push_back(omission.name);
    EXPECT_THAT(names, testing::IsSupersetOf({"2 of 3 objects", "2 of 3 slabs"}));
    const size_t each = ball.indices.size() / 3;
    EXPECT_THAT(names, testing::Contains("at least " + std::to_string(2 * each) + " of " + std::to_string(3 * each) +
                                         " triangles"));
}

}  // namespace
}  // namespace insonify::sonar
