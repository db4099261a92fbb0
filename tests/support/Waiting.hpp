#pragma once
// Waiting for what other threads and processes do, so that no verdict depends on how fast or how evenly a machine runs.
#include <atomic>
#include <chrono>
#include <thread>

namespace insonify::test {

/** How long a test waits for what does not come before it fails. What comes ends the wait at once, so this is no
 *  measure of speed: it is far beyond what a loaded machine takes. */
constexpr std::chrono::seconds patience{60};

/** Waits until the condition holds; false where patience has run out. */
template <class Condition>
bool comesTrue(Condition&& condition) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

/** Whether a count that another thread raises reaches `whole` without standing still for longer than patience. */
inline bool reaches(const std::atomic<int>& count, int whole) {
    while (count < whole)
        if (!comesTrue([&, before = count.load()] { return count > before; })) return false;
    return true;
}

}  // namespace insonify::test
