#pragma once
#include <atomic>

namespace insonify::deployer {

/** Installs the signal handlers and returns the flag that the first SIGINT, SIGTERM or SIGHUP raises, so that a run
 *  stops cleanly; a second signal ends the process. SIGHUP, the end of a terminal, stays ignored where it is. */
const std::atomic<bool>& stopOnSignals();

}  // namespace insonify::deployer
