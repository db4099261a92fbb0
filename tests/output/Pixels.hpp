#pragma once
// Pixels of pictures, for tests.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "components/output/tasks/PictureConfig.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Pings.hpp"
#include "types/samples/Image.hpp"

namespace insonify::test {

/** Returns gray on a fixed scale, so that a pixel's value is its level. */
template <class Config = output::DisplayConfig>
Config grayPicture(uint32_t width) {
    Config config;
    config.width = width;
    config.reference_db = 0;
    config.colour_map = output::ColourMap::Gray;
    return config;
}

inline cv::Mat toPixels(const types::Image& picture) {
    return cv::Mat(picture.size.height, picture.size.width, CV_8UC3, const_cast<uint8_t*>(picture.image.data()))
        .clone();
}

/** Returns the green of a pixel. */
inline int levelAt(const types::Image& picture, cv::Point at) { return toPixels(picture).at<cv::Vec3b>(at)[1]; }

/** Returns the centre of gravity of the difference of two pictures. */
inline cv::Point2d centreOfDifference(const cv::Mat& a, const cv::Mat& b) {
    double sum = 0;
    cv::Point2d moment;
    for (int y = 0; y < a.rows; ++y)
        for (int x = 0; x < a.cols; ++x) {
            const double weight = cv::norm(a.at<cv::Vec3b>(y, x), b.at<cv::Vec3b>(y, x), cv::NORM_L1);
            sum += weight;
            moment += weight * cv::Point2d(x, y);
        }
    return moment / sum;
}

}  // namespace insonify::test
