#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "types/Describe.hpp"

namespace insonify::logger {

struct LoggerConfig {
    std::string file;
    double flush_period = 1;
    int queue = 64;
    std::map<std::string, std::string> metadata;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"file", "", "log to write, relative to --out: NAME.0.log; an old one is replaced"}, self.file);
        visit(Field{"flush_period", "s", "at most this much is lost when the process is killed", 0.001, 1},
              self.flush_period);
        visit(Field{"queue", "1", "samples that may wait for the file beyond those in the ports' buffers", 1, 65536},
              self.queue);
        visit(Field{"metadata", "", "keys and values that every stream of the log carries"}, self.metadata);
    }
    void check(types::Problems& problems) const {
        const std::filesystem::path path(file);
        if (path.extension() != ".log" || path.stem().empty())
            problems.push_back(
                {"file", "is '" + file + "'; it must be a file name that ends in .log, as in harbour.0.log"});
    }
};

}  // namespace insonify::logger
