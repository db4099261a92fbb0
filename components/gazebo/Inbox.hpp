#pragma once
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "types/Pose.hpp"
#include "types/Time.hpp"

namespace insonify::gazebo {

/** A body in a message. */
struct Placed {
    size_t body = 0;  ///< Its place in the configuration.
    types::Pose pose;
    std::string diagnostic;  ///< Why there is no pose.
};

/** One message, as far as it is wanted. */
struct Arrived {
    size_t topic = 0;
    std::optional<types::Time> stamp;  ///< Of the simulation.
    std::vector<Placed> bodies;
};

/** Takes messages on the threads of Gazebo's transport and hands them to the task. Everything is for any thread. */
class Inbox {
public:
    static constexpr size_t capacity = 1000;  ///< Messages, of which the oldest go when nobody takes them.

    /** `arrived` is called on the transport's threads. */
    explicit Inbox(std::function<void()> arrived) : arrived_(std::move(arrived)) {}
    void put(Arrived message);
    std::vector<Arrived> take();
    /** From now on nobody is told and nothing is kept. */
    void close();
    uint64_t lost() const;

private:
    mutable std::mutex mutex_;
    std::function<void()> arrived_;  ///< Empty: closed.
    std::vector<Arrived> messages_;
    uint64_t lost_ = 0;
};

}  // namespace insonify::gazebo
