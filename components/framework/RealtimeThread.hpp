#pragma once
#include <string>
#include <vector>

#include "components/framework/Activity.hpp"

namespace insonify::framework {

/** Gives this thread, and those that it will start, the scheduler, priority and processors of the settings.
 *  Returns what could not be had, and why; empty: all of it was. */
std::vector<std::string> applyToThread(const ActivitySettings& settings);

/** All memory of the process, present and future, stays resident. Empty, or why it cannot: then nothing is locked. */
std::string lockMemory();
void unlockMemory();

}  // namespace insonify::framework
