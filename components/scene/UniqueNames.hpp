#pragma once
#include <fmt/format.h>

#include <map>
#include <set>
#include <string>

namespace insonify::scene {

/** Makes names unique: the second "buoy" becomes "buoy_2". */
class UniqueNames {
public:
    std::string add(const std::string& name) {
        std::string unique = name;
        while (!names_.insert(unique).second) unique = fmt::format("{}_{}", name, ++repeats_[name] + 1);
        return unique;
    }

private:
    std::set<std::string> names_;
    std::map<std::string, size_t> repeats_;
};

}  // namespace insonify::scene
