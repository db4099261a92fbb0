#pragma once
#include <map>
#include <vector>

#include "components/deployer/Json.hpp"
#include "components/log/Reader.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::deployer {

/** Removes the damaged samples of a stream, and prints which; throws as log::Reader::dropDamaged. */
void dropDamaged(log::Reader& log, const std::string& stream);

/** Altitudes above the bottom over time, from the only stream of ranges of a log. */
class LoggedAltitudes {
public:
    explicit LoggedAltitudes(log::Reader& log);

    bool areKnown() const { return !all_.empty(); }
    /** Returns the altitude at this time or the last before; before the first, the first. Not finite: unknown. */
    double nearestTo(types::Time time) const;
    /** Returns the altitude at this time or the last before; 0: unknown. */
    double at(types::Time time) const;

private:
    std::map<types::Time, double> all_;
};

/** Returns the only stream of poses of a log, or the only one that a sonar writes. Null: there is none, or several. */
const log::Stream* posesOfSonar(const log::Reader& log);

/** Returns the mount in the metadata of a stream of pings (Export.hpp). */
types::Mount findMount(const Json& meaning);

/** The sonar's pose in the world over time. */
class LoggedTrack {
public:
    /** @param poses of the sonar, or of its vehicle, which the mount transforms to the sonar; null: unknown */
    LoggedTrack(log::Reader& log, const log::Stream* poses, const types::Mount& mount);

    /** Returns the pose at this time or the last before; unknown before the first. */
    types::Pose at(types::Time time) const;

private:
    std::vector<types::Pose> all_;
};

}  // namespace insonify::deployer
