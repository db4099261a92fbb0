#pragma once
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <opencv2/core.hpp>
#include <optional>

#include "types/BeamArc.hpp"
#include "types/Pose.hpp"
#include "types/Sonar.hpp"

namespace insonify::output {

/** A map of the world around a sonar, seen from above: north is up, west is left. It goes along with the sonar, cell by
 *  cell, and forgets what it leaves behind; each ping overwrites what was heard before where its beam points.
 *
 *  Echoes are taken to lie in the plane of the sonar's x and y axes: elevation is not known. A beam covers its width,
 *  but no more than the turn since the beam before, so that neighbours do not cover each other's middle. Where beams of
 *  one ping overlap, the nearest centre counts. */
class ScanMap {
public:
    /** @param radius from the middle to each edge [cells]; @param range the same [m]. */
    ScanMap(int radius, double range);

    /** Whether a ping of this pose can be laid: one that is usable and within 1e9 m, the plane of the sonar not on
     *  edge, where nothing of it is seen from above. */
    static bool shows(const types::Pose& sonar);
    /** @param sonar a pose that it shows. */
    void lay(const types::Sonar& ping, const types::Pose& sonar);

    /** Echoes as in the pings, 32-bit floats, NaN where nothing has been heard. */
    const cv::Mat& cells() const { return cells_; }
    double cellSize() const { return cell_; }  ///< [m]
    /** Column and row of a place in the world; whole numbers are the middles of cells. */
    cv::Point2d cellOf(const glm::dvec2& place) const;

private:
    void moveTo(const glm::dvec2& place);
    /** @param part how far the beam reaches from its bearing to either side */
    void layBeam(const float* bins, uint32_t bin_count, double bearing, const types::BeamArc::Reach& part);
    /** Cells that the beam may touch. */
    cv::Rect reach(double bearing, double half_width) const;
    double halfWidth(const types::Sonar& ping, double bearing);

    int radius_;
    double range_, cell_;
    cv::Mat cells_, scratch_, echo_;
    glm::dvec2 middle_{0};            ///< Of the cell in the middle; a multiple of the cell size [m].
    glm::dvec2 sonar_{0};             ///< In the world, of the ping at hand [m].
    glm::dmat2 world_from_plane_{1};  ///< Of the ping at hand.
    std::optional<double> heading_;   ///< In the world, of the beam before [rad].
    types::BeamArc arc_;              ///< The beams of the ping at hand.
};

}  // namespace insonify::output
