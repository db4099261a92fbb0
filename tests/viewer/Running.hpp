#pragma once
// A running deployment with a viewer.
#include <fmt/format.h>

#include <atomic>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <thread>

#include "components/framework/Deployment.hpp"
#include "components/framework/Offers.hpp"
#include "components/viewer/ViewerTask.hpp"
#include "tests/support/Deformed.hpp"
#include "tests/viewer/Bench.hpp"

namespace insonify::viewer {

/** Rows, or a budget instead. */
struct QualityConfig {
    std::optional<double> rows, budget_ms;
    static void describe(auto& self, auto& visit) {
        visit({"rows", "1", "of samples", 1, 1000}, self.rows);
        visit({"budget_ms", "ms", "instead", 1, 1000}, self.budget_ms);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (rows && budget_ms) diagnostics.push_back({"rows", "is given in addition to budget_ms"});
    }
};

struct LevelConfig {
    double level = 1;
    bool record = false;
    double fixed = 4;
    QualityConfig quality{256, {}};
    static void describe(auto& self, auto& visit) {
        visit({"level", "1", "of the echo", 0, 100}, self.level);
        visit({"record", "", "what a logger calls so"}, self.record);
        visit({"fixed", "m", "is not set while running"}, self.fixed);
        visit({"quality", "", "rows or a budget"}, self.quality);
    }
};

class LevelTask final : public framework::TaskContext, public framework::Adjustable, public framework::Recorder {
public:
    using TaskContext::TaskContext;
    framework::Properties<LevelConfig> config{this};
    framework::OutputPort<types::SonarPtr> ping{this, "ping", "of that level"};

    framework::Operation<std::string(double, double)> explain{
        this, "explain", "as a sonar's", [this](double bearing_deg, double range) -> std::string {
            if (range > 12) throw std::runtime_error("there is no bin");
            return asked_++ % 2 == 0 ? "" : fmt::format("at {:.0f} deg, {:.1f} m", bearing_deg, range);
        }};

    std::optional<types::Recording> recording() const override {
        return types::Recording{"dives/dive.3.log", written_, 50'000'000'000 - written_};
    }
    bool adjusts(const std::string& property) const override { return property != "fixed"; }

private:
    int asked_ = 0;
    std::atomic<uint64_t> written_{0};  // 100 MB in a second of simulated time
    bool propertiesHook() override {
        if (config->level == 66) throw std::runtime_error("66 is no level for today");
        return true;
    }
    void updateHook() override {
        if (config->record) written_ += 1'000'000;
        const auto sample = blockPing(now().microseconds);
        for (float& bin : sample->bins) bin *= static_cast<float>(config->level);
        ping.write(sample);
    }
};

struct WaterConfig {
    bool water = true;
    double raised = 0;
    static void describe(auto& self, auto& visit) {
        visit({"water", "", "whether snapshots have a surface"}, self.water);
        visit({"raised", "m", "height by which the stone's mesh is deformed; 0: it is at rest"}, self.raised);
    }
};

/** Sand 5 m below the surface with a stone, and a vehicle that moves north over it. */
class WorldTask final : public framework::TaskContext,
                        public framework::Planned,
                        public framework::Player,
                        public framework::Adjustable {
public:
    using TaskContext::TaskContext;
    framework::Properties<WaterConfig> config{this};
    framework::OutputPort<types::SnapshotPtr> snapshot{this, "snapshot", "of the scene"};
    framework::OutputPort<types::Pose> pose{this, "pose", "two each time"};

    framework::Operation<void(double)> seek{this, "seek", "seeks in its log of 100 s", [this](double seconds) {
                                                if (seconds > 90) throw std::runtime_error("not the last 10 s");
                                                at_s_ = seconds;
                                            }};

    const types::Plan* plan() const override { return &plan_; }
    std::optional<types::Playback> playback() const override { return types::Playback{at_s_, 100}; }

private:
    bool propertiesHook() override { return true; }
    static types::Mesh square(float half) {
        types::Mesh mesh;
        mesh.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
        mesh.indices = {0, 1, 2, 0, 2, 3};
        types::Cluster cluster;
        cluster.index_count = 6;
        mesh.clusters = {cluster};
        return mesh;
    }
    static types::GeometryPtr scene() {
        auto geometry = std::make_shared<types::Geometry>();
        geometry->meshes = {square(30), test::jointed(square(2))};
        geometry->materials.resize(1);
        geometry->materials[0].name = "sand";
        geometry->objects = {{"ground", 0, glm::dmat4(1)}, {"stone", 1, glm::dmat4(1)}};
        geometry->objects[0].world_from_object[3] = {0, 0, -5, 1};
        geometry->objects[1].world_from_object[3] = {8, 1, -4, 1};
        return geometry;
    }
    void updateHook() override {
        types::Pose here;
        here.time = now();
        here.position = {2 * now().seconds(), 0, -2};
        here.orientation = glm::dquat(1, 0, 0, 0);
        auto sample = std::make_shared<types::Snapshot>();
        sample->time = now();
        sample->sonar = here;
        sample->geometry = geometry_;
        if (config->water) sample->water_surface = 0;
        if (config->raised != 0) test::pose(*sample, 1, glm::translate(glm::dmat4(1), {0, 0, config->raised}));
        snapshot.write(sample);
        pose.write(here);
        pose.write(here);
    }

    std::atomic<double> at_s_{25};
    const types::GeometryPtr geometry_ = scene();
    const types::Plan plan_{{"cones"}, {"draw", "sum"}, {{"multipath", "not asked for"}}, {"a notice"}, 64, 2, 0,
                            0.01,      "llvmpipe"};
};

/** A lockstep deployment that runs slowly on a separate thread. */
class Running {
public:
    /** A test's additions to the deployment. */
    struct Additions {
        std::vector<std::string> settings = {};    ///< "viewer.control=false"
        std::string tasks = "", connections = "";  ///< In YAML, a line each.
        std::function<void(framework::Registry&)> registerTasks = [](framework::Registry&) {};
    };
    /** @param port 0: any free port */
    explicit Running(uint16_t port = 0) : Running(port, Additions()) {}
    Running(uint16_t port, const Additions& additions) : deployment_(spec(port, additions), registry_) {
        deployment_.configure();
        thread_ = std::thread([this] { deployment_.run({.pace = 1}, stop_); });
    }
    ~Running() {
        stop_ = true;
        thread_.join();
    }
    framework::Deployment& deployment() { return deployment_; }
    uint16_t port() const { return dynamic_cast<ViewerTask&>(*deployment_.task("viewer")).port(); }

private:
    framework::DeploymentSpec spec(uint16_t port, const Additions& additions) {
        registry_.add<LevelTask>("test::LevelTask", "");
        registry_.add<WorldTask>("test::WorldTask", "");
        registerTasks(registry_);
        additions.registerTasks(registry_);
        auto spec = framework::DeploymentSpec::parse(R"(
tasks:
  source: {type: test::LevelTask, activity: {period: 0.01}}
  world:  {type: test::WorldTask, activity: {period: 0.02}}
  viewer: {type: viewer::ViewerTask, properties: {idle_timeout: 3600}}
)" + additions.tasks + R"(
connections:
  - {from: source.ping,    to: viewer.ping,  policy: {type: buffer, size: 8}}
  - {from: world.snapshot, to: viewer.scene, policy: {type: buffer, size: 8}}
  - {from: world.pose,     to: viewer.pose,  policy: {type: buffer, size: 1}}
  - {from: world.pose,     to: viewer.newest}
)" + additions.connections,
                                                     "test.yml");
        spec.set("viewer.port=" + std::to_string(port));
        for (const std::string& setting : additions.settings) spec.set(setting);
        return spec;
    }
    framework::Registry registry_;
    framework::Deployment deployment_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace insonify::viewer
