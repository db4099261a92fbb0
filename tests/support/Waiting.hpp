#pragma once
// Waiting for other threads and processes, so that no result depends on the speed of the machine.
#include <atomic>
#include <chrono>
#include <thread>

namespace insonify::test {

/** Time that a test waits for an event before it fails. An event ends the wait at once, so this is no measure of speed:
 *  it is far longer than a loaded machine takes. */
constexpr std::chrono::seconds patience{60};

/** Waits until the condition is true; returns false after patience. */
bool becomesTrue(auto&& condition) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

/** Returns whether a count that another thread increments reaches `whole` without pausing for longer than patience. */
inline bool reaches(const std::atomic<int>& count, int whole) {
    while (count < whole)
        if (!becomesTrue([&, before = count.load()] { return count > before; })) return false;
    return true;
}

}  // namespace insonify::test
