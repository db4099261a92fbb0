#pragma once
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "components/sonar/EchoRules.hpp"
#include "components/sonar/RenderPlan.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** How the sonar of one ping lies in the water. */
struct WaterView {
    glm::dvec3 up{0, 0, 1};  ///< The world's z in sonar axes, unit [1].
    double height = 0;       ///< Of the sonar above the water surface, or above the world's z = 0 [m].
};
WaterView waterViewOf(const types::Snapshot& snapshot);

/** The same up in the axes of a frustum. */
glm::dvec3 upwardIn(const ViewFrustum& frustum, const WaterView& water);

struct Cells;
struct Covered;
struct EchoSums;
/** Adds to the sums what cells hide of the volume, or the layers of it up to where they end. */
void hideVolume(const EchoRules& rules, const WaterView& water, const Cells& cells, const Covered& covered,
                const EchoSums& to);

/** The layers of a configuration as EchoRules::layers has them; none where there is one without bounds. */
std::vector<double> layersOf(const SonarConfig& config);

/** Solid angle of each of a plan's azimuth cells within its aperture, weighted by the pattern in elevation [sr]. */
std::vector<double> openSolidAngles(const RenderPlan& plan);

/** Intensity of the water itself, from the solid angle in which it is heard (ACOUSTICS.md 3.9). */
class VolumeLevels {
public:
    /** `grid`: of the bins that are filled. */
    VolumeLevels(const RenderPlan& plan, const BinGrid& grid);

    /** Adds it to the bins of a cell. `changes`: in quanta of `unit` [sr], of each bin. Allocates nothing. */
    void add(const uint64_t* changes, size_t cell, double unit, std::span<float> bins) const;

private:
    std::vector<double> open_;  ///< Of each cell where nothing hides it [sr]; 0 with layers, which tell it themselves.
    std::vector<double> intensity_;  ///< Of each bin, for a steradian [1/sr].
};

}  // namespace insonify::sonar
