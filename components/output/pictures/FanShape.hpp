#pragma once
#include <cstdint>
#include <opencv2/core.hpp>

#include "types/geometry/BeamArc.hpp"

namespace insonify::output {

/** The properties of a ping that determine where its bins are in the picture. */
struct FanShape : types::BeamArc {
    uint32_t bin_count = 0;
    double range = 0;  ///< Far edge of the last bin [m].

    static FanShape of(const types::Sonar& ping);
    /** Returns the max angle from ahead, at least `least` and at most half a turn [rad]. */
    static double halfAngle(double right, double left, double minimum);
};

/** The layout of a fan with given edges in a picture: ahead is up, port is left. */
class FanLayout {
public:
    /** @param width of the picture [px]; an odd width is rounded up to even
     *  @param left may exceed pi, across +-180 degrees */
    FanLayout(int width, double right, double left, double range);

    cv::Size size() const { return size_; }
    cv::Point2d origin() const { return origin_; }  ///< Pixel coordinates of the sonar.
    double radius() const { return radius_; }       ///< Radius of the far edge [px].
    double range() const { return range_; }         ///< [m]
    double right() const { return right_; }         ///< [rad]
    double left() const { return left_; }           ///< [rad]
    /** Returns the pixel coordinates of a point at `range` [m] and `bearing` [rad, positive to port]. */
    cv::Point2d pixel(double range, double bearing) const;
    /** Returns whether the fan has a pixel in an area. */
    bool reaches(const cv::Rect& area) const;

    static constexpr int title_height = 30;

private:
    cv::Size size_;
    cv::Point2d origin_;
    double radius_, range_, right_, left_;
};

}  // namespace insonify::output
