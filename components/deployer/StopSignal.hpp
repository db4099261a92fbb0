#pragma once
#include <atomic>

namespace insonify::deployer {

/** Installs the signal handlers and returns the flag that the first SIGINT or SIGTERM raises, so that a run stops
 *  cleanly; a second signal ends the process. */
const std::atomic<bool>& stopOnSignals();

}  // namespace insonify::deployer
