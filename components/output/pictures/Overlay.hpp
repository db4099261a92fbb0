#pragma once
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "components/output/pictures/FanShape.hpp"
#include "components/output/tasks/PictureConfig.hpp"

namespace insonify::output {

/** Lines and text on top of every picture. They are drawn once and then blended only where they cover anything. */
class Overlay {
public:
    explicit Overlay(cv::Size size) : size_(size), cover_(size, CV_8U, cv::Scalar(0)) {}

    enum class Anchor { Left, Centre, Right };
    void line(cv::Point2d from, cv::Point2d to, int opacity);
    void arc(cv::Point2d centre, double radius, double right, double left, int opacity);
    /** Draws text whose middle line runs through `at`, which is its left end, centre or right end; the picture below
     *  text on echoes is darkened. Text that would leave the picture is moved inside, on echoes; text that would touch
     *  earlier text is omitted. */
    void text(const std::string& text, cv::Point2d at, Anchor anchor, bool degrees = false, bool on_echoes = false);
    /** From here on, text that would touch this area is omitted. */
    void take(const cv::Rect& area) { taken_.push_back(area); }
    const std::vector<cv::Rect>& taken() const { return taken_; }  ///< Texts and other areas, in order [px].
    /** Must be called after all drawing. */
    void finish();
    void blend(cv::Mat& picture) const;
    cv::Size size() const { return size_; }

private:
    struct Touch {
        int row, column;
        uint8_t opacity;
    };
    cv::Size size_;
    cv::Mat cover_;
    std::vector<cv::Rect> taken_, plates_;
    std::vector<Touch> touched_;
};

/** Makes the lines and labels of a fan: range rings in metres, spokes in degrees, positive to port, and the labels of a
 *  colour bar with its upper left corner at `bar`, unless that is outside of the picture. */
Overlay fanOverlay(const FanLayout& layout, cv::Point bar, const DisplayConfig& display);

inline const cv::Size colour_bar_size{12, 128};

/** Returns the area of the colour bar at `at` with its labels [px]. */
cv::Rect labelledBar(cv::Point at, const DisplayConfig& display);

/** Returns the upper left corner of a colour bar in the first corner of the picture where bar and labels are next to
 * the fan; a place outside of the picture if there is none. */
cv::Point placeOfBar(const FanLayout& layout, const DisplayConfig& display);

/** Returns whether the colour bar with its upper left corner at `at` fits in a picture of this size. */
bool fitsColourBar(cv::Size picture, cv::Point at);

/** Labels the colour bar at `at` with levels relative to the brightest; draws nothing if the bar does not fit. */
void addColourBar(Overlay& overlay, cv::Point at, const DisplayConfig& display);

/** Returns a round step (1, 2 or 5 times a power of ten) not below `minimum`. */
double roundStep(double minimum);
/** Returns the round step not below `minimum` of an axis from 0 to `end`; at most `end`. */
double roundStep(double minimum, double end);

/** Returns the width of text in the font of labels [px]. */
int measureWidth(const std::string& text);
/** Writes text in the font of labels from the lower left corner `at` on, without its last letters where it is wider
 * than `width` [px]. */
void putLabel(cv::Mat& picture, const std::string& text, cv::Point at, int width);

}  // namespace insonify::output
