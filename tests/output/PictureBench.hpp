#pragma once
// A lone task that makes pictures of pings and another stream.
#include <gtest/gtest.h>

#include "tests/support/Ports.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::test {

template <class Task, class Second>
struct PictureBench : ::testing::Test {
    explicit PictureBench(framework::InputPort<Second> Task::*second) {
        pings_.port.connectTo(task_.ping, framework::ConnPolicy::buffer(100));
        second_.port.connectTo(task_.*second, framework::ConnPolicy::buffer(100));
        task_.image.connectTo(out_.port, framework::ConnPolicy::buffer(100));
    }
    void start() { ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError(); }
    void give(const types::Sonar& ping) {
        pings_.port.write(std::make_shared<const types::Sonar>(ping));
        task_.update();
    }
    void giveSecond(const Second& sample) {
        second_.port.write(sample);
        task_.update();
    }
    /** Returns the number of pictures since the last call; the newest is `last_`. */
    size_t pictures() {
        size_t count = 0;
        for (types::ImagePtr picture; out_.port.readNew(picture); ++count) last_ = picture;
        return count;
    }

    Task task_{"pictures"};
    Writer<types::SonarPtr> pings_;
    Writer<Second> second_;
    Reader<types::ImagePtr> out_;
    types::ImagePtr last_;
};

}  // namespace insonify::test
