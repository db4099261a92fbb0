#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/gazebo/Poses.hpp"

namespace insonify::gazebo {

/** Finds what has come into a world, or gone from it, after its scene was taken: by the names in its poses. */
class WorldWatch {
public:
    /** `taken` are the names that the scene knows; none: it is not of Gazebo, and those of the first message count. */
    explicit WorldWatch(std::optional<std::set<std::string>> taken)
        : known_(taken.value_or(std::set<std::string>())), is_taken_(taken.has_value()) {}

    struct Change {
        std::vector<std::string> came, went;
        bool isEmpty() const { return came.empty() && went.empty(); }
    };
    /** What has changed with this message; each name is reported once. */
    Change take(const PoseMessage& message);

private:
    std::set<std::string> known_;
    std::set<std::string> present_;        ///< In the message before.
    std::vector<std::string> last_names_;  ///< Names in the message before, in its order.
    std::set<std::string> reported_;
    bool is_taken_;
};

}  // namespace insonify::gazebo
