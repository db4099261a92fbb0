#pragma once
// A log and a task that replays it.
#include <gtest/gtest.h>

#include "components/log/pocolog/Writer.hpp"
#include "components/replay/ReplayTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::replay {

inline types::Pose poseAt(int64_t time) {
    types::Pose pose;
    pose.time = {time};
    pose.position.x = static_cast<double>(time);
    return pose;
}

inline types::Sonar pingAt(int64_t time) {
    types::Sonar ping;
    ping.time = {time};
    ping.bins = {static_cast<float>(time)};
    return ping;
}

/** A log of poses at 10, 20 and 30 us and pings of the first two that arrive late, and a task that replays it. */
struct Bench {
    Folder folder;
    ReplayTask task{"replay"};
    types::Time clock;

    explicit Bench(bool lockstep = true, ReplayConfig config = {}) {
        writeLog();
        config.file = "x.0.log";
        task.config.set(config);
        task.environment().input_folder = folder.path();
        task.environment().lockstep = lockstep;
        task.environment().now = [this] { return clock; };
        if (!lockstep) task.environment().now = task.clock(task.environment().now);
    }
    void writeLog() {
        log::pocolog::Writer log(folder / "x.0.log");
        const size_t pose = log.addStream<types::Pose>("vehicle.pose");
        const size_t ping = log.addStream<types::Sonar>("sonar.ping");
        log.write(pose, {11}, poseAt(10));
        log.write(pose, {21}, poseAt(20));
        log.write(ping, {25}, pingAt(10));
        log.write(pose, {31}, poseAt(30));
        log.write(ping, {35}, pingAt(20));
        log.close();
    }
    template <class T>
    void connect(const std::string& stream, test::Reader<T>& reader) {
        ASSERT_TRUE(task.makeOutput(stream)->connectTo(reader.port, framework::ConnPolicy::buffer(100)));
    }
    /** Starts the task with a reader of one of its streams. */
    template <class T>
    void start(const std::string& stream, test::Reader<T>& reader) {
        connect(stream, reader);
        ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    }
    void updateAt(int64_t time) {
        clock = {time};
        task.update();
    }
};

template <class T>
std::vector<int64_t> stampsIn(test::Reader<T>& reader) {
    std::vector<int64_t> stamps;
    for (T sample; reader.port.readNew(sample);) stamps.push_back(types::carriedSample(sample)->time.microseconds);
    return stamps;
}

}  // namespace insonify::replay
