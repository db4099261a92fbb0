#pragma once
#include <atomic>

namespace insonify::deployer {

/** From now on the first SIGINT or SIGTERM raises the flag that is returned, so that a run stops cleanly; a second one
 *  ends the process. A file that grows over the process's limit is an error of the write, not a signal. */
const std::atomic<bool>& stopOnSignals();

}  // namespace insonify::deployer
