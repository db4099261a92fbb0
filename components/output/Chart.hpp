#pragma once
#include <opencv2/core.hpp>

#include "components/output/Colours.hpp"
#include "components/output/Overlay.hpp"
#include "types/Image.hpp"

namespace insonify::output {

/** A picture of one rectangle, with a line of text above it, a colour bar of lengths to its left and labels around. */
class Chart {
public:
    /** @param width of the picture [px]; an odd one is made even. */
    Chart(uint32_t width, ColourMap colour_map);

    int columns() const { return width_ - left_margin - right_margin; }  ///< Of the rectangle [px].
    /** Rows for a rectangle that has as many as this, as far as they are not fewer than the colour bar needs, nor more
     *  than `tallest` times the columns [px]. */
    int rowsFor(double rows, double tallest) const;
    /** Makes `picture` an image of that time with a black rectangle of so many rows, and gives a view of its pixels. */
    cv::Mat open(types::Image& picture, types::Time time, int rows);
    const cv::Rect& area() const { return area_; }  ///< The rectangle in the last picture.
    /** The colour of a level from 0, the darkest, to 255, beyond which it is that of the end. */
    const cv::Vec3b& colour(double level) const;
    /** The lengths that the bar's colours mean, in even steps [m]. */
    static void labelBar(Overlay& overlay, double top, double bottom);
    /** The line of text above the rectangle. */
    static void addTitle(Overlay& overlay, const std::string& text);

    static constexpr int left_margin = 96, right_margin = 16, top_margin = 10, bottom_margin = 34;
    static const cv::Point colour_bar;  ///< Its upper left corner.

private:
    int width_;
    Palette palette_;
    cv::Rect area_;
};

}  // namespace insonify::output
