#include "components/framework/LeftOut.hpp"

#include <map>

namespace insonify::framework {
namespace {

/** What was lacking, by the beginnings of names. */
std::map<std::string, std::string>& lacking() {
    static std::map<std::string, std::string> all;
    return all;
}

}  // namespace

void leaveOut(const std::string& begin, const std::string& package) { lacking()[begin] = package; }

std::string whyLeftOut(const std::string& type) {
    for (const auto& [begin, package] : lacking())
        if (type.starts_with(begin))
            return ", which is left out of this build: it was made without " + package + ", or told to be without it";
    return {};
}

}  // namespace insonify::framework
