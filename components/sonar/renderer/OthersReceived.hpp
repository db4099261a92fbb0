#pragma once
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** The pulses of other sonars that one sonar has received messages of, kept while they may arrive at it. */
class OthersReceived {
public:
    static constexpr double memory = 10;         ///< Time for which a pulse is kept: sound travels 15 km [s].
    static constexpr double longest_ping = 200;  ///< Max time for which a ping waits for pulses [s].

    /** Also forgets pulses that are far from it in time: a sonar that does not ping asks for none. */
    void add(types::TransmissionPtr sent) {
        if (!sent || !sent->radiation) return;
        if (sent_.size() >= look_at_) {
            std::erase_if(sent_, [newest = sent->time](const auto& other) {
                return std::abs((newest - other->time).seconds()) > memory + longest_ping;
            });
            look_at_ = 2 * sent_.size() + 64;
        }
        sent_.push_back(std::move(sent));
    }
    size_t size() const { return sent_.size(); }  ///< Pulses that are kept [1].
    void clear() { sent_.clear(); }

    /** Gives a snapshot the pulses from which sound may arrive within the range of its sonar, and forgets old pulses.
     *  @param range  of the sonar [m]
     *  @param speed_of_sound  [m/s] */
    void give(types::Snapshot& scene, double range, double speed_of_sound) {
        std::erase_if(sent_, [&](const auto& sent) {
            const double age = (scene.time - sent->time).seconds();
            return age > memory || age < -longest_ping;
        });
        scene.transmissions.clear();
        for (const auto& sent : sent_) {
            const double half = glm::distance(sent->sonar.position, scene.sonar.position) / 2,
                         offset = speed_of_sound * (sent->time - scene.time).seconds() / 2;
            if (offset + half <= range && offset + half + range >= 0) scene.transmissions.push_back(sent);
        }
    }

private:
    std::vector<types::TransmissionPtr> sent_;
    size_t look_at_ = 64;  ///< Number of pulses at which add() looks for old ones [1].
};

}  // namespace insonify::sonar
