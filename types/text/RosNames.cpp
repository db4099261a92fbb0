#include "types/text/RosNames.hpp"

#include <algorithm>

#include "types/text/DidYouMean.hpp"

namespace insonify::types {
namespace {

bool isRosWord(std::string_view word) {
    const auto fits = [](char c) { return isLetter(c) || isDigit(c) || c == '_'; };
    return !word.empty() && !isDigit(word[0]) && std::ranges::all_of(word, fits);
}

/** Returns the name with that of the node in place of a leading "~". */
std::string withNode(const std::string& name, const std::string& node) {
    if (!name.starts_with('~')) return name;
    return (node.starts_with('/') ? "" : "/") + node + name.substr(1);
}

}  // namespace

bool isRosName(std::string_view name) {
    if (name.starts_with('/')) name.remove_prefix(1);
    for (size_t slash = name.find('/'); slash != name.npos && isRosWord(name.substr(0, slash)); slash = name.find('/'))
        name.remove_prefix(slash + 1);
    return isRosWord(name);
}

std::string prefixed(const std::string& prefix, const std::string& name) {
    return prefix.empty() || name.starts_with(prefix) ? name : prefix + name;
}

bool RosNames::setNamespace(const std::string& text) {
    if (!text.empty() && text != "/" && !isRosName(text)) return false;
    ros_namespace = text.empty() || text == "/" ? "" : "/" + text.substr(text.starts_with('/'));
    return true;
}

bool RosNames::setFramePrefix(std::string text) {
    if (text.ends_with('/')) text.pop_back();
    if (!text.empty() && (text.starts_with('/') || !isRosName(text))) return false;
    frame_prefix = text.empty() ? "" : text + "/";
    return true;
}

std::string RosNames::expanded(const std::string& name) const {
    return name.starts_with('/') ? name : ros_namespace + "/" + name;
}

std::string RosNames::topic(const std::string& name, const std::string& node) const {
    if (ros_namespace.empty() && remaps.empty()) return withNode(name, node);
    const auto resolved = [&](const std::string& each) { return expanded(withNode(each, node)); };
    const std::string whole = resolved(name), last_word = node.substr(node.rfind('/') + 1);
    for (const TopicRemap& remap : remaps)
        if ((remap.node.empty() || remap.node == last_word) && resolved(remap.from) == whole) return resolved(remap.to);
    return whole;
}

std::string RosNames::node(const std::string& name) const { return ros_namespace.empty() ? name : expanded(name); }

}  // namespace insonify::types
