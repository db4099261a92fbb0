// The component library video: loaded by outputs for their first video; its entry point is in OpenVideo.cpp.
#include "components/loader/Interface.hpp"

INSONIFY_COMPONENT_LIBRARY;
