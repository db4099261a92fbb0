#pragma once
// Counts calls of operator new. A test binary that uses this has tests/support/Allocations.cpp among its sources, which
// replaces operator new for the whole process, shared libraries included.
#include <string>
#include <utility>
#include <vector>

#include "components/framework/Activity.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::test {

/** From now on the calling thread's calls of operator new are counted, or no longer. */
void countHere(bool on);

/** The calls counted since this was called last: "object+offset" of the code that made each, at most 64 of them. */
std::vector<std::string> takeCounted();

/** The calls of operator new on a task's thread while `work` runs on the test's. */
template <class Work>
std::vector<std::string> allocationsOn(framework::TaskContext& task, Work&& work) {
    takeCounted();
    task.activity().call([] { countHere(true); });
    std::forward<Work>(work)();
    task.activity().call([] { countHere(false); });
    return takeCounted();
}

/** The same of the cycles 2 to 99, after a first one. */
template <class Cycle>
std::vector<std::string> allocationsAfterTheFirst(framework::TaskContext& task, const Cycle& cycle) {
    cycle(1);
    return allocationsOn(task, [&] {
        for (int64_t time = 2; time < 100; ++time) cycle(time);
    });
}

}  // namespace insonify::test
