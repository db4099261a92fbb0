#pragma once
// Allocations of tasks that take pings and give pings.
#include <gmock/gmock.h>

#include "tests/support/Allocations.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::test {

/** Expects that a task allocates nothing after the first ping; `input` feeds it, `output` receives its answers. */
template <class Task, class Config>
void expectNoAllocation(const Config& config, framework::InputPort<types::SonarPtr> Task::*input,
                        framework::OutputPort<types::SonarPtr> Task::*output) {
    Task task("task");
    Writer<types::SonarPtr> in;
    Reader<types::SonarPtr> out;
    in.port.connectTo(task.*input, {});
    (task.*output).connectTo(out.port, {});
    task.config.set(config);
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const auto cycle = [&](int64_t time) {
        in.port.write(shared(makePing(16, 100, 1, time)));
        task.update();
    };
    EXPECT_THAT(allocationsAfterTheFirst(task, cycle), testing::IsEmpty());
    EXPECT_EQ((task.*output).written(), 99u);
}

}  // namespace insonify::test
