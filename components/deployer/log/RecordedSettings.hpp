#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Deployment.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
#include "components/log/Reader.hpp"

namespace insonify::deployer {

/** Returns the seed that a log was recorded with; none: unknown. */
std::optional<uint64_t> recordedSeed(const log::Reader& log);

/** Sets the properties of a log's deployment to those at the log's first sample, by the property log next to it. A
 *  damaged one is reported, and sets nothing. */
void setRecorded(const log::Reader& log, framework::DeploymentSpec& spec);

/** A property of a task that contributes to pings, with its values while the log was recorded. */
struct RecordedProperty {
    std::string task, name;
    std::string start;   ///< When the replay starts, as a setter takes it.
    std::string driver;  ///< The stream that triggers the pings, see poseStream.
    struct Change {
        types::Time from;  ///< Stamp of the first ping with this value.
        std::string value;
    };
    std::vector<Change> changes;  ///< While the log was recorded, in order.
};

/** Settings of the tasks that contribute to a log's pings, as far as they differ from the deployment. */
struct RecordedSettings {
    std::vector<std::string> assignments;   ///< When the replay starts, as `--set` takes them.
    std::vector<RecordedProperty> changed;  ///< Properties that changed while the log was recorded.
    std::string notice;                     ///< What is unknown; empty: nothing.
};

/** Returns the settings in the property log next to a log, see log::propertyLog, and each sonar's quality from its
 *  plan. Properties that `set` names are omitted.
 *  @param seed given for this run; none: the log's.
 *  @param from start of the replay after the log's first stamp [s]. */
RecordedSettings recordedSettings(const log::Reader& log, const framework::DeploymentSpec& spec,
                                  const std::vector<std::string>& set, std::optional<uint64_t> seed, double from);

/** Returns a value or an assignment for a notice, with each list of more than eight numbers as "256 values, -30 to
 *  30". */
std::string withShortLists(const std::string& text);

/** Sets properties, between two instants of a replay, to their values for the next ping. */
class LiveSettings {
public:
    explicit LiveSettings(std::vector<RecordedProperty> changed)
        : changed_(std::move(changed)), applied_(changed_.size(), 0) {}
    bool empty() const { return changed_.empty(); }
    /** Throws the exceptions of the setters. */
    void follow(framework::Deployment& deployment);

private:
    std::vector<RecordedProperty> changed_;
    std::vector<size_t> applied_;  ///< The number of changes applied, for each property.
};

}  // namespace insonify::deployer
