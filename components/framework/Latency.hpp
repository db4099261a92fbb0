#pragma once
#include "types/Time.hpp"

namespace insonify::framework {

class TaskContext;

/** A sample of that stamp has left the task, by a port or otherwise: in realtime its latency counts, and it is late
 *  after the activity's deadline. On the task's thread. */
void noteLatency(TaskContext& task, types::Time stamp);

}  // namespace insonify::framework
