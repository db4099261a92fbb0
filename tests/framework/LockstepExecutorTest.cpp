// The order of tasks in simulated time, in graphs made by hand; DeploymentRunTest tests whole deployments.
#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "components/framework/execution/LockstepExecutor.hpp"
#include "tests/framework/Tasks.hpp"

namespace insonify::framework {
namespace {

using testing::ElementsAre;

const std::atomic<bool> not_stopped{false};

/** Plays at given times, like a log. */
struct Player : TaskContext, ClockSource {
    using TaskContext::TaskContext;
    OutputPort<double> value{this, "value", "its place in the list"};
    std::vector<int64_t> times_us{5, 7, 11};
    size_t next = 0;
    std::vector<int64_t> played_us;
    std::optional<types::Time> nextTime() const override {
        return next < times_us.size() ? std::optional(types::Time{times_us[next]}) : std::nullopt;
    }
    bool finished() const override { return next == times_us.size(); }
    void updateHook() override {
        played_us.push_back(now().microseconds);
        value.write(static_cast<double>(next++));
    }
};

struct Shell {
    static constexpr const char* type_name = "/test/Shot";
    static constexpr bool counted = true;
};

/** Writes counted samples; may be in error from its third cycle on. */
struct Mortar : TaskContext {
    using TaskContext::TaskContext;
    OutputPort<Shell> shot{this, "shot", "counted"};
    bool fails = false;
    void updateHook() override {
        if (fails && shot.written() == 2) return error("jammed");
        shot.write({});
    }
};

/** A graph, and an executor for it that starts at 1 s. */
struct Range {
    Graph graph;
    std::shared_ptr<Environment> environment = std::make_shared<Environment>();
    std::optional<LockstepExecutor> executor;

    ~Range() {
        for (TaskContext* task : graph.order()) task->stop(), task->cleanup();
    }
    template <class Task>
    Task& add(const std::string& name, double period = 0) {
        auto& task = dynamic_cast<Task&>(graph.add(std::make_unique<Task>(name)));
        task.setEnvironment(environment);
        ActivitySettings settings;
        settings.period = period;
        task.activity().configure(settings);
        return task;
    }
    void start() {
        graph.arrange();
        executor.emplace(graph, *environment, types::Time{1'000'000});
        for (const auto& task : graph.tasks()) ASSERT_TRUE(task->configure() && task->start());
        executor->begin();
    }
    Progress run(const RunLimits& limits, const std::atomic<bool>& stop = not_stopped,
                 const Executor::Report& report = {}) {
        executor->run(limits, stop, report);
        return executor->progress();
    }
};

TEST(LockstepExecutorTest, TimeAdvancesByInstantsAndWritersRunFirst) {
    Range bench;
    auto& relay = bench.add<test::Relay>("relay");
    auto& source = bench.add<test::Source>("source", 0.25);
    bench.graph.connect(source.value, relay.in, {});
    bench.start();
    EXPECT_EQ(bench.environment->now().microseconds, 1'000'000);
    const Progress end = bench.run({.duration_s = 0.6});
    EXPECT_THAT(relay.notes, ElementsAre("relay:1@1000000", "relay:2@1250000", "relay:3@1500000"));
    EXPECT_DOUBLE_EQ(end.elapsed_s, 0.5);
    EXPECT_EQ(bench.environment->start_time().microseconds, 1'000'000);
}

TEST(LockstepExecutorTest, AClockSourceSetsItsCyclesAndTheEndOfTheRun) {
    Range bench;
    auto& player = bench.add<Player>("player");
    auto& relay = bench.add<test::Relay>("relay");
    bench.graph.connect(player.value, relay.in, {});
    bench.start();
    bench.run({});
    EXPECT_THAT(player.played_us, ElementsAre(5, 7, 11));
    EXPECT_THAT(relay.notes, ElementsAre("relay:0@5", "relay:1@7", "relay:2@11"));
}

TEST(LockstepExecutorTest, WithALimitItContinuesWhileAFinishedSourceStillWrites) {
    Range bench;
    auto& source = bench.add<test::Source>("source", 0.1);  // has finished after 3, and continues to write
    bench.start();
    bench.run({.duration_s = 1});
    EXPECT_EQ(source.value.written(), 10u);
}

TEST(LockstepExecutorTest, EndsAtTheNumberOfCountedSamplesOfEverySource) {
    Range bench;
    auto &fast = bench.add<Mortar>("fast", 0.1), &slow = bench.add<Mortar>("slow", 0.2);
    bench.start();
    EXPECT_EQ(bench.run({.samples = 4}).samples, 4u);
    EXPECT_EQ(slow.shot.written(), 4u);
    EXPECT_EQ(fast.shot.written(), 7u);
}

TEST(LockstepExecutorTest, EndsWhenTheCountCannotBeReached) {
    Range bench;
    bench.add<Mortar>("gun", 0.1).fails = true;
    bench.start();
    EXPECT_EQ(bench.run({.samples = 4}).samples, 2u);
}

/** Writes a shot for each even number, and is in error at odd numbers. */
struct Picky : TaskContext {
    using TaskContext::TaskContext;
    InputPort<double> in{this, "in", "numbers"};
    OutputPort<Shell> shot{this, "shot", "counted"};
    void updateHook() override {
        double number = 0;
        if (!in.readNew(number)) return;
        if (std::fmod(number, 2) != 0) return error("odd");
        if (state() == TaskState::RunTimeError) recover();
        shot.write({});
    }
    void errorHook() override { updateHook(); }
};

TEST(LockstepExecutorTest, ARefusedSampleDoesNotEndARunThatCounts) {
    Range bench;
    auto& source = bench.add<test::Source>("source", 0.1);
    source.config.set({.last = 100});
    auto& picky = bench.add<Picky>("picky");
    bench.graph.connect(source.value, picky.in, {});
    bench.start();
    EXPECT_EQ(bench.run({.samples = 5}).samples, 5u);
    EXPECT_EQ(source.value.written(), 10u);
}

/** Writes 1 forever; has finished from the beginning. */
struct Held : TaskContext {
    using TaskContext::TaskContext;
    OutputPort<double> value{this, "value", "1"};
    void updateHook() override { value.write(1); }
    bool finished() const override { return true; }
};

TEST(LockstepExecutorTest, EndsWhenSourcesOnlyHoldRefusedSamples) {
    Range bench;
    auto& held = bench.add<Held>("held", 0.1);
    auto& picky = bench.add<Picky>("picky");
    bench.graph.connect(held.value, picky.in, {});
    bench.start();
    EXPECT_EQ(bench.run({.samples = 5}).samples, 0u);
    EXPECT_EQ(held.value.written(), 1u);
}

/** Is always in error, as a scene whose survey is damaged. */
struct Broken : TaskContext {
    using TaskContext::TaskContext;
    InputPort<double> in{this, "in", "numbers"};
    OutputPort<double> out{this, "out", "nothing"};
    void updateHook() override {
        double number = 0;
        if (in.readNew(number)) error("broken");
    }
    void errorHook() override { updateHook(); }
};

TEST(LockstepExecutorTest, EndsWhenATaskBeforeTheCountedSamplesStaysInError) {
    Range bench;
    auto& held = bench.add<Held>("held", 0.1);
    auto& broken = bench.add<Broken>("broken");
    auto& picky = bench.add<Picky>("picky");
    bench.graph.connect(held.value, broken.in, {});
    bench.graph.connect(broken.out, picky.in, {});
    bench.start();
    EXPECT_EQ(bench.run({.samples = 5}).samples, 0u);
}

TEST(LockstepExecutorTest, ChecksTheStopFlagAndReportsAfterEachInstant) {
    Range bench;
    bench.add<test::Source>("source", 0.1);
    bench.start();
    std::atomic<bool> stop{false};
    std::vector<double> elapsed;
    bench.run({.duration_s = 100}, stop, [&](const Progress& progress) {
        elapsed.push_back(progress.elapsed_s);
        stop = elapsed.size() == 2;
    });
    ASSERT_EQ(elapsed.size(), 2u);
    EXPECT_DOUBLE_EQ(elapsed[1], 0.1);
}

TEST(LockstepExecutorTest, NoInstantBeginsWhileBetweenInstantsIsHeld) {
    Range bench;
    auto& source = bench.add<test::Source>("source", 0.1);
    bench.start();
    std::thread running;
    {
        const auto held = bench.executor->betweenInstants();
        running = std::thread([&] { bench.run({}); });
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        EXPECT_EQ(source.value.written(), 0u);
    }
    running.join();
    EXPECT_EQ(source.value.written(), 3u);
}

TEST(LockstepExecutorTest, PausedTimeAdvancesByStep) {
    Range bench;
    auto& source = bench.add<test::Source>("source", 0.1);
    bench.start();
    EXPECT_THROW(bench.executor->step(), std::runtime_error);
    bench.executor->pause(true);
    EXPECT_TRUE(bench.executor->paused());
    bench.executor->step();
    bench.executor->step();
    std::atomic<bool> stop{false};
    int instants = 0;
    bench.run({.duration_s = 100}, stop, [&](const Progress&) { stop = ++instants == 2; });
    EXPECT_EQ(source.value.written(), 2u);
    bench.executor->pause(false);
    bench.run({});
    EXPECT_EQ(source.value.written(), 3u) << "time restarted, but the source had finished with its third";
}

}  // namespace
}  // namespace insonify::framework
