#include <gmock/gmock.h>

#include <thread>

#include "components/framework/execution/Activity.hpp"
#include "components/framework/execution/RealtimeExecutor.hpp"
#include "tests/framework/Tasks.hpp"

namespace insonify::framework {
namespace {

using testing::ElementsAre;
using testing::MatchesRegex;

/** The deployment's warnings so far; the tasks of these tests wait for them. */
struct Reported {
    std::mutex mutex;
    std::vector<std::string> texts;
    std::function<void()> at_report = [] {};
    void add(const std::string& text) {
        std::lock_guard lock(mutex);
        texts.push_back(text);
        at_report();
    }
    size_t count() {
        std::lock_guard lock(mutex);
        return texts.size();
    }
};
Reported* reported = nullptr;

/** Its first cycle ends once it has been reported. */
struct Hanging : TaskContext {
    using TaskContext::TaskContext;
    void updateHook() override {
        while (reported->count() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
};

/** In error until the error has been reported. */
struct Ill : TaskContext {
    using TaskContext::TaskContext;
    void updateHook() override {
        if (reported->count() == 0) error("has a cold");
    }
    void errorHook() override {
        if (reported->count() > 0) recover();
    }
};

/** Runs one task until there were two warnings. */
struct WatchdogTest : testing::Test {
    WatchdogTest() { reported = &reported_; }
    RunResult run(const std::string& yaml) {
        Registry registry;
        registry.add<Hanging>("test::Hanging", "hangs");
        registry.add<Ill>("test::Ill", "errs");
        deployment_ =
            std::make_unique<Deployment>(DeploymentSpec::parse("schedule: realtime\n" + yaml, "a.yml"), registry);
        deployment_->configure();
        deployment_->onWarning([this](const std::string& text) {
            reported_.add(text);
            if (throws_) throw std::runtime_error("no console");
        });
        std::atomic<bool> stop{false};
        return deployment_->run({}, stop, [&](const Progress&) { stop = reported_.count() >= 2; });
    }
    Reported reported_;
    bool throws_ = false;
    std::unique_ptr<Deployment> deployment_;
};

TEST_F(WatchdogTest, ReportsAHangingCycleOnceAndItsEnd) {
    const RunResult result = run("tasks: {slug: {type: test::Hanging, activity: {period: 0.01, watchdog: 0.3}}}\n");
    EXPECT_EQ(result.failures, std::vector<std::string>{});
    ASSERT_GE(result.warnings.size(), 2u);
    EXPECT_EQ(result.warnings[0], "slug: hangs: a cycle has run for 0.3 s");
    EXPECT_THAT(result.warnings[1], MatchesRegex("slug: is back after 0\\.[3-9].* s|slug: is back after [1-9].* s"));
    EXPECT_EQ(result.warnings, reported_.texts);
    EXPECT_GE(deployment_->task("slug")->timing().hangs, 1u);
}

TEST_F(WatchdogTest, AReceiverOfWarningsThatThrowsEndsNeitherTheWatchdogNorATask) {
    throws_ = true;
    const RunResult result =
        run("tasks: {slug: {type: test::Hanging, activity: {period: 0.01, watchdog: 0.3}},\n"
            "        ill: {type: test::Ill, activity: {period: 0.01}}}\n");
    EXPECT_EQ(result.failures, std::vector<std::string>{});
    EXPECT_EQ(deployment_->task("slug")->state(), TaskState::Stopped);
    EXPECT_GE(result.warnings.size(), 2u);
}

TEST(WatchdogReportTest, AReportThatThrowsDoesNotEndTheProcess) {
    struct Idle : TaskContext {
        using TaskContext::TaskContext;
    } task("slug");
    std::atomic<int> reports = 0;
    {
        const Watchdog watchdog({{&task, 0.004}}, [&](const std::string&) {
            ++reports;
            throw std::runtime_error("no console");
        });
        task.timing().begin();
        while (reports < 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        task.timing().pause();
        while (reports < 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(reports, 2);
}

TEST_F(WatchdogTest, UsesTheDeploymentsWatchdogForATaskWithoutItsOwn) {
    const RunResult result = run("watchdog: 0.2\ntasks: {slug: {type: test::Hanging, activity: {period: 0.01}}}\n");
    ASSERT_GE(result.warnings.size(), 1u);
    EXPECT_EQ(result.warnings[0], "slug: hangs: a cycle has run for 0.2 s");
}

TEST_F(WatchdogTest, ReportsATaskInErrorOnceAndItsRecovery) {
    const RunResult result = run("watchdog: 1000000\ntasks: {patient: {type: test::Ill, activity: {period: 0.001}}}\n");
    EXPECT_THAT(result.warnings, ElementsAre("patient: RunTimeError: has a cold", "patient: has recovered"));
    EXPECT_EQ(deployment_->task("patient")->timing().errors, 1u);
    EXPECT_FALSE(result.failed());
}

TEST_F(WatchdogTest, ItsPriorityIsAboveThoseOfTheTasks) {
    int policy = -1, priority = -1;
    reported_.at_report = [&] {
        sched_param parameters{};
        pthread_getschedparam(pthread_self(), &policy, &parameters);
        priority = parameters.sched_priority;
    };
    const RunResult result =
        run("tasks: {slug: {type: test::Hanging, "
            "activity: {period: 0.01, watchdog: 0.1, scheduler: fifo, priority: 7}}}\n");
    if (result.warnings.at(0).find("is not permitted") != std::string::npos)
        GTEST_SKIP() << "SKIPPED: SCHED_FIFO is not permitted";
    EXPECT_EQ(policy, SCHED_FIFO);
    EXPECT_EQ(priority, 8);
}

}  // namespace
}  // namespace insonify::framework
