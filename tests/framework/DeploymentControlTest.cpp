// A deployment's control interface during a run: this test is a program with threads.
#include <gtest/gtest.h>

#include <thread>

#include "components/framework/Offers.hpp"
#include "components/framework/Operation.hpp"
#include "components/framework/Properties.hpp"
#include "tests/framework/Tasks.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::framework {
namespace {

const char* pair = R"(
tasks:
  source: {type: test::Source, activity: {period: 0.001}}
  relay: {type: test::Relay, activity: {trigger: [in]}}
connections:
  - {from: source.value, to: relay.in, policy: {type: buffer, size: 4}}
)";

TEST(DeploymentControlTest, ReportsTasksPortsAndConnections) {
    Registry registry = test::testRegistry();
    Deployment deployment(DeploymentSpec::parse(pair, "a.yml"), registry);
    deployment.configure();
    const std::atomic<bool> never{false};
    ASSERT_FALSE(deployment.run({}, never).failed());
    types::DeploymentControl* const control = deployment.task("relay")->environment().deployment;
    ASSERT_EQ(control, &deployment);
    const types::DeploymentStatus status = control->status();
    EXPECT_TRUE(status.lockstep);
    ASSERT_EQ(status.tasks.size(), 2u);
    EXPECT_EQ(status.tasks[0].record.name, "source");
    EXPECT_EQ(status.tasks[0].record.type, "test::Source");
    EXPECT_EQ(status.tasks[0].state, "Stopped");
    EXPECT_GT(status.tasks[0].cycle_s, 0);
    const auto value = std::ranges::find(status.tasks[0].outputs, "value", &types::PortStatus::name);
    ASSERT_NE(value, status.tasks[0].outputs.end());
    EXPECT_GT(value->written, 0u);
    ASSERT_EQ(status.connections.size(), 1u);
    EXPECT_EQ(status.connections[0].to, "relay.in");
    EXPECT_EQ(status.connections[0].policy, "buffer");
    EXPECT_EQ(status.connections[0].lost, 0u);
    const auto interfaces = control->interfaces();
    EXPECT_EQ(interfaces[0].name, "source");
    EXPECT_NE(std::ranges::find(interfaces[0].operations, "stop void()"), interfaces[0].operations.end());
}

struct DialConfig {
    double a = 1, b = 2;
    static void describe(auto& self, auto& visit) {
        visit({"a", "m", "any"}, self.a);
        visit({"b", "m", "any"}, self.b);
    }
};

/** Takes `a` while it runs. */
struct Dial final : TaskContext, Adjustable {
    using TaskContext::TaskContext;
    Properties<DialConfig> config{this};
    bool adjusts(const std::string& property) const override { return property == "a"; }
};

TEST(DeploymentControlTest, NamesThePropertiesThatNoRunningTaskTakes) {
    Registry registry = test::testRegistry();
    registry.add<Dial>("test::Dial", "");
    Deployment deployment(DeploymentSpec::parse(R"(
tasks:
  source: {type: test::Source, activity: {period: 0.001}}
  dial: {type: test::Dial, activity: {period: 1}}
connections: []
)",
                                                "a.yml"),
                          registry);
    const auto interfaces = deployment.interfaces();
    EXPECT_EQ(interfaces[1].fixed, std::vector<std::string>{"b"});
    std::vector<std::string> all;
    for (const types::PropertyInfo& property : interfaces[0].properties) all.push_back(property.name);
    EXPECT_EQ(interfaces[0].fixed, all) << "a task that offers nothing takes nothing";
    EXPECT_FALSE(all.empty());
}

TEST(DeploymentControlTest, AcceptsWarningsFromOtherThreadsWhileRunsBeginAndEnd) {
    Registry registry = test::testRegistry();
    Deployment deployment(DeploymentSpec::parse(pair, "a.yml"), registry);
    deployment.configure();
    std::atomic<bool> stop{false};
    std::thread other([&] {
        while (!stop) deployment.environment().warn("from elsewhere");
    });
    for (int i = 0; i < 20; ++i) {
        const RunResult result = deployment.run({.duration_s = 0.01}, stop);
        EXPECT_FALSE(result.failed());
        for (const std::string& warning : result.warnings) EXPECT_EQ(warning, "from elsewhere");
    }
    stop = true;
    other.join();
}

TEST(DeploymentControlTest, CannotPauseInRealtime) {
    Registry registry = test::testRegistry();
    Deployment deployment(DeploymentSpec::parse(std::string("schedule: realtime\n") + pair, "a.yml"), registry);
    EXPECT_THROW(deployment.pause(true), std::runtime_error);
    EXPECT_THROW(deployment.step(), std::runtime_error);
}

TEST(DeploymentControlTest, TimeIsPausedWhenPauseReturns) {
    Registry registry = test::testRegistry();
    Deployment deployment(DeploymentSpec::parse(pair, "a.yml"), registry);
    deployment.configure();
    std::atomic<bool> stop{false};
    std::thread running([&] { deployment.run({.duration_s = 100, .pace = 0.05}, stop); });  // an instant in 20 ms
    const auto now = [&] { return deployment.status().now.microseconds; };
    for (int i = 0; i < 5; ++i) {
        const int64_t before = now();
        ASSERT_TRUE(test::becomesTrue([&] { return now() > before; }));
        deployment.pause(true);
        const int64_t paused = now();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        EXPECT_EQ(now(), paused) << "nor is the pending instant made";
        deployment.pause(false);
    }
    stop = true;
    running.join();
}

TEST(DeploymentControlTest, APausedRunCanBeSteppedAndStopped) {
    Registry registry = test::testRegistry();
    Deployment deployment(DeploymentSpec::parse(pair, "a.yml"), registry);
    deployment.configure();
    deployment.pause(true);
    std::atomic<bool> stop{false};
    std::atomic<int> instants{0};
    std::thread running([&] { deployment.run({.duration_s = 100}, stop, [&](const Progress&) { ++instants; }); });
    const auto become = [&](int expected) {
        test::becomesTrue([&] { return instants == expected; });
        std::this_thread::sleep_for(std::chrono::milliseconds(20));  // a further instant would run now
        return instants == expected;
    };
    EXPECT_TRUE(become(0));
    deployment.step();
    EXPECT_TRUE(become(1));
    deployment.step();
    deployment.step();
    EXPECT_TRUE(become(3));
    EXPECT_GE(deployment.status().tasks.size(), 2u) << "available during the run";
    stop = true;
    running.join();
}

/** Has an operation that takes a millisecond. */
struct Napping : TaskContext {
    using TaskContext::TaskContext;
    Operation<void()> nap{this, "nap", "sleeps", [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }};
};

TEST(DeploymentControlTest, TimeContinuesWhileOthersCallWithoutAPause) {
    Registry registry = test::testRegistry();
    registry.add<Napping>("test::Napping", "naps");
    Deployment deployment(
        DeploymentSpec::parse("tasks:\n  source: {type: test::Source, activity: {period: 0.001}}\n  cat: {type: "
                              "test::Napping, activity: {period: 1000}}\n",
                              "a.yml"),
        registry);
    deployment.configure();
    std::atomic<bool> ended{false};
    std::atomic<int> calls{0}, until_the_end{0};
    std::vector<std::thread> callers;
    for (int i = 0; i < 3; ++i)
        callers.emplace_back([&] {
            const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(30);
            while (!ended && std::chrono::steady_clock::now() < patience) {
                deployment.call("cat.nap", {});
                ++calls;
            }
            until_the_end += ended ? 1 : 0;
        });
    ASSERT_TRUE(test::becomesTrue([&] { return calls > 10; }));
    const std::atomic<bool> never{false};
    const int before = calls;
    EXPECT_EQ(deployment.run({.duration_s = 0.1}, never).failures, std::vector<std::string>{});
    const int meanwhile = calls - before;
    ended = true;
    for (std::thread& caller : callers) caller.join();
    EXPECT_EQ(until_the_end, 3) << "the run of 100 instants has waited until the callers ended";
    EXPECT_GT(meanwhile, 10) << "callers are served as well";
    EXPECT_EQ(deployment.task("source")->output("value")->written(), 100u);
}

}  // namespace
}  // namespace insonify::framework
