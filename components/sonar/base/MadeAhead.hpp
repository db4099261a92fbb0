#pragma once
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "types/Thread.hpp"

namespace insonify::sonar {

/** Makes what later pings will need on a thread of its own, which starts with the first list, without a realtime
 *  priority. Values are kept as long as the newest list has them. They are shared by all who need them: a ping that
 *  needs one earlier waits for it, and lends its priority meanwhile, so that no ping depends on the progress of the
 *  thread. */
class MadeAhead {
public:
    /** A value to be made. */
    struct Item {
        std::array<int64_t, 4> key;  ///< Equal for equal values.
        /** Makes the value. May throw: the ping that needs it meets the same error, and reports it. Where `quits`
         *  becomes true, nobody waits for it any more. */
        std::function<std::shared_ptr<const void>(const std::atomic<bool>& quits)> make;
    };
    using Items = std::vector<Item>;

    explicit MadeAhead(std::string what) : what_(std::move(what)) {}
    ~MadeAhead();
    MadeAhead(const MadeAhead&) = delete;
    MadeAhead& operator=(const MadeAhead&) = delete;

    /** Sets the values that will be needed, the most urgent first. Does not wait. Without effect where the system
     * permits no more threads, and in a forked child: then pings make what they need. */
    void take(Items items);
    /** Returns whether all values of the newest list are made. */
    bool isDone() const;

private:
    using Made = std::pair<std::array<int64_t, 4>, std::shared_ptr<const void>>;
    void start();
    void end();
    void work();

    std::string what_;
    types::OwnProcess process_;
    std::thread worker_;
    mutable types::PriorityMutex mutex_;
    std::unique_ptr<std::condition_variable> asked_ = std::make_unique<std::condition_variable>();
    std::unique_ptr<const Items> next_;  ///< Items that the worker has not received yet.
    bool is_working_ = false;
    std::atomic<bool> quits_{false};
    std::vector<Made> made_;  ///< Used by the worker thread only.
};

}  // namespace insonify::sonar
