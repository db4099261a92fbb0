#include "components/framework/LeftOut.hpp"

#include <map>
#include <mutex>

namespace insonify::framework {
namespace {

/** What was lacking, by the beginnings of names. */
struct Lacking {
    std::mutex mutex;
    std::map<std::string, std::string> all;
};

Lacking& lacking() {
    static Lacking lacking;
    return lacking;
}

}  // namespace

void leaveOut(const std::string& begin, const std::string& package) {
    const std::lock_guard lock(lacking().mutex);
    lacking().all[begin] = package;
}

std::string whyLeftOut(const std::string& type) {
    const std::lock_guard lock(lacking().mutex);
    for (const auto& [begin, package] : lacking().all)
        if (type.starts_with(begin))
            return ", which is left out of this build: it was made without " + package + ", or told to be without it";
    return {};
}

}  // namespace insonify::framework
