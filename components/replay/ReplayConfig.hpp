#pragma once
#include <string>

#include "types/Describe.hpp"

namespace insonify::replay {

struct ReplayConfig {
    std::string file;
    double pace = 1;
    double from = 0;
    bool loop = false;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"file", "", "pocolog or MCAP file, relative to the deployment"}, self.file);
        visit(Field{"pace", "1",
                    "recorded seconds per second of the wall clock; 0: one instant of the log each cycle; without "
                    "effect in lockstep, where simulated time follows the log",
                    0, 1e6},
              self.pace);
        visit(Field{"from", "s", "after the log's first stamp, where playing starts", 0, 1e9}, self.from);
        visit(
            Field{"loop", "", "at its end the log goes on from there again, its stamps moved on: time never goes back"},
            self.loop);
    }
};

}  // namespace insonify::replay
