#pragma once
#include <string>

namespace insonify::framework {

/** Tells that this build has no task types whose names begin so, for want of a package when it was built. For one
 *  thread, before deployments are made. */
void leaveOut(const std::string& begin, const std::string& package);

/** ", which is left out of this build: ..." for such a type, else empty. */
std::string whyLeftOut(const std::string& type);

}  // namespace insonify::framework
