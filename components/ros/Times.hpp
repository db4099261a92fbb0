#pragma once
#include <limits>
#include <stdexcept>

#include "components/ros/GeometryMessages.hpp"
#include "types/Time.hpp"

namespace insonify::ros {

/** Throws std::out_of_range for what 32 bits of seconds cannot hold: years before 1901 and after 2038. */
inline Time toRos(types::Time time) {
    const int64_t rest = (time.microseconds % 1'000'000 + 1'000'000) % 1'000'000;
    const int64_t seconds = (time.microseconds - rest) / 1'000'000;
    if (seconds < std::numeric_limits<int32_t>::min() || seconds > std::numeric_limits<int32_t>::max())
        throw std::out_of_range("ROS holds no time of " + std::to_string(seconds) +
                                " s: from -2147483648 s to 2147483647 s");
    return {static_cast<int32_t>(seconds), static_cast<uint32_t>(rest * 1000)};
}

/** To the microsecond below. */
inline types::Time fromRos(Time time) { return {time.sec * int64_t{1'000'000} + time.nanosec / 1000}; }

inline Clock toClock(types::Time time) { return {toRos(time)}; }

}  // namespace insonify::ros
