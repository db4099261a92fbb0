#include <gtest/gtest.h>

#include <thread>

#include "components/framework/Offers.hpp"
#include "components/framework/execution/RealtimeExecutor.hpp"
#include "tests/framework/Tasks.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::framework {
namespace {

constexpr double patience_s = std::chrono::duration<double>(test::patience).count();

TEST(RealtimeExecutorTest, APeriodicTaskFollowsTheWallClock) {
    Registry registry = test::testRegistry();
    const char* yaml = R"(
schedule: realtime
tasks:
  source: {type: test::Source, activity: {period: 0.02}}
  relay: {type: test::Relay}
connections: [{from: source.value, to: relay.in, policy: {type: buffer, size: 10000}}]
)";
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    deployment.configure();
    const OutputPortBase& value = *deployment.task("source")->output("value");
    std::atomic<bool> stop{false};
    const RunResult result = deployment.run(
        {}, stop, [&](const Progress& progress) { stop = value.written() >= 25 || progress.wall_s > patience_s; });
    EXPECT_FALSE(result.failed());
    // A loaded machine may skip periods, but never adds any; the first cycle is at once.
    const uint64_t cycles = deployment.task("source")->cycles().count();
    EXPECT_GE(cycles, 25u);
    EXPECT_LE(static_cast<double>(cycles - 1) * 0.02, result.wall_s);
    EXPECT_EQ(dynamic_cast<test::Relay&>(*deployment.task("relay")).notes.size(), cycles);
    EXPECT_EQ(deployment.task("relay")->state(), TaskState::Stopped);
}

TEST(RealtimeExecutorTest, ARunHasItsDuration) {
    Registry registry = test::testRegistry();
    const char* yaml = "schedule: realtime\ntasks: {source: {type: test::Source, activity: {period: 0.02}}}\n";
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    deployment.configure();
    const std::atomic<bool> never{false};
    const RunResult result = deployment.run({.duration_s = 0.2}, never);
    EXPECT_FALSE(result.failed());
    EXPECT_GE(result.elapsed_s, 0.2);
}

/** A source whose clock is constant at 5 s. */
struct Timekeeper : test::Source, ClockSource {
    using Source::Source;
    std::function<types::Time()> clock(std::function<types::Time()> wall) override {
        return [wall] { return wall().isNull() ? types::Time{} : types::Time::fromSeconds(5); };
    }
};

TEST(RealtimeExecutorTest, AllTasksUseTheClockOfASource) {
    const char* yaml = R"(
schedule: realtime
tasks:
  relay: {type: test::Relay}
  source: {type: test::Timekeeper, activity: {period: 0.01}}
connections: [{from: source.value, to: relay.in, policy: {type: buffer, size: 100}}]
)";
    Registry registry = test::testRegistry();
    registry.add<Timekeeper>("test::Timekeeper", "always 5 s");
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    deployment.configure();
    std::atomic<bool> stop{false};
    const OutputPortBase& relayed = *deployment.task("relay")->output("out");
    deployment.run({}, stop,
                   [&](const Progress& progress) { stop = relayed.written() >= 3 || progress.wall_s > patience_s; });
    const auto& notes = dynamic_cast<test::Relay&>(*deployment.task("relay")).notes;
    ASSERT_GE(notes.size(), 3u);
    for (const std::string& note : notes) EXPECT_TRUE(note.ends_with("@5000000")) << note;
}

TEST(RealtimeExecutorTest, TheStopFlagEndsARunInOrder) {
    Registry registry = test::testRegistry();
    const char* yaml = "schedule: realtime\ntasks: {source: {type: test::Source, activity: {period: 0.001}}}\n";
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    deployment.configure();
    std::atomic<bool> stop{false};
    const RunResult result = deployment.run({}, stop, [&](const Progress& progress) { stop = progress.wall_s > 0.05; });
    EXPECT_FALSE(result.failed());
    EXPECT_EQ(deployment.task("source")->state(), TaskState::Stopped);
}

TEST(RealtimeExecutorTest, ATaskThatThrowsEndsTheRunWithItsMessage) {
    Registry registry = test::testRegistry();
    const char* yaml = R"(
schedule: realtime
tasks:
  source: {type: test::Source, activity: {period: 0.001}}
  throwing: {type: test::Throwing}
connections: [{from: source.value, to: throwing.in}]
)";
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    deployment.configure();
    const std::atomic<bool> stop{false};
    const RunResult result = deployment.run({.duration_s = patience_s}, stop);
    EXPECT_EQ(result.failures, (std::vector<std::string>{"throwing: updateHook: the third is too much"}));
    EXPECT_LT(result.elapsed_s, patience_s);
}

/** A graph of one source, and an executor for it. */
struct Bench {
    Graph graph;
    std::shared_ptr<Environment> environment = std::make_shared<Environment>();
    test::Source* source = nullptr;

    explicit Bench(double period_s) {
        environment->warn = [](const std::string&) {};  // a machine may permit nothing
        source = &dynamic_cast<test::Source&>(graph.add(std::make_unique<test::Source>("source")));
        source->setEnvironment(environment);
        ActivitySettings settings;
        settings.period = period_s;
        source->activity().configure(settings);
        graph.arrange();
        source->configure();
    }
    ~Bench() { source->stop(), source->cleanup(); }
};

TEST(RealtimeExecutorTest, AReleasedTaskRunsByItself) {
    Bench bench(0.001);
    RealtimeExecutor executor(bench.graph, *bench.environment, {}, {});
    executor.begin();
    ASSERT_TRUE(bench.source->start());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(bench.source->value.written(), 0u);
    executor.release(*bench.source);
    std::atomic<bool> stop{false};
    executor.run({}, stop,
                 [&](const Progress& now) { stop = bench.source->value.written() >= 3 || now.wall_s > patience_s; });
    bench.source->activity().hold();
    executor.end();
    EXPECT_GE(bench.source->value.written(), 3u);
    EXPECT_GE(executor.progress().elapsed_s, 0);
}

TEST(RealtimeExecutorTest, CannotPauseOrStep) {
    Bench bench(1);
    RealtimeExecutor executor(bench.graph, *bench.environment, {}, {});
    EXPECT_FALSE(executor.paused());
    EXPECT_THROW(executor.pause(true), std::runtime_error);
    EXPECT_THROW(executor.step(), std::runtime_error);
    EXPECT_FALSE(executor.betweenInstants().owns_lock()) << "realtime cycles have no time between instants";
}

/** A source that notes the time since the start of the run. */
struct Stopwatch : test::Source {
    using Source::Source;
    std::vector<double> seconds;
    void updateHook() override { seconds.push_back(environment().elapsed().seconds()); }
};

TEST(RealtimeExecutorTest, ARunHasItsDurationHoweverTheClockIsSet) {
    for (const double step : {600.0, -600.0, 1.8e9, -1.5e9}) {
        Registry registry = test::testRegistry();
        registry.add<Stopwatch>("test::Stopwatch", "");
        const char* yaml = "schedule: realtime\ntasks: {source: {type: test::Stopwatch, activity: {period: 0.005}}}\n";
        Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
        deployment.configure();
        auto& source = dynamic_cast<Stopwatch&>(*deployment.task("source"));
        const auto begin = std::chrono::steady_clock::now();
        const auto passed = [&] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        };
        source.environment().now = [&] {
            return types::Time{wallClock() + types::Time::fromSeconds(passed() > 0.1 ? step : 0)};
        };
        const std::atomic<bool> never{false};
        const RunResult result = deployment.run({.duration_s = 0.3}, never);
        EXPECT_GE(passed(), 0.3) << step;
        EXPECT_LE(passed(), patience_s) << step;
        EXPECT_GE(result.elapsed_s, 0.3);
        EXPECT_TRUE(std::ranges::is_sorted(source.seconds));
        EXPECT_LE(source.seconds.back(), passed());
    }
}

}  // namespace
}  // namespace insonify::framework
