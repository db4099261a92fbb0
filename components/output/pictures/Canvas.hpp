#pragma once
#include <opencv2/core.hpp>
#include <string>

#include "components/output/pictures/Colours.hpp"
#include "components/output/pictures/LevelScale.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::output {

/** Makes `picture` a BGR image of this size and time; returns a view of its pixels. */
cv::Mat openCanvas(types::Image& picture, cv::Size size, types::Time time);

/** The line of text on top of every picture: time, range, shape, and reference level or max code. Reuses its memory. */
class Title {
public:
    /** Draws on the top rows of `canvas`; text that exceeds its width is omitted. */
    void draw(cv::Mat& canvas, const types::Sonar& ping, const LevelScale& scale);

private:
    void add(cv::Mat& canvas);

    std::string text_;
    int column_ = 0;
};

/** Paints the background of title and picture, and the colour bar with its upper left corner at `bar`, if it fits. */
void paintBackground(cv::Mat& canvas, const Palette& palette, cv::Point bar);

/** A picture and the line of text below it. */
struct Captioned {
    const types::Image& picture;
    const std::string& caption;
};

/** Draws two BGR pictures side by side, with the time of the left picture. Fans whose bearings differ by rounding
 *  differ in height: the background fills the rest. */
void sideBySide(const Captioned& left, const Captioned& right, types::Image& picture);

}  // namespace insonify::output
