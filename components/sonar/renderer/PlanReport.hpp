#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/surfaces/Sightlines.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Plan.hpp"
#include "types/text/Notice.hpp"

namespace insonify::sonar {

/** Returns a plan in words, as `insonify plan` prints it, without the device and the predicted error. */
types::Plan report(const RenderPlan& plan, const types::Geometry& geometry);

/** Returns in words what is omitted and why. */
types::Omission describe(const Omitted& what, const BinGrid& grid);

/** Returns a warning if the sonar is outside the depths of its sound speed profile. */
std::optional<types::Notice> depthNotice(const RenderPlan& plan, const types::Snapshot& snapshot);

/** Returns notices about the configuration alone: range reached, water outside a law's validity... */
types::Notices configNotices(const SonarConfig& config);

/** Follows the pings of a sonar and explains why they are empty: once, and again only after ten pings with echoes. */
class PingDiagnostics {
public:
    /** `turn`: pings of one revolution of a turning head [1]. */
    explicit PingDiagnostics(int turn) : turn_(turn) {}

    /** Returns the diagnostic of the renderer's last ping: usually empty, and then nothing is allocated unless the
     * scene has changed. `received`: it has an echo; `coverage`: returns the plan of a sonar that covers in one ping
     * what this sonar covers. */
    std::string follow(bool received, const SonarRenderer& renderer, const types::Snapshot& scene,
                       const types::Sonar& ping, const std::function<RenderPlan()>& coverage);

private:
    static constexpr unsigned between_looks = 16;  ///< Pings between checks of the sonar's surroundings [1].

    int turn_;
    unsigned pings_ = 0;  ///< Pings so far [1].
    bool inside_ = false;
    int silent_ = 0;  ///< Successive pings without any echo [1].
    types::RecurringDiagnostic silence_, enclosure_;
    types::GeometryPtr geometry_;  ///< Geometry of the sightlines.
    std::optional<Sightlines> sightlines_;
};

}  // namespace insonify::sonar
