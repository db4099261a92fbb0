#pragma once
// What every component library says of itself.
#include <insonify_version.hpp>  // made by the build: INSONIFY_INTERFACE, "0.1.0 5f3a09c1", version and hash of all headers

#define INSONIFY_INTERFACE_MARK "Insonify interface "

/** Stands once in each component library: by it one of another version is refused before any of its code runs. */
#define INSONIFY_COMPONENT_LIBRARY \
    extern "C" __attribute__((used)) const char insonify_interface[] = INSONIFY_INTERFACE_MARK INSONIFY_INTERFACE

namespace insonify::loader {

/** The interface of this Insonify, and what stands before it in a component library. */
inline constexpr const char *interface_version = INSONIFY_INTERFACE, *interface_mark = INSONIFY_INTERFACE_MARK;

}  // namespace insonify::loader
