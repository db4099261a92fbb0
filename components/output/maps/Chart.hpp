#pragma once
#include <opencv2/core.hpp>

#include "components/output/pictures/Colours.hpp"
#include "components/output/pictures/Overlay.hpp"
#include "types/samples/Image.hpp"

namespace insonify::output {

/** A picture of one rectangle, with a title above it, a colour bar of lengths to its left and labels around it. */
class Chart {
public:
    /** @param width of the picture [px]; an odd width is rounded up to even */
    Chart(uint32_t width, ColourMap colour_map);

    int columns() const { return width_ - left_margin - right_margin; }  ///< Width of the rectangle [px].
    /** Clamps the rows of the rectangle: at least what the colour bar needs, at most `tallest` times the columns
     *  [px]. */
    int rowsFor(double rows, double tallest) const;
    /** Makes `picture` an image of that time with a black rectangle of `rows` rows; returns a view of its pixels. */
    cv::Mat open(types::Image& picture, types::Time time, int rows);
    const cv::Rect& area() const { return area_; }  ///< The rectangle in the last picture.
    /** Returns the colour of a level, clamped to 0 (darkest) to 255. */
    const cv::Vec3b& colour(double level) const;
    /** Labels the bar's colours with lengths in even steps [m]. */
    static void labelBar(Overlay& overlay, double top, double bottom);
    /** Draws the title above the rectangle. */
    static void addTitle(Overlay& overlay, const std::string& text);

    static constexpr int left_margin = 96, right_margin = 16, top_margin = 10, bottom_margin = 34;
    static const cv::Point colour_bar;  ///< Upper left corner.

private:
    int width_;
    Palette palette_;
    cv::Rect area_;
};

}  // namespace insonify::output
