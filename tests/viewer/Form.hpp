#pragma once
// A task with a property of each type, for the fields of the page.
#include <chrono>
#include <thread>

#include "tests/viewer/Running.hpp"

namespace insonify::viewer {
enum class Shape { Round, Square, Flat };
}  // namespace insonify::viewer
template <>
struct insonify::types::EnumNames<insonify::viewer::Shape> {
    static constexpr std::string_view names[] = {"round", "square", "flat"};
};

namespace insonify::viewer {

/** A property of each type. */
struct FormConfig {
    double range = 1;
    std::optional<double> gain_db;
    double frequency_khz = 700;
    bool enabled = true;
    Shape shape = Shape::Round;
    std::optional<Shape> maybe;
    int32_t count = 3;
    uint64_t seed = 7;
    std::string title = "first";
    glm::dvec3 place{1, 2, 3};
    std::vector<double> weights{0.5, 0.25};
    QualityConfig quality{256, {}};
    std::optional<QualityConfig> spare;
    static void describe(auto& self, auto& visit) {
        visit({"range", "m", "factor of the ping", 1, 100}, self.range);
        visit({"gain_db", "dB", "any"}, self.gain_db);
        visit({"frequency_khz", "kHz", "any", 1, 3000}, self.frequency_khz);
        visit({"enabled", "", "false is refused"}, self.enabled);
        visit({"shape", "", "flat is refused"}, self.shape);
        visit({"maybe", "", "any"}, self.maybe);
        visit({"count", "1", "any", 1, 1000}, self.count);
        visit({"seed", "1", "any"}, self.seed);
        visit({"title", "", "slow takes a second to be set"}, self.title);
        visit({"place", "m", "any"}, self.place);
        visit({"weights", "1", "any"}, self.weights);
        visit({"quality", "", "rows or a budget"}, self.quality);
        visit({"spare", "", "rows or a budget"}, self.spare);
    }
};

class FormTask final : public framework::TaskContext, public framework::Adjustable {
public:
    using TaskContext::TaskContext;
    framework::Properties<FormConfig> config{this};
    framework::OutputPort<types::SonarPtr> ping{this, "ping", "of the range as level"};

private:
    bool propertiesHook() override {
        if (config->title == "slow") std::this_thread::sleep_for(std::chrono::seconds(1));
        if (!config->enabled) throw std::runtime_error("not without it today");
        if (config->shape == Shape::Flat) throw std::runtime_error("flat is for later");
        return true;
    }
    void updateHook() override {
        const auto sample = blockPing(now().microseconds);
        for (float& bin : sample->bins) bin *= static_cast<float>(config->range);
        ping.write(sample);
    }
};

}  // namespace insonify::viewer
