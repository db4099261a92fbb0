#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/gazebo/Poses.hpp"

namespace insonify::gazebo {

/** Finds entities that have appeared in a world, or disappeared, since its scene was read, by the names in its
 *  poses. */
class WorldWatch {
public:
    /** `taken` are the names in the scene; none: the scene is not from Gazebo, and the names of the first message
     *  count. */
    explicit WorldWatch(std::optional<std::set<std::string>> taken)
        : known_(taken.value_or(std::set<std::string>())), is_taken_(taken.has_value()) {}

    struct Change {
        std::vector<std::string> came, went;
        bool isEmpty() const { return came.empty() && went.empty(); }
    };
    static constexpr size_t max_reported = 1000;  ///< Names that are reported at most, however long a run is.
    /** Returns the changes of this message; each name is reported once. */
    Change take(const PoseMessage& message);

private:
    std::set<std::string> known_;
    std::set<std::string> present_;        ///< Names in the previous message.
    std::vector<std::string> last_names_;  ///< Names in the previous message, in its order.
    std::set<std::string> reported_;
    bool is_taken_;
};

}  // namespace insonify::gazebo
