#pragma once
#include <optional>
#include <string>

#include "components/output/maps/ScanMap.hpp"
#include "components/output/pictures/FanImage.hpp"

namespace insonify::output {

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
