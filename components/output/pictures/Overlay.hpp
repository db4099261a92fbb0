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
     *  text on echoes is darkened. */
    void text(const std::string& text, cv::Point2d at, Anchor anchor, bool degrees = false, bool on_echoes = false);
    /** From here on, text that would touch this area is omitted. */
    void take(const cv::Rect& area) { taken_ = area; }
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
    cv::Rect taken_;
    std::vector<cv::Rect> plates_;
    std::vector<Touch> touched_;
};

/** Draws range rings labelled in metres and spokes labelled in degrees, positive to port.
 *  @param taken where no label is drawn [px] */
Overlay fanOverlay(const FanLayout& layout, const cv::Rect& taken = {});

inline const cv::Size colour_bar_size{12, 128};
inline const cv::Size labelled_bar_size{54, 136};  ///< With the labels.

/** Returns `at` if the colour bar fits there, next to the fan; else a place outside of the picture. */
cv::Point placeOfBar(const FanLayout& layout, cv::Point at);

/** Returns whether the colour bar with its upper left corner at `at` fits in a picture of this size. */
bool fitsColourBar(cv::Size picture, cv::Point at);

/** Labels the colour bar at `at` with levels relative to the brightest; draws nothing if the bar does not fit. */
void addColourBar(Overlay& overlay, cv::Point at, const DisplayConfig& display);

/** Returns a round step (1, 2 or 5 times a power of ten) not below `least`. */
double roundStep(double minimum);

}  // namespace insonify::output
