#pragma once
#include <fmt/format.h>

#include <map>
#include <set>
#include <string>

namespace insonify::scene {

/** Makes names unique: the second "buoy" becomes "buoy_2". */
class UniqueNames {
public:
    /** Returns a name that no other has. @param is_given whether the file states it, for describeRenamed() */
    std::string add(const std::string& name, bool is_given = true) {
        std::string unique = name;
        while (!names_.insert(unique).second) unique = fmt::format("{}_{}", name, ++repeats_[name] + 1);
        if (is_given && unique != name && ++renamed_ == 1) first_ = name + " is " + unique;
        return unique;
    }
    /** Returns "2 nodes have the name of another and get a number: buoy is buoy_2"; empty: there are none. */
    std::string describeRenamed() const {
        if (renamed_ == 0) return "";
        return fmt::format("{} {} the name of another and {} a number: {}", renamed_,
                           renamed_ == 1 ? "node has" : "nodes have", renamed_ == 1 ? "gets" : "get", first_);
    }

private:
    std::set<std::string> names_;
    std::map<std::string, size_t> repeats_;
    size_t renamed_ = 0;
    std::string first_;  ///< The first that was renamed.
};

}  // namespace insonify::scene
