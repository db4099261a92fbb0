#pragma once
// A lone task that takes one kind of sample and gives another.
//
//     struct NoiseTaskTest : test::TaskBench<NoiseTask, types::SonarPtr> {
//         NoiseTaskTest() : TaskBench(&NoiseTask::clean, &NoiseTask::noisy) {}
//     };
#include <gtest/gtest.h>

#include <type_traits>
#include <utility>

#include "tests/support/Ports.hpp"

namespace insonify::test {

template <class Task, class In, class Out = In>
struct TaskBench : ::testing::Test {
    TaskBench(framework::InputPort<In> Task::*input, framework::OutputPort<Out> Task::*output) {
        in_.port.connectTo(task_.*input, framework::ConnPolicy::buffer(4));
        (task_.*output).connectTo(out_.port, framework::ConnPolicy::buffer(4));
    }
    using Config = std::remove_cvref_t<decltype(*std::declval<Task&>().config)>;

    void startWith(const Config& config) {
        task_.config.set(config);
        ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    }
    /** Returns the output of one cycle for a sample; none if the task rejects the sample. */
    Out answerTo(const In& sample) {
        in_.port.write(sample);
        task_.update();
        Out answer{};
        out_.port.readNew(answer);
        return answer;
    }

    Task task_{"task"};
    Writer<In> in_;
    Reader<Out> out_;
};

}  // namespace insonify::test
