#pragma once
// The version that every component library contains.
#include <insonify_version.hpp>  // made by the build: INSONIFY_INTERFACE, "0.1.0 5f3a09c1", version and hash of all headers

#define INSONIFY_INTERFACE_MARK "Insonify interface "

/** Must be in each component library exactly once: a library of another version is refused before its code runs. */
#define INSONIFY_COMPONENT_LIBRARY \
    extern "C" __attribute__((used)) const char insonify_interface[] = INSONIFY_INTERFACE_MARK INSONIFY_INTERFACE

namespace insonify::loader {

/** The interface of this Insonify, and the mark in front of it in a component library. */
inline constexpr const char *interface_version = INSONIFY_INTERFACE, *interface_mark = INSONIFY_INTERFACE_MARK;

}  // namespace insonify::loader
