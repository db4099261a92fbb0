#pragma once
#include <opencv2/core.hpp>
#include <string>

#include "components/output/Colours.hpp"
#include "components/output/LevelScale.hpp"
#include "types/Image.hpp"
#include "types/Sonar.hpp"

namespace insonify::output {

/** Makes `picture` a BGR image of this size and time, and gives a view of its pixels. */
cv::Mat openCanvas(types::Image& picture, cv::Size size, types::Time time);

/** The line of text on top of every picture: time, range, shape, reference level or largest code. Keeps its memory. */
class Title {
public:
    /** Draws on the uppermost rows of `canvas`; what does not fit in its width is left out. */
    void draw(cv::Mat& canvas, const types::Sonar& ping, const LevelScale& scale);

private:
    void add(cv::Mat& canvas);

    std::string text_;
    int column_ = 0;
};

/** Paints the ground of title and picture, and the bar of all colours with its upper left corner at `bar`, where there
 *  is room for it. */
void paintBackground(cv::Mat& canvas, const Palette& palette, cv::Point bar);

/** A picture and a line of text to go below it. */
struct Captioned {
    const types::Image& picture;
    const std::string& caption;
};

/** Two BGR pictures beside each other, with the time of the left one. Fans whose bearings differ by rounding differ in
 *  height: the background fills the rest. */
void sideBySide(const Captioned& left, const Captioned& right, types::Image& picture);

}  // namespace insonify::output
