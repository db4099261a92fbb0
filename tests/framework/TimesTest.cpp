// A task's statistics of its times in realtime. Bounds hold on a busy machine; counts are exact by construction.
#include <gtest/gtest.h>

#include <thread>

#include "components/framework/execution/Activity.hpp"
#include "tests/framework/Tasks.hpp"
#include "tests/support/Waiting.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::framework {
namespace {

using std::chrono::milliseconds;

/** A cycle takes longer than two periods of 10 ms. */
struct Slow : TaskContext {
    using TaskContext::TaskContext;
    std::atomic<int> cycles_begun{0};
    void updateHook() override {
        ++cycles_begun;
        std::this_thread::sleep_for(milliseconds(25));
    }
};

/** Writes poses that are 5 ms old. */
struct OldPoses : TaskContext {
    using TaskContext::TaskContext;
    OutputPort<types::Pose> pose{this, "pose", "5 ms old"};
    void updateHook() override {
        types::Pose sample;
        sample.time = now() - types::Time{5000};
        pose.write(sample);
    }
};

/** Sleeps in its cycles: 30 ms in each of the first ten, then an hour. */
struct Sleeper : TaskContext {
    using TaskContext::TaskContext;
    std::vector<bool> slept;
    std::atomic<int> cycles_begun{0};
    void updateHook() override {
        const types::Time until = now() + types::Time{cycles_begun++ < 10 ? 30'000 : 3'600'000'000};
        slept.push_back(activity().sleepUntil(until) && now() >= until);
    }
};

/** Triggered, but without a trigger. */
struct Waiting : TaskContext {
    using TaskContext::TaskContext;
    InputPort<double> in{this, "in", "nothing comes"};
    std::atomic<int> woken{0};
    double wakeAfter() const override { return 0.005; }
    void updateHook() override { ++woken; }
};

Registry registry() {
    Registry registry = test::testRegistry();
    registry.add<Slow>("test::Slow", "takes 25 ms");
    registry.add<OldPoses>("test::OldPoses", "poses");
    registry.add<Sleeper>("test::Sleeper", "sleeps");
    registry.add<Waiting>("test::Waiting", "waits");
    return registry;
}

/** Configures a deployment and runs it until `enough`. */
struct Realtime {
    Registry types = registry();
    Deployment deployment;
    RunResult result;

    Realtime(const std::string& tasks, const std::function<bool(Deployment&, double wall_s)>& enough)
        : deployment(DeploymentSpec::parse("schedule: realtime\n" + tasks, "a.yml"), types) {
        deployment.configure();
        std::atomic<bool> stop{false};
        result = deployment.run({}, stop, [&](const Progress& now) { stop = enough(deployment, now.wall_s); });
        EXPECT_EQ(result.failures, std::vector<std::string>{});
    }
    TaskContext& operator[](const char* task) { return *deployment.task(task); }
};

TEST(TimesTest, SkippedPeriodsAreCountedAndTheNextCycleStaysOnTheGrid) {
    Realtime run("tasks: {slow: {type: test::Slow, activity: {period: 0.01}}}\n",
                 [](Deployment& made, double) { return dynamic_cast<Slow&>(*made.task("slow")).cycles_begun >= 10; });
    const Timing& timing = run["slow"].timing();
    const uint64_t cycles = run["slow"].cycles().count();
    ASSERT_GE(cycles, 10u);
    EXPECT_EQ(timing.jitter.count(), cycles);
    // A cycle of 25 ms skips at least one period of 10 ms, and the next cycle is at least 5 ms late.
    EXPECT_GE(timing.overruns, cycles - 1);
    EXPECT_GE(timing.jitter.max(), 0.005);
    // No instant is both run and skipped: their total number times the period is the elapsed time.
    EXPECT_LE(static_cast<double>(cycles + timing.overruns - 1) * 0.01, run.result.wall_s);
    EXPECT_GE(static_cast<double>(cycles + timing.overruns) * 0.01, 0.025 * static_cast<double>(cycles - 1));
}

TEST(TimesTest, LatencyIsFromTheStampToTheWriteAndLateIsBeyondTheDeadline) {
    Realtime run(
        "tasks:\n"
        "  strict: {type: test::OldPoses, activity: {period: 0.002, deadline: 0.001}}\n"
        "  lax: {type: test::OldPoses, activity: {period: 0.002, deadline: 1000}}\n",
        [](Deployment& made, double) { return made.task("lax")->output("pose")->written() > 10; });
    for (const char* task : {"strict", "lax"}) {
        const Timing& timing = run[task].timing();
        EXPECT_EQ(timing.latency.count(), run[task].output("pose")->written());
        EXPECT_GE(timing.latency.quantile(0), 0.00495);  // within 1 %
    }
    EXPECT_EQ(run["strict"].timing().late, run["strict"].output("pose")->written());
    EXPECT_EQ(run["lax"].timing().late, 0u);
}

TEST(TimesTest, ASleepIsNotWorkAndEndsWhenTheTaskIsHeld) {
    Realtime run("tasks: {sleeper: {type: test::Sleeper, activity: {period: 0.001}}}\n", [](Deployment& made, double) {
        return dynamic_cast<Sleeper&>(*made.task("sleeper")).cycles_begun == 11;
    });
    auto& sleeper = dynamic_cast<Sleeper&>(run["sleeper"]);
    std::vector<bool> expected(11, true);
    expected.back() = false;
    EXPECT_EQ(sleeper.slept, expected);
    EXPECT_LT(run.result.wall_s, 3600);
    EXPECT_LT(sleeper.cycles().quantile(0), 0.03)
        << "the machine may stall in some cycles, not in each in addition to its sleep";
}

TEST(TimesTest, ATriggeredTaskMayRequestCyclesWithoutASample) {
    Realtime run(
        "tasks:\n"
        "  waiting: {type: test::Waiting}\n"
        "  source: {type: test::Source, activity: {period: 1000}}\n"
        "connections: [{from: source.value, to: waiting.in}]\n",
        [](Deployment& made, double) { return dynamic_cast<Waiting&>(*made.task("waiting")).woken > 5; });
    EXPECT_GT(dynamic_cast<Waiting&>(run["waiting"]).woken, 5);
}

TEST(TimesTest, AnEventFromOutsideRunsACycle) {
    test::Doorbell task("bell");
    ASSERT_TRUE(task.configure() && task.start());
    task.activity().release();
    for (int rings = 1; rings <= 3; ++rings) {
        std::thread([&] { task.rung.raise(); }).join();
        EXPECT_TRUE(test::becomesTrue([&] { return task.answered == rings; }));
    }
    task.activity().hold();
    task.stop();
}

/** Reads samples as readNext; its first cycle ends once 20 samples wait. */
struct Latest : TaskContext {
    using TaskContext::TaskContext;
    InputPort<double> in{this, "in", "of the source"};
    std::atomic<bool> continues{false};
    std::vector<double> taken;
    void updateHook() override {
        double sample = 0;
        if (!in.readNext(sample)) return;
        taken.push_back(sample);
        while (!continues) std::this_thread::sleep_for(milliseconds(1));
    }
};

TEST(TimesTest, CountsSamplesSkippedForNewerSamples) {
    const char* yaml = R"(schedule: realtime
tasks:
  source: {type: test::Source, activity: {period: 0.001}}
  latest: {type: test::Latest}
connections: [{from: source.value, to: latest.in, policy: {type: buffer, size: 1000000}}]
)";
    Registry types = registry();
    types.add<Latest>("test::Latest", "takes the newest");
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), types);
    deployment.configure();
    auto& latest = dynamic_cast<Latest&>(*deployment.task("latest"));
    const OutputPortBase& value = *deployment.task("source")->output("value");
    std::atomic<bool> stop{false};
    deployment.run({}, stop, [&](const Progress&) {
        latest.continues = latest.continues || value.written() >= 20;
        stop = value.written() >= 40;
    });
    const uint64_t passed_over = deployment.passedOver().at("source.value>latest.in");
    EXPECT_GE(passed_over, 18u) << "all but the first and the newest of the first twenty";
    EXPECT_EQ(latest.taken.size() + passed_over, value.written());
    EXPECT_EQ(latest.taken.back(), static_cast<double>(value.written())) << "the newest is never skipped";
    EXPECT_EQ(deployment.losses().at("source.value>latest.in"), 0u);
    EXPECT_EQ(deployment.status().connections.front().passed_over, passed_over);
}

/** Its first cycle ends only when the test is over. */
struct Dawdler : TaskContext {
    using TaskContext::TaskContext;
    InputPort<double> in{this, "in", "of the source"};
    static inline std::atomic<bool> over{false};
    uint64_t taken = 0;
    void updateHook() override {
        double sample = 0;
        if (!in.readNew(sample)) return;
        ++taken;
        while (!over) std::this_thread::sleep_for(milliseconds(1));
    }
};

TEST(TimesTest, AHangingReaderDelaysNoOtherTask) {
    const char* yaml = R"(schedule: realtime
tasks:
  source: {type: test::Source, activity: {period: 0.002}}
  relay: {type: test::Relay}
  newest: {type: test::Dawdler}
  buffered: {type: test::Dawdler}
  rolling: {type: test::Dawdler}
connections:
  - {from: source.value, to: relay.in, policy: {type: buffer, size: 10000}}
  - {from: source.value, to: newest.in}
  - {from: source.value, to: buffered.in, policy: {type: buffer, size: 2}}
  - {from: relay.out, to: rolling.in, policy: {type: circular_buffer, size: 2}}
)";
    Registry types = registry();
    types.add<Dawdler>("test::Dawdler", "hangs");
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), types);
    deployment.configure();
    Dawdler::over = false;
    TaskContext& source = *deployment.task("source");
    constexpr double patience_s = std::chrono::duration<double>(test::patience).count();
    std::atomic<bool> stop{false};
    const RunResult result = deployment.run({}, stop, [&](const Progress& now) {
        stop = Dawdler::over = source.output("value")->written() >= 100 || now.wall_s > patience_s;
    });
    EXPECT_FALSE(result.failed());
    // If a reader had delayed its writer, there would have been few cycles.
    EXPECT_GE(source.cycles().count(), 100u);
    EXPECT_EQ(deployment.task("relay")->cycles().count(), source.cycles().count());
    const auto losses = deployment.losses();
    for (const char* task : {"newest", "buffered"}) {
        const auto& dawdler = dynamic_cast<Dawdler&>(*deployment.task(task));
        const uint64_t lost = losses.at("source.value>" + dawdler.name() + ".in");
        EXPECT_GT(lost, 5u) << task;
        EXPECT_EQ(dawdler.taken + lost, source.output("value")->written()) << task;
    }
    EXPECT_EQ(losses.at("source.value>relay.in"), 0u);
}

}  // namespace
}  // namespace insonify::framework
