#pragma once
// The two ends of a deployment that advances step by step.
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Event.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/DepthMap.hpp"
#include "types/Pose.hpp"
#include "types/Sonar.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::deployer {

/** Writes the poses that a caller gives, at their time. Its outputs are those that connections name. */
class PoseFeed final : public framework::TaskContext, public framework::ClockSource {
public:
    using TaskContext::TaskContext;

    framework::OutputPortBase* makeOutput(const std::string& port) override {
        return &outputs_.make<types::Pose>(port, "poses that the caller gives").port;
    }
    std::optional<types::Time> nextTime() const override { return due_; }

    /** Sets the pose of a port for the next cycle. */
    void give(const std::string& port, types::Pose pose) {
        due_ = pose.time;
        given_[port] = std::move(pose);
        called_.raise();
    }

private:
    bool startHook() override {
        due_.reset();
        given_.clear();
        return true;
    }
    void updateHook() override {
        outputs_.forEach([&](auto& output) {
            const auto found = given_.find(output.port.name());
            if (found != given_.end()) output.port.write(found->second);
        });
        due_.reset();
        given_.clear();
    }

    framework::Event called_{this};  ///< The caller is outside of the deployment.
    framework::DynamicOutputs<std::tuple<types::Pose>> outputs_{this};
    std::optional<types::Time> due_;
    std::map<std::string, types::Pose> given_;
};

/** Receives pings from a deployment. */
struct PingReader : framework::TaskContext {
    explicit PingReader(std::string source) : TaskContext(std::move(source)) {}
    framework::InputPort<types::SonarPtr> ping{this, "ping", "of the last step"};
    framework::InputPort<types::SonarTruthPtr> truth{this, "truth", "of the same", framework::Need::Optional};
    framework::InputPort<types::DepthMapPtr> range_image{this, "range_image", "of the same, by a 3-D sonar",
                                                         framework::Need::Optional};
    framework::InputPort<types::SonarTruthPtr> range_truth{this, "range_truth", "what that shows",
                                                           framework::Need::Optional};
};

}  // namespace insonify::deployer
