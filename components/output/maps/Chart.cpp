#include "components/output/maps/Chart.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/output/pictures/Canvas.hpp"
#include "components/output/pictures/FanShape.hpp"

namespace insonify::output {

const cv::Point Chart::colour_bar{10, FanLayout::title_height + 24};

Chart::Chart(uint32_t width, ColourMap colour_map)
    : width_(static_cast<int>(width + width % 2)), palette_(paletteOf(colour_map)) {}

int Chart::rowsFor(double rows, double tallest) const {
    return static_cast<int>(std::clamp(rows, colour_bar_size.height + 40.0, tallest * columns()));
}

cv::Mat Chart::open(types::Image& picture, types::Time time, int rows) {
    area_ = {left_margin, FanLayout::title_height + top_margin, columns(), rows};
    cv::Mat canvas = openCanvas(picture, {width_, area_.br().y + bottom_margin}, time);
    paintBackground(canvas, palette_, colour_bar);
    canvas(area_).setTo(cv::Scalar(0, 0, 0));
    return canvas;
}

const cv::Vec3b& Chart::colour(double level) const {
    return palette_[static_cast<size_t>(std::clamp(level, 0.0, 255.0))];
}

void Chart::labelBar(Overlay& overlay, double top, double bottom) {
    for (int i = 0; i <= 4; ++i) {
        const double y = colour_bar.y + i / 4.0 * (colour_bar_size.height - 1);
        overlay.text(fmt::format("{:.2f} m", top + i / 4.0 * (bottom - top)),
                     {colour_bar.x + colour_bar_size.width + 5.0, y}, Overlay::Anchor::Left);
    }
}

void Chart::addTitle(Overlay& overlay, const std::string& text) {
    overlay.text(text, {12, FanLayout::title_height / 2.0}, Overlay::Anchor::Left);
}

}  // namespace insonify::output
