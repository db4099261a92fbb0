#pragma once
// A task that receives poses of others, and readers of its outputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/execution/Activity.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Waiting.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::test {

/** A bench for a task that listens. The task runs by its own activity or, with `by_hand`, a cycle in each attempt of a
 *  wait. */
template <class Task>
struct Listening {
    explicit Listening(const std::string& name, bool by_hand = false) : task(name), by_hand_(by_hand) {}
    ~Listening() { task.activity().hold(); }

    /** Makes a reader for each entry of a list of the configuration. */
    void start(const auto& config, const auto& entries) {
        task.config.set(config);
        for (size_t i = 0; i < entries.size(); ++i)
            task.makeOutput(entries[i].port)->connectTo(readers[i].port, framework::ConnPolicy::buffer(10'000));
        const framework::Outcome configured = task.configure();
        ASSERT_TRUE(configured) << configured.reason;
        ASSERT_TRUE(task.start());
        if (!by_hand_) task.activity().release();
    }
    /** Waits for the next pose. */
    std::optional<types::Pose> next(size_t reader = 0) {
        types::Pose pose;
        if (!becomesTrue([&] { return work(), readers[reader].port.readNew(pose); })) return std::nullopt;
        return pose;
    }
    /** Waits for a notice that contains this text; returns whether it came. */
    bool reports(const std::string& text) {
        return becomesTrue([&] {
            work();
            const std::vector<std::string> all = types::lines(task.notices());
            return std::ranges::any_of(all, [&](const auto& line) { return line.find(text) != std::string::npos; });
        });
    }

    Reader<types::Pose> readers[2];
    Task task;

private:
    void work() {
        if (by_hand_) task.update();
    }

    const bool by_hand_;
};

}  // namespace insonify::test
