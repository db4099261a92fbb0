#include "types/NamedFile.hpp"

#include <algorithm>

namespace insonify::types {
namespace {

namespace fs = std::filesystem;

/** Returns a path without links; empty: it cannot be resolved, as with a circle of links. */
fs::path resolved(const fs::path& path) {
    std::error_code failed;
    const fs::path whole = fs::absolute(path, failed);
    const fs::path real = failed ? fs::path() : fs::weakly_canonical(whole, failed);
    return failed ? fs::path() : real;
}

/** Returns the folder of the model or ROS package that contains a folder; the folder itself: neither does. */
fs::path getModel(const fs::path& folder) {
    std::error_code none;
    fs::path at = folder;
    for (int level = 0; level <= 3 && at.has_relative_path(); ++level, at = at.parent_path())
        if (fs::is_regular_file(at / "model.config", none) || fs::is_regular_file(at / "package.xml", none)) return at;
    return folder;
}

}  // namespace

bool isBelow(const fs::path& path, const fs::path& folder) {
    const fs::path inner = resolved(path), outer = resolved(folder);
    if (inner.empty() || outer.empty()) return false;
    const auto last = outer.filename().empty() ? std::prev(outer.end()) : outer.end();  // "/", or a folder that is none
    return std::mismatch(outer.begin(), last, inner.begin(), inner.end()).first == last;
}

bool belongsTo(const fs::path& named, const fs::path& naming) {
    std::error_code failed;
    const fs::path folder = resolved(fs::absolute(naming, failed).parent_path()), own = resolved(naming).parent_path();
    const auto isIn = [&](const fs::path& each) { return !each.empty() && isBelow(named, getModel(each)); };
    return isIn(folder) || isIn(own);  // the file's place, and that of the file that it links to
}

}  // namespace insonify::types
