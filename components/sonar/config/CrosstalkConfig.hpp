#pragma once
#include <optional>

#include "types/Describe.hpp"

namespace insonify::sonar {

/** Reception of the pulses of other sonars (ACOUSTICS.md 5.29). */
struct CrosstalkConfig {
    bool echoes = true;
    std::optional<double> source_level_db;
    double rejection_db = 40;

    static void describe(auto& self, auto& visit) {
        visit({"echoes", "", "surfaces scatter the pings of others to this sonar too; false: direct paths only"},
              self.echoes);
        visit({"source_level_db", "dB re 1 uPa m",
               "of this sonar, both as a source and as the reference for what it receives; absent: all sonars "
               "have equal levels",
               -300, 400},
              self.source_level_db);
        visit({"rejection_db", "dB", "attenuation of the receiver outside its band", 0, 300}, self.rejection_db);
    }
};

}  // namespace insonify::sonar
