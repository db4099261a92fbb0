// A library that needs a symbol that does not exist.
#include "components/framework/Registry.hpp"
#include "components/loader/Interface.hpp"

INSONIFY_COMPONENT_LIBRARY;

void neverWritten();

extern "C" void insonify_register(insonify::framework::Registry&) { neverWritten(); }
