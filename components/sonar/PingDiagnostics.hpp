#pragma once
#include <functional>
#include <optional>
#include <string>

#include "components/sonar/SonarRenderer.hpp"
#include "components/sonar/places/Sightlines.hpp"
#include "types/RecurringDiagnostic.hpp"

namespace insonify::sonar {

/** Follows the pings of a sonar, and says why there is nothing in them: once, and again only after ten that were well.
 */
class PingDiagnostics {
public:
    /** `geometry` must outlive it. `turn`: pings in which a head comes round [1]. */
    PingDiagnostics(const types::Geometry& geometry, int turn) : turn_(turn) { takeScene(geometry); }
    /** Another geometry from the next ping on, which must outlive it. */
    void takeScene(const types::Geometry& geometry) { sightlines_.emplace(geometry); }

    /** What is to be told of a ping; usually nothing, for which nothing is allocated. `heard`: it has an echo;
     *  `coverage`: the plan of a sonar that looks where this one does. */
    std::string follow(bool heard, Model model, const types::Snapshot& scene, const types::Sonar& ping,
                       const std::function<RenderPlan()>& coverage);

private:
    static constexpr unsigned between_looks = 16;  ///< Pings from one look at what is around the sonar to the next [1].

    int turn_;
    unsigned pings_ = 0;  ///< So far [1].
    bool inside_ = false;
    int silent_ = 0;  ///< Pings without any echo, one after the other [1].
    types::RecurringDiagnostic silence_, enclosure_;
    std::optional<Sightlines> sightlines_;
};

}  // namespace insonify::sonar
