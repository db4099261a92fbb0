#include "components/ros/Schema.hpp"

#include <algorithm>

namespace insonify::ros {

std::string shortName(const std::string& type_name) {
    const size_t middle = type_name.find("/msg/");
    return type_name.substr(0, middle) + type_name.substr(middle + 4);
}

bool Definitions::add(const std::string& type_name, const std::string& definition) {
    if (std::ranges::count(known_, type_name)) return false;
    known_.push_back(type_name);
    text_ += std::string(80, '=') + "\nMSG: " + shortName(type_name) + "\n" + definition;
    return true;
}

}  // namespace insonify::ros
