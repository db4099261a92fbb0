#pragma once
#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "components/output/pictures/LevelScale.hpp"
#include "components/output/pictures/Overlay.hpp"
#include "components/output/tasks/PictureConfig.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::output {

/** Blue, green and red of each of the 256 levels. */
using Palette = std::array<cv::Vec3b, 256>;
Palette getPalette(ColourMap map);

inline const cv::Scalar background{26, 19, 14};  ///< The background's blue, green, red.
inline const cv::Scalar title_ground{44, 33, 25};
inline const cv::Vec3b ink{226, 220, 210};  ///< Lines and text.

/** Makes `picture` a BGR image of this size and time; returns a view of its pixels. */
cv::Mat openCanvas(types::Image& picture, cv::Size size, types::Time time);

/** The line of text on top of every picture: time, range, shape, speed of sound, and reference level or max code.
 * Reuses its memory. */
class Title {
public:
    /** Draws on the top rows of `canvas`. Where it is too narrow, first the speed of sound is omitted, then the shape,
     *  then the range. */
    void draw(cv::Mat& canvas, const types::Sonar& ping, const LevelScale& scale);

private:
    std::array<std::string, 5> texts_;
};

/** Paints the background of title and picture, and the colour bar with its upper left corner at `bar`, if it fits. */
void paintBackground(cv::Mat& canvas, const Palette& palette, cv::Point bar);

/** A picture and the line of text below it. */
struct Captioned {
    const types::Image& picture;
    const std::string& caption;
};

/** Draws two BGR pictures side by side, with the time of the left picture and a strip of captions below. Fans whose
 *  bearings differ by rounding differ in height: the background fills the rest. */
void sideBySide(const Captioned& left, const Captioned& right, types::Image& picture);

/** A picture of one rectangle, with a title above it, a colour bar of lengths to its right and labels around it. */
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
    /** Labels the bar's colours with round lengths between those of its top and bottom [m]. */
    void labelBar(Overlay& overlay, double top, double bottom) const;
    /** Draws the parts of the title above the rectangle, as many as fit, the first ones first. */
    static void addTitle(Overlay& overlay, const std::vector<std::string>& parts);

    static constexpr int left_margin = 64, right_margin = 92, top_margin = 10, bottom_margin = 34;

private:
    cv::Point bar() const { return {width_ - right_margin + 10, FanLayout::title_height + 24}; }

    int width_;
    Palette palette_;
    cv::Rect area_;
};

}  // namespace insonify::output
