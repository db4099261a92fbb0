#pragma once
// Small tasks for the tests of deployments.
#include <atomic>
#include <string>
#include <vector>

#include "components/framework/Deployment.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::test {

struct SourceConfig {
    int last = 3;
    uint64_t seed = 1;
    static void describe(auto& self, auto& visit) {
        visit({"last", "1", "cycles until finished", 1, 1e6}, self.last);
        visit({"seed", "1", "of nothing"}, self.seed);
    }
};

/** Writes 1, 2, 3... on `value`; it has finished after `last`, but continues to write. */
class Source : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    framework::Properties<SourceConfig> config{this};
    framework::OutputPort<double> value{this, "value", "how many cycles there were"};
    bool finished() const override { return count_ >= config->last; }

private:
    void updateHook() override { value.write(++count_); }
    std::atomic<int> count_{0};
};

/** Writes ten samples per cycle. */
class Burst : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    framework::OutputPort<double> value{this, "value", "0 to 9"};
    bool finished() const override { return true; }

private:
    void updateHook() override {
        for (int i = 0; i < 10; ++i) value.write(i);
    }
};

/** Adds 100 to its samples, one per cycle, and records "name:value@time". */
class Relay : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    framework::InputPort<double> in{this, "in", "any number"};
    framework::InputPort<double> extra{this, "extra", "read by nobody", framework::Need::Optional};
    framework::OutputPort<double> out{this, "out", "the number and 100"};
    std::vector<std::string> notes;

private:
    void updateHook() override {
        double value = 0;
        if (!in.readNew(value)) return;
        notes.push_back(name() + ":" + std::to_string(static_cast<int>(value)) + "@" +
                        std::to_string(now().microseconds));
        out.write(value + 100);
    }
};

/** Throws, or causes an error, at its third sample. */
class Throwing : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    framework::InputPort<double> in{this, "in", "any number"};

private:
    void updateHook() override {
        double value = 0;
        if (in.readNew(value) && value >= 3) throw std::runtime_error("the third is too much");
    }
};

/** Runs a cycle when rung. */
class Doorbell : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    framework::Event rung{this};
    std::atomic<int> answered{0};

private:
    void updateHook() override { ++answered; }
};

/** Reads texts, to have another type. */
struct Words : framework::TaskContext {
    using TaskContext::TaskContext;
    framework::InputPort<std::string> in{this, "in", "words"};
};

inline framework::Registry testRegistry() {
    framework::Registry registry;
    registry.add<Source>("test::Source", "counts");
    registry.add<Burst>("test::Burst", "ten at once");
    registry.add<Relay>("test::Relay", "adds 100");
    registry.add<Throwing>("test::Throwing", "throws");
    registry.add<Doorbell>("test::Doorbell", "counts");
    registry.add<Words>("test::Words", "takes words");
    return registry;
}

}  // namespace insonify::test
