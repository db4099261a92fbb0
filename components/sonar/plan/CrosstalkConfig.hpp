#pragma once
#include <optional>

#include "types/Describe.hpp"

namespace insonify::sonar {

/** How a sonar hears the pulses of others (ACOUSTICS.md 5.29). */
struct CrosstalkConfig {
    bool echoes = true;
    std::optional<double> source_level_db;
    double rejection_db = 40;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"echoes", "", "surfaces scatter the pings of others to this sonar too; false: direct paths alone"},
              self.echoes);
        visit(Field{"source_level_db", "dB re 1 uPa m",
                    "of this sonar, for those that hear it and for what it hears; absent: all are equally loud", -300,
                    400},
              self.source_level_db);
        visit(Field{"rejection_db", "dB", "by which the receiver weakens what is outside its band", 0, 300},
              self.rejection_db);
    }
};

}  // namespace insonify::sonar
