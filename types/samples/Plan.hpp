#pragma once
#include <string>
#include <vector>

#include "types/text/Describe.hpp"
#include "types/text/Notice.hpp"

namespace insonify::types {

/** Something that is not simulated, and the reason or bound that allows it. */
struct Omission {
    std::string name;
    std::string reason;
    bool not_configured = false;  ///< Whether it is omitted because nothing asks for it.

    static void describe(auto& self, auto& visit) {
        visit({"name", "", "what is not simulated"}, self.name);
        visit({"reason", "", "reason or bound that allows it"}, self.reason);
    }
};

/** The plan of a sonar for its scene: features, passes and omissions, decided once. `insonify plan` prints it. */
struct Plan {
    std::vector<std::string> features;  ///< Features that are compiled into the renderer.
    std::vector<std::string> passes;    ///< Passes that run for each ping, in order.
    std::vector<Omission> omitted;
    Notices notices;             ///< Warnings and choices that a user should know, a sentence each.
    int rows = 0;                ///< Rows of samples over the elevation aperture [1].
    int columns_per_beam = 0;    ///< [1]
    int slabs = 0;               ///< Perspective images that make up the fan; 0: rays [1].
    double predicted_error = 0;  ///< rel_l2_tvg; NaN: not predicted [1].
    std::string device;          ///< The device that renders, with its driver; empty before the first ping.

    /** Describes what is written; notices cannot be read back. */
    static void describe(auto& self, auto& visit) {
        visit({"features", "", "compiled into what renders"}, self.features);
        visit({"passes", "", "run for each ping, in order"}, self.passes);
        visit({"omitted", "", "what is omitted, and why"}, self.omitted);
        auto lines = types::lines(self.notices);
        visit({"notices", "", "warnings and choices"}, lines);
        visit({"rows", "1", "rows of samples over the elevation aperture"}, self.rows);
        visit({"columns_per_beam", "1", "columns of samples"}, self.columns_per_beam);
        visit({"slabs", "1", "perspective images that make up the fan; 0: rays"}, self.slabs);
        visit({"predicted_error", "1", "rel_l2_tvg; NaN: not predicted"}, self.predicted_error);
        visit({"device", "", "what renders, with its driver"}, self.device);
    }
};

}  // namespace insonify::types
