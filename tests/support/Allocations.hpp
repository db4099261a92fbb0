#pragma once
// Counts calls of operator new. A test binary that uses this compiles tests/support/Allocations.cpp, which replaces
// operator new for the whole process, shared libraries included.
#include <string>
#include <utility>
#include <vector>

#include "components/framework/TaskContext.hpp"
#include "components/framework/execution/Activity.hpp"

namespace insonify::test {

/** Starts or stops counting the calling thread's calls of operator new. */
void countHere(bool on);

/** Returns the calls counted since the last call of this function: "object+offset" of the code that made each, at most
 *  64. */
std::vector<std::string> takeCounted();

/** Returns the calls of operator new on a task's thread while `work` runs on the test's thread. */
template <class Work>
std::vector<std::string> allocationsOn(framework::TaskContext& task, Work&& work) {
    takeCounted();
    task.activity().call([] { countHere(true); });
    std::forward<Work>(work)();
    task.activity().call([] { countHere(false); });
    return takeCounted();
}

/** Returns the calls of operator new in cycles 2 to 99, after a first cycle. */
std::vector<std::string> allocationsAfterTheFirst(framework::TaskContext& task, const auto& cycle) {
    cycle(1);
    return allocationsOn(task, [&] {
        for (int64_t time = 2; time < 100; ++time) cycle(time);
    });
}

}  // namespace insonify::test
