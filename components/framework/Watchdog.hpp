#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** Looks at tasks from a thread of its own, for as long as it lives: reports a cycle that does not come back, once, and
 *  when it has; and each time that a task goes into RunTimeError, and back. It cannot end a cycle. */
class Watchdog {
public:
    struct Limit {
        TaskContext* task;
        double
            seconds;  ///< How long a cycle may take, without the pauses that it makes itself, see Activity::sleepUntil.
    };
    /** Reports, "camera: ...", come on the watchdog's thread. */
    using Report = std::function<void(const std::string&)>;

    Watchdog(const std::vector<Limit>& limits, Report report);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

private:
    struct Watched {
        Limit limit;
        int64_t reported = 0;  ///< When the cycle that hangs has begun; 0: none [ns].
        bool in_error = false;
    };
    void loop();
    void look(Watched& watched) const;
    void lookForHang(Watched& watched) const;

    std::vector<Watched> watched_;
    Report report_;
    double interval_ = 0.05;  ///< Between two looks [s].
    std::mutex mutex_;
    std::condition_variable wake_;
    bool ending_ = false;
    std::thread thread_;
};

}  // namespace insonify::framework
