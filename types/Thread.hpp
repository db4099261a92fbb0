#pragma once
#include <pthread.h>
#include <sched.h>

#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace insonify::types {

/** Remembers the process in which it was made, for objects that own threads: threads do not follow a fork, so that a
 *  forked child would wait for them for ever. */
class OwnProcess {
public:
    OwnProcess();

    /** Whether this is a child that was forked after the object was made. */
    bool isForked() const;
    /** Throws std::runtime_error with the remedy if isForked(); `what` is the subject of its sentence. */
    void require(const char* what) const;

private:
    unsigned generation_;
};

/** Throws std::runtime_error: there is no thread for `what`, with the limits that may be the reason. */
[[noreturn]] void throwNoThread(const std::string& what, const std::system_error& refused);

/** Starts a thread. Throws std::runtime_error that names `what` if the system permits no more threads. */
template <class Work>
std::thread startThread(const std::string& what, Work&& work) {
    try {
        return std::thread(std::forward<Work>(work));
    } catch (const std::system_error& refused) {
        throwNoThread(what, refused);
    }
}

/** Gives this thread the default scheduling of the system. A thread that a realtime task starts has the task's priority
 *  otherwise, and delays it on its own processor. The permitted processors stay. */
void useDefaultScheduling();

/** Lends the scheduling of this thread to another one, for which it waits; then the other has the default scheduling.
 *  Without effect where this thread has no realtime priority. */
class LentScheduling {
public:
    explicit LentScheduling(std::thread& other);
    ~LentScheduling();
    LentScheduling(const LentScheduling&) = delete;
    LentScheduling& operator=(const LentScheduling&) = delete;

private:
    std::thread& other_;
    bool is_lent_ = false;
};

/** A std::mutex whose owner runs at the highest priority of the threads that wait for it (PTHREAD_PRIO_INHERIT). So a
 *  realtime thread waits only while the mutex is held, never for threads with a priority between its own and the
 *  owner's. */
class PriorityMutex : public std::mutex {
public:
    PriorityMutex();
};

}  // namespace insonify::types
