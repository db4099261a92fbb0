// Schedulers, processors and locked memory: applied where the system permits them, else a warning.
#include <gmock/gmock.h>
#include <sched.h>

#include <fstream>
#include <functional>
#include <thread>

#include "components/framework/execution/Activity.hpp"
#include "components/framework/execution/RealtimeExecutor.hpp"
#include "tests/framework/Tasks.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Priorities.hpp"

namespace insonify::framework {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/** The scheduling of a thread. */
struct Thread {
    int policy = -1, priority = -1;
    std::vector<uint32_t> cpus;
    static Thread here() {
        Thread thread;
        sched_param parameters{};
        pthread_getschedparam(pthread_self(), &thread.policy, &parameters);
        thread.priority = parameters.sched_priority;
        cpu_set_t set;
        pthread_getaffinity_np(pthread_self(), sizeof set, &set);
        for (uint32_t cpu = 0; cpu < CPU_SETSIZE; ++cpu)
            if (CPU_ISSET(cpu, &set)) thread.cpus.push_back(cpu);
        return thread;
    }
};

/** Records the scheduling of its cycles, and of a thread that they start. */
struct Noting : TaskContext {
    using TaskContext::TaskContext;
    Thread own, started;
    std::atomic<bool> noted{false};
    void updateHook() override {
        own = Thread::here();
        std::thread([this] { started = Thread::here(); }).join();
        noted = true;
    }
};

bool fifoIsPermitted() {
    bool permitted = false;
    ActivitySettings settings;
    settings.fifo = true;
    settings.priority = 7;
    std::thread([&] { permitted = applyToThread(settings).empty(); }).join();
    return permitted;
}

/** Runs a task with this activity and these keys of the document; without a watchdog, which would warn of a slow
 *  machine. */
RunResult run(const std::string& head, const std::string& activity, Thread& own, Thread& started) {
    Registry registry;
    registry.add<Noting>("test::Noting", "notes");
    const std::string yaml = "schedule: realtime\nwatchdog: 1000000\n" + head +
                             "tasks: {note: {type: test::Noting, activity: {period: 0.01" + activity + "}}}\n";
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    deployment.configure();
    auto& task = dynamic_cast<Noting&>(*deployment.task("note"));
    std::atomic<bool> stop{false};
    RunResult result = deployment.run({}, stop, [&](const Progress&) { stop = task.noted.load(); });
    own = task.own;
    started = task.started;
    return result;
}

TEST(RealtimeThreadTest, AppliesSchedulingToATaskAndItsThreadsWherePermitted) {
    const bool permitted = fifoIsPermitted();
    Thread own, started;
    const RunResult result = run("", ", scheduler: fifo, priority: 7", own, started);
    EXPECT_EQ(own.policy, permitted ? SCHED_FIFO : SCHED_OTHER);
    EXPECT_EQ(started.policy, own.policy);
    EXPECT_EQ(own.priority, permitted ? 7 : 0);
    if (permitted)
        EXPECT_THAT(result.warnings, IsEmpty());
    else
        EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("note: no SCHED_FIFO: priority 7 is not permitted")));
    EXPECT_FALSE(result.failed());
}

TEST(RealtimeThreadTest, ATaskAndItsThreadsRunOnTheirProcessors) {
    const uint32_t last = Thread::here().cpus.back();
    Thread own, started;
    const RunResult result = run("", ", cpus: [" + std::to_string(last) + "]", own, started);
    EXPECT_THAT(result.warnings, IsEmpty());
    EXPECT_THAT(own.cpus, ElementsAre(last));
    EXPECT_THAT(started.cpus, ElementsAre(last));
}

TEST(RealtimeThreadTest, WarnsOfMissingProcessors) {
    Thread own, started;
    const RunResult result = run("", ", cpus: [1022, 1023]", own, started);
    EXPECT_THAT(result.warnings,
                ElementsAre(HasSubstr("note: cannot run on only the CPUs 1022, 1023: they do not exist")));
    EXPECT_EQ(own.cpus, Thread::here().cpus);
    EXPECT_FALSE(result.failed());
}

/** Locked memory of this process [kB]. */
int lockedMemory() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmLck:")) return std::stoi(line.substr(6));
    return -1;
}

TEST(RealtimeThreadTest, LocksMemoryOrReportsWhyNot) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers do not lock memory";
#endif
    const std::string refused = lockMemory();
    const int locked = lockedMemory();
    unlockMemory();
    EXPECT_EQ(lockedMemory(), 0);
    EXPECT_EQ(locked > 0, refused.empty()) << refused;
    Thread own, started;
    const RunResult result = run("lock_memory: true\n", "", own, started);
    if (refused.empty())
        EXPECT_THAT(result.warnings, IsEmpty());
    else
        EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("memory is not locked")));
    EXPECT_EQ(lockedMemory(), 0);
}

/** A sample whose copying takes, on one thread, until `may_end`. */
struct Heavy {
    static constexpr const char* type_name = "/test/Heavy";
    static inline thread_local const std::function<void()>* at_copy = nullptr;
    Heavy() = default;
    Heavy(const Heavy&) = default;
    Heavy& operator=(const Heavy&) {
        if (at_copy) (*at_copy)();
        return *this;
    }
};

/** A reader without a priority that copies a sample, and an urgent writer to the same port. */
struct Copying {
    test::Writer<Heavy> writer;
    test::Reader<Heavy> reader;
    Copying() { writer.port.connectTo(reader.port, ConnPolicy::buffer(4)), writer.port.write({}); }
    void work(const std::function<void()>& job) {
        Heavy sample;
        Heavy::at_copy = &job;
        reader.port.read(sample);
        Heavy::at_copy = nullptr;
    }
    void wait(std::thread& /*reader*/) { writer.port.write({}); }
};

TEST(RealtimeThreadTest, AWriterWaitsForTheCopyOfAReaderAndForNoOtherTask) {
    Copying copying;
    const auto first = test::urgentIsFirst(copying);
    if (!first) GTEST_SKIP() << "SKIPPED: SCHED_FIFO is not permitted";
    EXPECT_TRUE(*first);
}

}  // namespace
}  // namespace insonify::framework
