#pragma once
#include <opencv2/core.hpp>

#include "components/output/pictures/Canvas.hpp"
#include "types/samples/DepthMap.hpp"
#include "types/samples/Image.hpp"

namespace insonify::output {

/** Draws a distance map as seen from the sonar: port is left, up is up, the nearest return is brightest; black without
 *  a return. Cells are square and as large as possible; labels give round angles, positive to port and up. */
class RangeImage {
public:
    using Sample = types::DepthMapPtr;
    static constexpr const char* port = "range_image";

    RangeImage(uint32_t width, ColourMap colour_map) : chart_(width, colour_map) {}

    void add(const types::DepthMapPtr& map) { map_ = map; }
    /** @param picture becomes a BGR image, 8 bits a channel, with the map's time; its memory is reused
     *  Throws std::runtime_error for a map whose lists do not match its counts. */
    void paint(types::Image& picture);
    void clear() { map_.reset(); }

    /** The part of the last picture that shows cells. */
    const cv::Rect& cells() const { return chart_.area(); }

private:
    /** Min and max of the returns [m]; equal without returns. */
    struct Span {
        float nearest = 0, farthest = 0;
    };
    Span getSpan(const types::DepthMap& map) const;
    void drawCells(cv::Mat& canvas, const types::DepthMap& map, const Span& span) const;
    void addAngles(Overlay& overlay, const types::DepthMap& map) const;
    void drawLabels(cv::Mat& canvas, const types::DepthMap& map, const Span& span) const;

    Chart chart_;
    types::DepthMapPtr map_;
};

}  // namespace insonify::output
