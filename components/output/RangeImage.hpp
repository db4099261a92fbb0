#pragma once
#include <opencv2/core.hpp>

#include "components/output/Chart.hpp"
#include "types/DepthMap.hpp"
#include "types/Image.hpp"

namespace insonify::output {

/** A map of distances as it is seen from the sonar: port is left, up is up, the nearest return brightest; black where
 *  there is none. Cells are square and as large as fit; labels give the angles of the outermost. */
class RangeImage {
public:
    using Sample = types::DepthMapPtr;
    static constexpr const char* port = "range_image";

    RangeImage(uint32_t width, ColourMap colour_map) : chart_(width, colour_map) {}

    void add(const types::DepthMapPtr& map) { map_ = map; }
    /** @param picture becomes a BGR image, 8 bits a channel, with the map's time. Its memory is used again.
     *  Throws std::runtime_error for a map that has other numbers of distances than it says. */
    void paint(types::Image& picture);
    void clear() { map_.reset(); }

    /** The part of the last picture that shows cells. */
    const cv::Rect& cells() const { return chart_.area(); }

private:
    /** Of the returns [m]; equal without any. */
    struct Span {
        float nearest = 0, farthest = 0;
    };
    Span spanOf(const types::DepthMap& map) const;
    void drawCells(cv::Mat& canvas, const types::DepthMap& map, const Span& span) const;
    void drawLabels(cv::Mat& canvas, const types::DepthMap& map, const Span& span) const;

    Chart chart_;
    types::DepthMapPtr map_;
};

}  // namespace insonify::output
