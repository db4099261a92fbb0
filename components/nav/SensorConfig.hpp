#pragma once
#include <cstdint>
#include <optional>

#include "types/Mount.hpp"

namespace insonify::nav {

/** The configuration that all sensors share: mount, period of measurements, and seed of the errors. */
struct SensorConfig {
    types::Mount mount{};
    std::optional<uint64_t> seed = {};  ///< None: 1. A deployment gives each task its own seed.
    double period = 0;

    uint64_t randomSeed() const { return seed.value_or(1); }

    /** Describes the keys of all sensors, with a sensor's descriptions of its mount and its period. */
    static void describe(auto& self, auto& visit, const char* mount, const char* period) {
        visit({"mount", "", mount}, self.mount);
        visit({"seed", "1",
               "of the random numbers: the same seed and poses give the same errors; absent: a hash of the "
               "deployment's seed and the task's name"},
              self.seed);
        visit({"period", "s", period, 0, 1e6}, self.period);
    }
};

}  // namespace insonify::nav
