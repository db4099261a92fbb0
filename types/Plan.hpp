#pragma once
#include <string>
#include <vector>

namespace insonify::types {

/** Something that is not simulated, and the reason or bound that allows it. */
struct Omission {
    std::string name;
    std::string reason;
};

/** What a sonar compiles and runs for its scene, decided once; the answer of `insonify plan`. */
struct Plan {
    std::vector<std::string> features;  ///< Compiled into the shaders.
    std::vector<std::string> passes;    ///< Run for each ping, in order.
    std::vector<Omission> omitted;
    std::vector<std::string> notices;  ///< Warnings and choices that a user should know of, a sentence each.
    int rows = 0;                      ///< Image rows over the elevation aperture [1].
    int columns_per_beam = 0;          ///< [1]
    int slabs = 0;                     ///< Perspective images that make up the fan [1].
    double predicted_error = 0;        ///< rel_l2_tvg; NaN: not predicted [1].
};

}  // namespace insonify::types
