#pragma once
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** The pulses of other sonars that one sonar has received messages of, kept while they may arrive at it. */
class OthersReceived {
public:
    static constexpr double memory = 10;  ///< Time for which a pulse is kept: sound travels 15 km [s].

    /** Keeps a pulse, and forgets pulses that are too old, or from before the clock was set back. */
    void add(types::TransmissionPtr sent) {
        if (!sent || !sent->radiation) return;
        forget(sent->time);
        sent_.push_back(std::move(sent));
    }
    void clear() { sent_.clear(); }

    /** Gives a snapshot the pulses from which sound may arrive within the range of its sonar, and forgets old pulses.
     *  @param range  of the sonar [m]
     *  @param speed_of_sound  [m/s] */
    void give(types::Snapshot& scene, double range, double speed_of_sound) {
        forget(scene.time);
        scene.transmissions.clear();
        for (const auto& sent : sent_) {
            const double half = glm::distance(sent->sonar.position, scene.sonar.position) / 2,
                         offset = speed_of_sound * (sent->time - scene.time).seconds() / 2;
            if (offset + half <= range && offset + half + range >= 0) scene.transmissions.push_back(sent);
        }
    }

private:
    void forget(types::Time now) {
        std::erase_if(sent_, [&](const auto& sent) { return std::abs((now - sent->time).seconds()) > memory; });
    }

    std::vector<types::TransmissionPtr> sent_;
};

}  // namespace insonify::sonar
