// A library without the line INSONIFY_COMPONENT_LIBRARY.
#include "components/framework/Registry.hpp"

extern "C" void insonify_register(insonify::framework::Registry&) {}
