#pragma once
// A deployment with a viewer, while it runs.
#include <atomic>
#include <thread>

#include "components/framework/Deployment.hpp"
#include "components/viewer/registerTasks.hpp"
#include "tests/viewer/Bench.hpp"

namespace insonify::viewer {

struct LevelConfig {
    double level = 1;
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(types::Field{"level", "1", "of the echo", 0, 100}, self.level);
    }
};

class LevelTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    framework::Properties<LevelConfig> config{this};
    framework::OutputPort<types::SonarPtr> ping{this, "ping", "of that level"};

private:
    bool propertiesHook() override { return true; }
    void updateHook() override {
        const auto sample = blockPing(now().microseconds);
        for (float& bin : sample->bins) bin *= static_cast<float>(config->level);
        ping.write(sample);
    }
};

/** A lockstep deployment that runs on a thread of its own, slowly. */
class Running {
public:
    /** @param port 0: any that is free. */
    explicit Running(uint16_t port = 0) : deployment_(spec(port), registry_) {
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
    framework::DeploymentSpec spec(uint16_t port) {
        registry_.add<LevelTask>("test::LevelTask", "");
        registerTasks(registry_);
        auto spec = framework::DeploymentSpec::parse(R"(
tasks:
  source: {type: test::LevelTask, activity: {period: 0.01}}
  viewer: {type: viewer::ViewerTask, properties: {}}
connections:
  - {from: source.ping, to: viewer.ping, policy: {type: buffer, size: 8}}
)",
                                                     "test.yml");
        spec.set("viewer.port=" + std::to_string(port));
        return spec;
    }
    framework::Registry registry_;
    framework::Deployment deployment_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace insonify::viewer
