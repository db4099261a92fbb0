#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Deployment.hpp"
#include "components/framework/DeploymentSpec.hpp"
#include "components/log/Reader.hpp"

namespace insonify::deployer {

/** The seed that a log was recorded with; none when that is not known. */
std::optional<uint64_t> recordedSeed(const log::Reader& log);

/** A property of a task from which pings come, as it was while the log was recorded. */
struct RecordedProperty {
    std::string task, name;
    std::string start;   ///< When playing starts, as a setter takes it.
    std::string driver;  ///< The stream that makes the pings, see poseStreamOf.
    struct Change {
        types::Time from;  ///< Stamp of the first ping for which it held.
        std::string value;
    };
    std::vector<Change> changes;  ///< While the log was recorded, in order.
};

/** What the tasks from which a log's pings come were set to and the deployment does not say. */
struct RecordedSettings {
    std::vector<std::string> assignments;   ///< When playing starts, as `--set` takes them.
    std::vector<RecordedProperty> changed;  ///< Those that changed while it was recorded.
    std::string notice;                     ///< What is not known; empty: nothing.
};

/** The settings that the log of properties beside a log tells, see log::propertyLogOf, and each sonar's quality as its
 *  plan tells. Not of what `set` names.
 *  @param seed given for this run; none: the log's.
 *  @param from after the log's first stamp, where playing starts [s]. */
RecordedSettings recordedSettings(const log::Reader& log, const framework::DeploymentSpec& spec,
                                  const std::vector<std::string>& set, std::optional<uint64_t> seed, double from);

/** A value or an assignment for a notice: each list of more than eight numbers as "256 values, -30 to 30". */
std::string withShortLists(const std::string& text);

/** Sets properties, between two instants of a replay, to what they were for the next ping. */
class LiveSettings {
public:
    explicit LiveSettings(std::vector<RecordedProperty> changed)
        : changed_(std::move(changed)), applied_(changed_.size(), 0) {}
    bool empty() const { return changed_.empty(); }
    /** Throws what a setter throws. */
    void follow(framework::Deployment& deployment);

private:
    std::vector<RecordedProperty> changed_;
    std::vector<size_t> applied_;  ///< How many of the changes of each hold.
};

}  // namespace insonify::deployer
