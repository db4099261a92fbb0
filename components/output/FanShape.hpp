#pragma once
#include <cstdint>
#include <opencv2/core.hpp>

#include "types/BeamArc.hpp"

namespace insonify::output {

/** What of a ping decides where its bins go in the picture. */
struct FanShape : types::BeamArc {
    uint32_t bin_count = 0;
    double range = 0;  ///< Far edge of the last bin [m].

    static FanShape of(const types::Sonar& ping);
    /** The greatest angle from ahead, of at least `least` and at most half a turn [rad]. */
    static double halfAngle(double right, double left, double least);
};

/** Where a fan of the given edges lies in a picture: ahead is up, port is left. */
class FanLayout {
public:
    /** @param width of the picture [px]; an odd one is made even. @param left may exceed pi, across +-180 degrees. */
    FanLayout(int width, double right, double left, double range);

    cv::Size size() const { return size_; }
    cv::Point2d origin() const { return origin_; }  ///< Pixel coordinates of the sonar.
    double radius() const { return radius_; }       ///< Of the far edge [px].
    double range() const { return range_; }         ///< [m]
    double right() const { return right_; }         ///< [rad]
    double left() const { return left_; }           ///< [rad]
    /** Pixel coordinates of a point at `range` [m] and `bearing` [rad, positive to port]. */
    cv::Point2d pixel(double range, double bearing) const;

    static constexpr int title_height = 30;

private:
    cv::Size size_;
    cv::Point2d origin_;
    double radius_, range_, right_, left_;
};

}  // namespace insonify::output
