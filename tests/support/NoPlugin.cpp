#include "components/loader/Interface.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" int insonify_something_else() { return 0; }
