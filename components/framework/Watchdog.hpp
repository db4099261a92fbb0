#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** Watches tasks from its own thread while it exists. It reports a hanging cycle once, and its end, and each change of
 *  a task to RunTimeError and back. It cannot end a cycle. Its priority is above those of tasks with `scheduler: fifo`,
 *  where the system permits it. */
class Watchdog {
public:
    struct Limit {
        TaskContext* task;
        double
            seconds;  ///< How long a cycle may take, without the pauses that it makes itself, see Activity::sleepUntil.
    };
    /** Called with "camera: ..." on the watchdog's thread. */
    using Report = std::function<void(const std::string&)>;

    /** Throws std::runtime_error if there is no thread for it. */
    Watchdog(const std::vector<Limit>& limits, Report report);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

private:
    struct Watched {
        Limit limit;
        int64_t reported = 0;  ///< Start of the hanging cycle that was reported; 0: none [ns].
        bool in_error = false;
    };
    void outrankTasks() const;
    void loop();
    void look(Watched& watched) const;
    void lookForHang(Watched& watched) const;

    std::vector<Watched> watched_;
    Report report_;
    double interval_ = 0.05;  ///< Between two checks [s].
    std::mutex mutex_;
    std::condition_variable wake_;
    bool ending_ = false;
    std::thread thread_;
};

}  // namespace insonify::framework
