#pragma once
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "components/output/pictures/FanImage.hpp"
#include "types/geometry/BeamArc.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::output {

/** A map of the world around a sonar, seen from above: north is up, west is left. It moves with the sonar cell by cell
 *  and forgets cells outside. Each ping overwrites the cells in its beam.
 *
 *  Echoes are placed in the plane of the sonar's x and y axes, because elevation is unknown. A beam covers its width,
 *  but at most the turn since the previous beam, so that neighbours do not cover each other's middle. Where beams of
 *  one ping overlap, the nearest centre counts. */
class ScanMap {
public:
    /** @param radius from the middle to each edge [cells]; @param range the same [m]. */
    ScanMap(int radius, double range);

    /** Returns whether a ping at this pose can be shown. The pose must be usable and within 1e9 m, and the sonar's
     *  plane not edge-on as seen from above. */
    static bool shows(const types::Pose& sonar);
    /** @param sonar a pose for which shows() is true */
    void lay(const types::Sonar& ping, const types::Pose& sonar);

    /** Echoes of the pings, 32-bit floats; NaN where there was no ping. */
    const cv::Mat& cells() const { return cells_; }
    /** Returns column and row of a place in the world; whole numbers are the middles of cells. */
    cv::Point2d findCell(const glm::dvec2& place) const;

private:
    void moveTo(const glm::dvec2& place);
    /** @param part the beam's extent from its bearing to either side */
    void layBeam(const float* bins, uint32_t bin_count, double bearing, const types::BeamArc::Reach& part);
    /** Returns the cells that the beam may touch. */
    cv::Rect reach(double bearing, double half_width) const;
    double halfWidth(const types::Sonar& ping, double bearing);

    int radius_;
    double range_, cell_;
    cv::Mat cells_, scratch_, echo_;
    glm::dvec2 middle_{0};            ///< Place of the middle cell; a multiple of the cell size [m].
    glm::dvec2 sonar_{0};             ///< Place of the present ping in the world [m].
    glm::dmat2 world_from_plane_{1};  ///< Axes of the present ping.
    std::optional<double> heading_;   ///< Heading of the previous beam in the world [rad].
    types::BeamArc arc_;              ///< The beams of the present ping.
};

/** Draws the pings of a scanning sonar twice, side by side. Left: on the disc of DiscImage, as if the head did not
 *  move. Right: on a ScanMap, each at the sonar's pose at its time, north up and the sonar in the middle. A ping with
 *  other bins or range restarts both. */
class ScanMosaic final : public Painter {
public:
    /** The width is that of both pictures together. */
    explicit ScanMosaic(const DisplayConfig& config);

    /** Sets the sonar's pose in the world at the next ping; none if unknown: the map omits that ping. Returns false for
     *  a pose that ScanMap cannot show. */
    bool place(const std::optional<types::Pose>& sonar);
    /** Sets the line of text below the map. */
    void setCaption(const std::string& caption) { caption_ = caption; }

    void paint(const types::Sonar& ping, types::Image& picture) override;
    void skip(const types::Sonar& ping) override;

    /** Returns the layout of either half. A picture must have been drawn. */
    const FanLayout& layout() const { return disc_.layout(); }
    /** Returns the pixel of the whole picture that shows a place in the world. A picture must have been drawn. */
    cv::Point2d pixel(const glm::dvec2& place) const;

private:
    void lay(const types::Sonar& ping);
    void build(const types::Sonar& ping);
    void drawMap(const types::Sonar& ping);

    DisplayConfig half_;
    DiscImage disc_;
    Palette palette_;
    LevelScale scale_;
    Title title_;
    std::string caption_;
    std::optional<types::Pose> sonar_;  ///< Pose at the next ping.

    uint32_t bin_count_ = 0;
    double range_ = 0;
    std::optional<FanLayout> layout_;
    std::optional<ScanMap> map_;
    std::optional<Overlay> overlay_;
    cv::Mat ground_, levels_;
    types::Image disc_picture_, map_picture_;
};

}  // namespace insonify::output
