#pragma once
#include <optional>
#include <string>

#include "components/output/DiscImage.hpp"
#include "components/output/ScanMap.hpp"

namespace insonify::output {

/** The pings of a scanning sonar twice, side by side: to the left on the disc of DiscImage, as a head that stands still
 *  would have heard them; to the right on a ScanMap, each where the sonar was and looked when it sounded, north up and
 *  the sonar in the middle. A ping of other bins or range starts both anew. */
class ScanMosaic final : public Painter {
public:
    /** The width is that of both together. */
    explicit ScanMosaic(const DisplayConfig& config);

    /** Where the sonar is in the world at the next ping; nothing: not known, and the map leaves that ping out. False
     *  when there is a pose that ScanMap does not show. */
    bool place(const std::optional<types::Pose>& sonar);
    /** A line of text below the map. */
    void setCaption(const std::string& caption) { caption_ = caption; }

    void paint(const types::Sonar& ping, types::Image& picture) override;
    void skip(const types::Sonar& ping) override;

    /** Of either half. There must have been a picture. */
    const FanLayout& layout() const { return disc_.layout(); }
    /** Pixel of the whole picture that shows a place in the world. There must have been a picture. */
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
    std::optional<types::Pose> sonar_;  ///< At the ping to come.

    uint32_t bin_count_ = 0;
    double range_ = 0;
    std::optional<FanLayout> layout_;
    std::optional<ScanMap> map_;
    std::optional<Overlay> overlay_;
    cv::Mat ground_, levels_;
    types::Image disc_picture_, map_picture_;
};

}  // namespace insonify::output
