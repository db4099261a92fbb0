// A component library for another version, which ends the process if any of its code runs.
#include <cstdlib>

#include "components/framework/Registry.hpp"
#include "components/loader/Interface.hpp"

extern "C" __attribute__((used)) const char insonify_interface[] = INSONIFY_INTERFACE_MARK "0.0.9 00000000";

namespace {

[[maybe_unused]] const bool has_run = (std::abort(), true);

}  // namespace

extern "C" void insonify_register(insonify::framework::Registry&) {}
