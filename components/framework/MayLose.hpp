#pragma once
#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** Returns whether a task that cannot write its file drops and counts samples instead of ending the run. This is so in
 *  realtime by the wall clock, where the other tasks cannot wait. Valid from startHook on. */
inline bool mayLose(const Environment& run) { return run.deployment && !run.lockstep && run.wall_clock; }

}  // namespace insonify::framework
