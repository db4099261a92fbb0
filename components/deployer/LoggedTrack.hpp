#pragma once
#include <map>
#include <string>
#include <vector>

#include "components/deployer/Json.hpp"
#include "components/log/Reader.hpp"
#include "types/Mount.hpp"
#include "types/Pose.hpp"
#include "types/Range.hpp"

namespace insonify::deployer {

/** Heights above the bottom over time: the only stream of ranges of a log. */
class LoggedAltitudes {
public:
    explicit LoggedAltitudes(log::Reader& log);

    bool areKnown() const { return !all_.empty(); }
    /** At this time, the last before, or before all of them the first; not finite: unknown. */
    double nearestTo(types::Time time) const;
    /** At this time or the last before; 0: unknown. */
    double at(types::Time time) const;

private:
    std::map<types::Time, double> all_;
};

/** The only stream of poses of a log, or the only one that a sonar writes; null: there is none, or several. */
const log::Stream* posesOfSonar(const log::Reader& log);

/** The mount in the meaning of a stream of pings (StreamMeaning.hpp). */
types::Mount mountOf(const Json& meaning);

/** The sonar in the world over time. */
class LoggedTrack {
public:
    /** @param poses of the sonar, or of its vehicle, which the mount takes to the sonar; null: none is known */
    LoggedTrack(log::Reader& log, const log::Stream* poses, const types::Mount& mount);

    /** At this time or the last before; none is known before the first. */
    types::Pose at(types::Time time) const;

private:
    std::vector<types::Pose> all_;
};

}  // namespace insonify::deployer
