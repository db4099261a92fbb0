#pragma once
// Threads of different priorities on one processor.
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

namespace insonify::test {

inline bool useFifo(int priority) {
    const sched_param wanted{priority};
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0;
}

inline int policyOfThis() {
    int policy = -1;
    sched_param parameters{};
    pthread_getschedparam(pthread_self(), &policy, &parameters);
    return policy;
}

inline void useProcessor(int number) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(number, &set);
    pthread_setaffinity_np(pthread_self(), sizeof set, &set);
}

inline void spin(std::chrono::milliseconds time) {
    for (const auto end = std::chrono::steady_clock::now() + time; std::chrono::steady_clock::now() < end;) {
    }
}

/** Runs on one processor a thread with the default scheduling that works until the third waits for it, one of priority
 *  2 that spins for 400 ms, and one of priority 3 that waits for the first. Returns whether the wait ended before the
 *  spinning; none: SCHED_FIFO is not permitted. */
template <class Guarded>
std::optional<bool> urgentIsFirst(Guarded& guarded) {
    std::atomic<bool> works{false}, begun{false}, has_spun{false}, first{false}, permitted{true};
    std::thread worker([&] {
        useProcessor(0);
        guarded.work([&] {
            works = true;
            while (!begun) {
            }
        });
    });
    while (!works) std::this_thread::yield();
    std::thread urgent([&] {
        useProcessor(0);
        if (!useFifo(3)) permitted = false;
        std::thread spinner([&] {
            if (!useFifo(2)) permitted = false;
            spin(std::chrono::milliseconds(400));
            has_spun = true;
        });
        begun = true;  // the spinner runs as soon as this thread waits
        guarded.wait(worker);
        first = !has_spun;
        spinner.join();
    });
    urgent.join();
    worker.join();
    if (!permitted) return std::nullopt;
    return first;
}

}  // namespace insonify::test
