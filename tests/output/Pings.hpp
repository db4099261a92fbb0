#pragma once
// Pings and pictures for the tests of what is shown.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <string>

#include "tests/support/Folder.hpp"
#include "types/Angle.hpp"
#include "types/Image.hpp"
#include "types/Sonar.hpp"

namespace insonify::test {

/** An empty ping of 50 m range whose beams cover `field_of_view_deg` evenly. */
inline types::Sonar emptyPing(double field_of_view_deg, uint32_t beams, uint32_t bins = 100) {
    types::Sonar ping;
    ping.time = types::Time::fromSeconds(1);
    ping.speed_of_sound = 1500;
    ping.bin_duration = {static_cast<int64_t>(50.0 / bins / 1500 * 1e6 + 0.5)};
    ping.beam_count = beams;
    ping.bin_count = bins;
    ping.beam_width = types::Angle::fromDeg(field_of_view_deg / beams);
    for (uint32_t beam = 0; beam < beams; ++beam)
        ping.bearings.push_back(types::Angle::fromDeg(((beam + 0.5) / beams - 0.5) * field_of_view_deg));
    ping.bins.assign(size_t{beams} * bins, 0);
    return ping;
}

inline types::Sonar withEcho(types::Sonar ping, uint32_t beam, uint32_t bin, float value = 1) {
    ping.bins[size_t{beam} * ping.bin_count + bin] = value;
    return ping;
}

inline cv::Mat pixelsOf(const types::Image& picture) {
    return cv::Mat(picture.size.height, picture.size.width, CV_8UC3, const_cast<uint8_t*>(picture.image.data()))
        .clone();
}

/** Centre of gravity of where two pictures differ. */
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
