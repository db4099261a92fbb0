// A log's metadata on the deployment that wrote it.
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

#include "components/framework/Deployment.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/Properties.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/logger/LoggerTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Waiting.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::logger {
namespace {

struct PlannerConfig {
    double range = 50;
    std::optional<double> gain;
    static void describe(auto& self, auto& visit) {
        visit({"range", "m", "range"}, self.range);
        visit({"gain", "1", "gain"}, self.gain);
    }
};

/** A sonar that has no plan before its first ping. */
struct PlannerTask : framework::TaskContext, framework::Planned {
    using TaskContext::TaskContext;
    framework::Properties<PlannerConfig> config{this};
    framework::OutputPort<types::SonarPtr> ping{this, "ping", "a ping"};
    framework::OutputPort<double> depth{this, "depth", "never written"};
    const types::Plan* plan() const override { return plan_ ? &*plan_ : nullptr; }
    void updateHook() override {
        plan_ = types::Plan{.features = {"HAVE_\"TVG\""},
                            .passes = {},
                            .omitted = {{"volume", "absent"}},
                            .notices = {},
                            .predicted_error = std::numeric_limits<double>::quiet_NaN(),
                            .device = {}};
        refreshRecord();
        ping.write(std::make_shared<types::Sonar>());
    }
    std::optional<types::Plan> plan_;
};

/** Stays in its hook after writing, until it is released. */
struct LingeringTask : PlannerTask {
    using PlannerTask::PlannerTask;
    void updateHook() override {
        PlannerTask::updateHook();
        lingering = true;
        while (!let_go) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::atomic<bool> lingering{false}, let_go{false};
};

/** Sets another range at its third ping. */
struct ChangingTask : PlannerTask {
    using PlannerTask::PlannerTask;
    bool propertiesHook() override { return true; }
    void updateHook() override {
        if (++pings == 3) static_cast<framework::PropertiesBase&>(config).set("range", "12");
        PlannerTask::updateHook();
    }
    int pings = 0;
};

/** A sonar, and a logger of its pings. */
std::string loggedSonar(const std::string& sonar) {
    return "tasks:\n  sonar: " + sonar + R"(
  log: {type: logger::LoggerTask, properties: {file: x.0.log}}
connections:
  - {from: sonar.ping, to: log.ping, policy: {type: buffer, size: 8}}
)";
}

struct LoggedRunTest : testing::Test {
    LoggedRunTest() {
        registerTasks(registry_);
        registry_.add<PlannerTask>("test::PlannerTask", "a sonar");
        registry_.add<ChangingTask>("test::ChangingTask", "a sonar whose range changes");
        registry_.add<LingeringTask>("test::LingeringTask", "a slow sonar");
    }
    framework::Deployment getDeployment(const std::string& text) {
        return {framework::DeploymentSpec::parse(text, (folder_ / "x.yml").string()), registry_, folder_.path()};
    }
    void run(const std::string& text, uint64_t pings) {
        framework::Deployment deployment = getDeployment(text);
        deployment.configure();
        const std::atomic<bool> never{false};
        EXPECT_FALSE(deployment.run({.samples = pings}, never).failed());
        EXPECT_THAT(deployment.cleanup(), testing::IsEmpty());
    }

    const Folder folder_;
    framework::Registry registry_;
};

TEST_F(LoggedRunTest, TheLogHasThePlanAndThePropertyLogIsNextToIt) {
    run(R"(
tasks:
  sonar: {type: test::PlannerTask, activity: {period: 0.1}, properties: {range: 30}}
  log: {type: logger::LoggerTask, properties: {file: x.0.log}}
  second: {type: logger::LoggerTask, properties: {file: y.0.log, metadata: {vessel: Kai}}}
connections:
  - {from: sonar.ping, to: second.ping, policy: {type: buffer, size: 8}}
  - {from: sonar.ping, to: log.ping, policy: {type: buffer, size: 8}}
  - {from: sonar.depth, to: log.depth, policy: {type: buffer, size: 8}}
)",
        3);

    const log::pocolog::Reader log(folder_ / "x.0.log");
    EXPECT_EQ(log.find("sonar.ping")->count, 3u);
    EXPECT_EQ(log.find("sonar.ping")->metadata.at("insonify_plan"),
              R"({"sonar": {"features": ["HAVE_\"TVG\""], "passes": [], "omitted": [{"name": "volume", "reason": )"
              R"("absent"}], "notices": [], "rows": 0, "columns_per_beam": 0, "slabs": 0, "predicted_error": null, )"
              R"("device": ""}})");
    EXPECT_NE(log.find("sonar.depth"), nullptr) << "declared, though never written";

    EXPECT_EQ(log::pocolog::Reader(folder_ / "y.0.log").find("sonar.ping")->count, 3u);
    log::pocolog::Reader properties(folder_ / "properties.0.log");
    EXPECT_TRUE(properties.complete()) << "one of two loggers writes it";
    std::vector<double> ranges;
    properties.forEach<double>("sonar.range", [&](double value, const log::SampleRef&) { ranges.push_back(value); });
    EXPECT_THAT(ranges, testing::ElementsAre(30));
    EXPECT_EQ(properties.find("sonar.gain"), nullptr) << "absent";
    EXPECT_NE(properties.find("log.file"), nullptr);
}

TEST_F(LoggedRunTest, ATaskHasTheSameModelInBothLogs) {
    std::ofstream(folder_ / "rock::Sonar.yml") << "--- name:default\nrange: 30\n";
    run(loggedSonar(
            R"({type: test::PlannerTask, activity: {period: 0.1}, property_files: {files: ["rock::Sonar.yml"]}})"),
        1);
    for (const auto& [file, stream] : {std::pair{"x.0.log", "sonar.ping"}, {"properties.0.log", "sonar.range"}})
        EXPECT_EQ(log::pocolog::Reader(folder_ / file).find(stream)->metadatum("rock_task_model"), "rock::Sonar");
}

TEST_F(LoggedRunTest, APropertyThatChangesDuringTheRunHasASampleForEachChange) {
    run(loggedSonar("{type: test::ChangingTask, activity: {period: 0.5}}"), 5);
    std::vector<std::pair<double, double>> ranges;
    log::pocolog::Reader(folder_ / "properties.0.log")
        .forEach<double>("sonar.range", [&](double value, const log::SampleRef& at) {
            ranges.emplace_back(at.time.seconds(), value);
        });
    EXPECT_THAT(ranges, testing::ElementsAre(testing::Pair(1, 50), testing::Pair(2, 12)));
}

TEST_F(LoggedRunTest, InRealtimeLoggersWaitForNoLoggerAndNoHook) {
    framework::Deployment deployment = getDeployment(R"(
schedule: realtime
tasks:
  sonar: {type: test::LingeringTask, activity: {period: 0.01}}
  log: {type: logger::LoggerTask, properties: {file: x.0.log}}
  second: {type: logger::LoggerTask, properties: {file: y.0.log}}
connections:
  - {from: sonar.ping, to: log.ping, policy: {type: buffer, size: 64}}
  - {from: sonar.ping, to: second.ping, policy: {type: buffer, size: 64}}
)");
    deployment.configure();
    auto& sonar = dynamic_cast<LingeringTask&>(*deployment.task("sonar"));
    const auto hasRead = [&](const char* logger) { return !deployment.task(logger)->input("ping")->hasNew(); };
    bool both_read = false;
    std::atomic<bool> stop{false};
    const std::chrono::duration<double> patience = test::patience;
    const auto progress = [&](const framework::Progress& now) {
        both_read = both_read || (sonar.lingering && hasRead("log") && hasRead("second"));
        if (both_read || now.wall_s > patience.count()) sonar.let_go = stop = true;
    };
    EXPECT_FALSE(deployment.run({}, stop, progress).failed());
    EXPECT_TRUE(both_read) << "while the sonar is in its first cycle";
    EXPECT_THAT(deployment.cleanup(), testing::IsEmpty());
    for (const char* file : {"x.0.log", "y.0.log"}) {
        const log::pocolog::Reader log(folder_ / file);
        EXPECT_THAT(log.find("sonar.ping")->metadata.at("insonify_plan"), testing::HasSubstr("volume"));
    }
}

TEST_F(LoggedRunTest, APropertySetDuringTheRunIsInTheTasksRecord) {
    framework::Deployment deployment =
        getDeployment("tasks: {sonar: {type: test::PlannerTask, activity: {period: 1}}}");
    const auto range = [&] { return deployment.environment().records().at(0).properties.at("range"); };
    EXPECT_EQ(range(), types::PropertyValue(50.0)) << "before it is configured";
    deployment.configure();
    deployment.call("sonar.setRange", {"20"});
    EXPECT_EQ(range(), types::PropertyValue(20.0));
    EXPECT_EQ(deployment.environment().records().at(0).type, "test::PlannerTask");
}

}  // namespace
}  // namespace insonify::logger
