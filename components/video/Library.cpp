// The component library video: what an output loads with the first video; its entry is in OpenVideo.cpp.
#include "components/loader/Interface.hpp"

INSONIFY_COMPONENT_LIBRARY;
