#include <gmock/gmock.h>

#include <string>

#include "components/framework/TaskContext.hpp"
#include "components/framework/execution/Activity.hpp"
#include "tests/framework/Tasks.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/ThreadLimit.hpp"

namespace insonify::framework {
namespace {

/** Records which hooks ran, by their letters, and throws in, or refuses, the hooks that the test names. */
class Probe : public TaskContext {
public:
    using TaskContext::TaskContext;
    std::string hooks, throwing;
    char refusing = 0;
    bool erring = false, off_thread = false;
    std::thread::id thread;
    std::function<void()> during;

private:
    bool hook(char letter) {
        hooks += letter;
        if (thread == std::thread::id()) thread = std::this_thread::get_id();
        off_thread |= std::this_thread::get_id() != thread;
        if (during) during();
        if (throwing.find(letter) != std::string::npos) throw std::runtime_error(std::string("thrown in ") + letter);
        return refusing != letter;
    }
    bool configureHook() override { return hook('C'); }
    bool startHook() override { return hook('S'); }
    void updateHook() override {
        hook('U');
        if (erring) error("no depth");
    }
    void errorHook() override { hook('E'); }
    void stopHook() override { hook('s'); }
    void cleanupHook() override { hook('c'); }
    void exceptionHook() override { hook('x'); }
};

enum class Call { Configure, Start, Stop, Cleanup, Recover };

Outcome make(Probe& task, Call call) {
    switch (call) {
        case Call::Configure: return task.configure();
        case Call::Start: return task.start();
        case Call::Stop: return task.stop();
        case Call::Cleanup: return task.cleanup();
        default: return task.recover();
    }
}

/** Brings a new task into a state by legal transitions. */
void bring(Probe& task, TaskState state) {
    if (state == TaskState::PreOperational) return;
    task.configure();
    if (state == TaskState::Stopped) return;
    task.start();
    if (state == TaskState::RunTimeError) task.erring = true;
    if (state == TaskState::Exception) task.throwing = "U";
    if (state == TaskState::FatalError) task.throwing = "Ux";
    if (state != TaskState::Running) task.update();
    task.erring = false;
    task.throwing = "";
}

TEST(LifeCycleTest, EveryTransitionIsAllowedOrRefusedAsInOrocos) {
    using enum TaskState;
    struct Row {
        TaskState from;
        Call call;
        TaskState to;
        std::string hooks;  // empty with an unchanged state: refused
        bool done;
    };
    const Row table[] = {
        {PreOperational, Call::Configure, Stopped, "C", true},
        {PreOperational, Call::Start, PreOperational, "", false},
        {PreOperational, Call::Stop, PreOperational, "", false},
        {PreOperational, Call::Cleanup, PreOperational, "", false},
        {PreOperational, Call::Recover, PreOperational, "", false},
        {Stopped, Call::Configure, Stopped, "cC", true},
        {Stopped, Call::Start, Running, "S", true},
        {Stopped, Call::Stop, Stopped, "", false},
        {Stopped, Call::Cleanup, PreOperational, "c", true},
        {Stopped, Call::Recover, Stopped, "", false},
        {Running, Call::Configure, Running, "", false},
        {Running, Call::Start, Running, "", false},
        {Running, Call::Stop, Stopped, "s", true},
        {Running, Call::Cleanup, Running, "", false},
        {Running, Call::Recover, Running, "", false},
        {RunTimeError, Call::Configure, RunTimeError, "", false},
        {RunTimeError, Call::Start, RunTimeError, "", false},
        {RunTimeError, Call::Stop, Stopped, "s", true},
        {RunTimeError, Call::Cleanup, RunTimeError, "", false},
        {RunTimeError, Call::Recover, Running, "", true},
        {Exception, Call::Configure, Exception, "", false},
        {Exception, Call::Start, Exception, "", false},
        {Exception, Call::Stop, Exception, "", false},
        {Exception, Call::Cleanup, Exception, "", false},
        {Exception, Call::Recover, PreOperational, "", true},
        {FatalError, Call::Configure, FatalError, "", false},
        {FatalError, Call::Start, FatalError, "", false},
        {FatalError, Call::Stop, FatalError, "", false},
        {FatalError, Call::Cleanup, FatalError, "", false},
        {FatalError, Call::Recover, FatalError, "", false},
    };
    for (const Row& row : table) {
        SCOPED_TRACE(std::string(toString(row.from)) + ", call " + std::to_string(static_cast<int>(row.call)));
        Probe task("probe");
        bring(task, row.from);
        ASSERT_EQ(task.state(), row.from);
        task.hooks.clear();
        const Outcome outcome = make(task, row.call);
        EXPECT_EQ(outcome.done, row.done);
        EXPECT_EQ(outcome.reason.empty(), row.done);
        EXPECT_EQ(task.state(), row.to);
        EXPECT_EQ(task.hooks, row.hooks);
    }
}

TEST(LifeCycleTest, AThrowIsUndoneOnceAndEndsInException) {
    struct Row {
        std::string throwing, hooks;
        TaskState end;
    };
    const Row table[] = {
        {"C", "Cx", TaskState::Exception},         {"S", "CScx", TaskState::Exception},
        {"U", "CSUscx", TaskState::Exception},     {"s", "CSUscx", TaskState::Exception},
        {"c", "CSUscx", TaskState::Exception},     {"Cx", "Cx", TaskState::FatalError},
        {"Us", "CSUscx", TaskState::FatalError},   {"Uc", "CSUscx", TaskState::FatalError},
        {"Ux", "CSUscx", TaskState::FatalError},   {"sc", "CSUscx", TaskState::FatalError},
        {"Uscx", "CSUscx", TaskState::FatalError}, {"", "CSUsc", TaskState::PreOperational},
    };
    for (const Row& row : table) {
        SCOPED_TRACE("throw in " + row.throwing);
        Probe task("probe");
        task.throwing = row.throwing;
        if (task.configure() && task.start()) {
            task.update();
            if (task.isRunning() && task.stop()) task.cleanup();
        }
        EXPECT_EQ(task.hooks, row.hooks);
        EXPECT_EQ(task.state(), row.end);
        if (row.throwing.empty()) continue;
        EXPECT_NE(task.lastError().find("thrown in " + row.throwing.substr(0, 1)), std::string::npos);
    }
}

TEST(LifeCycleTest, AThrowInErrorHookIsUndoneToo) {
    Probe task("probe");
    bring(task, TaskState::RunTimeError);
    task.throwing = "E";
    task.update();
    EXPECT_EQ(task.hooks, "CSUEscx");
    EXPECT_EQ(task.state(), TaskState::Exception);
}

TEST(LifeCycleTest, ARefusingHookLeavesTheStateAndIsNotUndone) {
    Probe task("probe");
    task.refusing = 'C';
    EXPECT_NE(task.configure().reason.find("configureHook refused"), std::string::npos);
    EXPECT_EQ(task.state(), TaskState::PreOperational);
    task.refusing = 'S';
    ASSERT_TRUE(task.configure());
    EXPECT_FALSE(task.start());
    EXPECT_EQ(task.state(), TaskState::Stopped);
    EXPECT_EQ(task.hooks, "CCS");
}

TEST(LifeCycleTest, ErrorRunsErrorHookUntilRecovered) {
    Probe task("probe");
    bring(task, TaskState::RunTimeError);
    EXPECT_EQ(task.lastError(), "no depth");
    task.update();
    ASSERT_TRUE(task.recover());
    task.update();
    EXPECT_EQ(task.hooks, "CSUEU");
}

TEST(LifeCycleTest, RecoversAfterAFailedStop) {
    Probe task("probe");
    bring(task, TaskState::Running);
    task.throwing = "s";
    EXPECT_FALSE(task.stop());
    task.throwing = "";
    EXPECT_TRUE(task.recover());
    EXPECT_TRUE(task.configure());
    EXPECT_TRUE(task.start());
}

TEST(LifeCycleTest, HooksRunOnTheTasksOwnThread) {
    Probe task("probe");
    bring(task, TaskState::Running);
    std::thread([&] { task.update(); }).join();
    task.stop();
    EXPECT_FALSE(task.off_thread);
    EXPECT_NE(task.thread, std::this_thread::get_id());
}

TEST(LifeCycleTest, ATaskMayStopItselfButNotWithinAnotherTransition) {
    Probe task("probe");
    bring(task, TaskState::Running);
    std::string reason;
    task.during = [&] {
        if (task.hooks.back() == 's')
            reason = task.stop().reason;
        else
            task.stop();
    };
    task.update();
    EXPECT_EQ(task.state(), TaskState::Stopped);
    EXPECT_EQ(task.hooks, "CSUs");
    EXPECT_EQ(reason, "cannot stop: probe is in the middle of stop");
}

TEST(LifeCycleTest, AThrowAfterAFailedStopIsNotUndoneTwice) {
    for (const auto& [throwing, end] : {std::pair("sU", TaskState::Exception), {"sxU", TaskState::FatalError}}) {
        Probe task("probe");
        bring(task, TaskState::Running);
        task.throwing = throwing;
        task.during = [&] {
            if (task.hooks.back() == 'U') task.stop();
        };
        task.update();
        EXPECT_EQ(task.hooks, "CSUscx");
        EXPECT_EQ(task.state(), end);
        EXPECT_NE(task.lastError().find("thrown in U"), std::string::npos);
    }
}

TEST(LifeCycleTest, NoCycleRunsWithinATransition) {
    Probe task("probe");
    bring(task, TaskState::Running);
    task.during = [&] {
        if (task.hooks.back() == 's') task.update();
    };
    EXPECT_TRUE(task.stop());
    EXPECT_EQ(task.hooks, "CSs");
}

TEST(LifeCycleTest, KeepsTheWholeConfigurationDiagnostic) {
    Probe task("probe");
    task.during = [] { throw types::ConfigError("a.glb", "meshes[2]", "is no mesh"); };
    EXPECT_FALSE(task.configure());
    ASSERT_NE(task.configError(), nullptr);
    EXPECT_EQ(task.configError()->diagnostics().front().path, "meshes[2]");
}

TEST(LifeCycleTest, EveryChangeOfStateIsWrittenWithItsOrocosNumber) {
    Probe task("probe");
    test::Reader<int32_t> reader;
    ASSERT_TRUE(task.output("state")->connectTo(reader.port, ConnPolicy::buffer(8)));
    bring(task, TaskState::Exception);
    std::vector<int32_t> states;
    for (int32_t state; reader.port.readNew(state);) states.push_back(state);
    EXPECT_EQ(states, (std::vector<int32_t>{4, 5, 3}));
}

TEST(LifeCycleTest, ALaterReaderOfTheStateGetsTheLastState) {
    Probe task("probe");
    ConnPolicy policy;
    policy.init = true;
    for (const TaskState expected : {TaskState::PreOperational, TaskState::Running}) {
        bring(task, expected);
        test::Reader<int32_t> reader;
        ASSERT_TRUE(task.output("state")->connectTo(reader.port, policy));
        int32_t state = -1;
        EXPECT_TRUE(reader.port.readNew(state));
        EXPECT_EQ(state, static_cast<int32_t>(expected));
    }
}

TEST(LifeCycleTest, WithoutAThreadATransitionIsRefusedAndCanBeRepeated) {
    test::Source task("source");
    {
        const test::ThreadLimit limit(0);
        for (int i = 0; i < 3; ++i) {
            const Outcome outcome = task.configure();
            EXPECT_FALSE(outcome);
            EXPECT_THAT(outcome.reason, testing::HasSubstr("cannot configure: no thread for task source: "));
            EXPECT_EQ(task.lastError(), outcome.reason);
            EXPECT_FALSE(task.stop());
            EXPECT_THROW(task.update(), std::runtime_error);
        }
        EXPECT_EQ(task.state(), TaskState::PreOperational);
    }
    EXPECT_TRUE(task.configure()) << task.lastError();
    EXPECT_TRUE(task.start()) << task.lastError();
    EXPECT_TRUE(task.stop());
}

/** Returns how a run ends with a limited number of threads. */
std::string findEnd(const std::string& yaml, int threads) try {
    Registry registry = test::testRegistry();
    const test::ThreadLimit limit(threads);
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    deployment.configure();
    const std::atomic<bool> never{false};
    const RunResult result = deployment.run({.duration_s = 0.02}, never);
    return result.failed() ? "failed: " + result.failures.at(0) : "";
} catch (const std::exception& error) {
    return error.what();
}

TEST(LifeCycleTest, EveryThreadOfARunThatIsRefusedIsAnError) {
    for (const char* schedule : {"lockstep", "realtime"}) {
        const std::string yaml = std::string("schedule: ") + schedule + R"(
tasks:
  source: {type: test::Source, activity: {period: 0.001}}
  relay: {type: test::Relay, activity: {trigger: [in]}}
connections: [{from: source.value, to: relay.in, policy: {type: buffer, size: 4}}]
)";
        const int needed = 2 + (std::string(schedule) == "realtime" ? 1 : 0);  // tasks, and the watchdog
        for (int threads = 0; threads < needed; ++threads)
            EXPECT_THAT(findEnd(yaml, threads), testing::HasSubstr("no thread for ")) << schedule << ' ' << threads;
        EXPECT_EQ(findEnd(yaml, needed), "");
    }
}

}  // namespace
}  // namespace insonify::framework
