#include <gtest/gtest.h>

#include <condition_variable>

#include "components/framework/Activity.hpp"
#include "tests/framework/Tasks.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::framework {
namespace {

TEST(RealtimeTest, APeriodicTaskKeepsToTheWallClock) {
    Registry registry = test::testRegistry();
    const char* yaml = R"(
schedule: realtime
tasks:
  source: {type: test::Source, activity: {period: 0.02}}
  relay: {type: test::Relay}
connections: [{from: source.value, to: relay.in, policy: {type: buffer, size: 100}}]
)";
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    deployment.configure();
    const std::atomic<bool> stop{false};
    const RunResult result = deployment.run({.duration_s = 0.5}, stop);
    EXPECT_FALSE(result.failed());
    EXPECT_GE(result.wall_s, 0.5);
    // A loaded machine may leave periods out, it never adds any.
    const uint64_t cycles = deployment.task("source")->cycles().count();
    EXPECT_GE(cycles, 5u);
    EXPECT_LE(cycles, 27u + static_cast<uint64_t>((result.wall_s - 0.5) / 0.02));
    EXPECT_EQ(dynamic_cast<test::Relay&>(*deployment.task("relay")).notes.size(), cycles);
    EXPECT_EQ(deployment.task("relay")->state(), TaskState::Stopped);
}

/** A source whose clock stands at 5 s. */
struct Timekeeper : test::Source {
    using Source::Source;
    std::function<types::Time()> clock(std::function<types::Time()> wall) override {
        return [wall] { return wall().isNull() ? types::Time{} : types::Time::fromSeconds(5); };
    }
};

TEST(RealtimeTest, ASourcesOwnClockIsThatOfAllTasks) {
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
    deployment.run({}, stop, [&](const Progress& progress) { stop = progress.wall_s > 0.2; });
    const auto& notes = dynamic_cast<test::Relay&>(*deployment.task("relay")).notes;
    ASSERT_FALSE(notes.empty());
    for (const std::string& note : notes) EXPECT_TRUE(note.ends_with("@5000000")) << note;
}

TEST(RealtimeTest, TheStopFlagEndsARunInOrder) {
    Registry registry = test::testRegistry();
    const char* yaml = "schedule: realtime\ntasks: {source: {type: test::Source, activity: {period: 0.001}}}\n";
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    deployment.configure();
    std::atomic<bool> stop{false};
    const RunResult result = deployment.run({}, stop, [&](const Progress& progress) { stop = progress.wall_s > 0.05; });
    EXPECT_FALSE(result.failed());
    EXPECT_EQ(deployment.task("source")->state(), TaskState::Stopped);
}

TEST(RealtimeTest, ATaskThatThrowsEndsTheRunWithItsMessage) {
    Registry registry = test::testRegistry();
    const char* yaml = R"(
schedule: realtime
tasks:
  source: {type: test::Source, activity: {period: 0.001}}
  faulty: {type: test::Faulty}
connections: [{from: source.value, to: faulty.in}]
)";
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    deployment.configure();
    const std::atomic<bool> stop{false};
    const RunResult result = deployment.run({.duration_s = 10}, stop);
    EXPECT_EQ(result.failures, (std::vector<std::string>{"faulty: updateHook: the third is too much"}));
    EXPECT_LT(result.wall_s, 10);
}

}  // namespace
}  // namespace insonify::framework
