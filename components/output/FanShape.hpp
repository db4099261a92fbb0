#pragma once
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "types/Sonar.hpp"

namespace insonify::output {

/** The beams of a ping in order of bearing: what of a ping decides where its bins go in the picture. */
struct FanShape {
    std::vector<double> bearings;  ///< Ascending: from starboard to port [rad].
    std::vector<uint32_t> beams;   ///< The ping's beam at each of these bearings.
    double right = 0, left = 0;    ///< Outer edges of the first and the last beam [rad].
    uint32_t bin_count = 0;
    double range = 0;  ///< Far edge of the last bin [m].

    /** Beams of unknown bearing are left out; edges lie half a beam width beyond the outermost centres (where the
     *  width is unknown, half the distance to the neighbour). */
    static FanShape of(const types::Sonar& ping);
    bool fullCircle() const;
    /** Beam, counted in order of bearing, that a bearing falls on: between two centres a fraction [1]. */
    double beamAt(double bearing) const;
};

/** Where a fan of the given edges lies in a picture: ahead is up, port is left. */
class FanLayout {
public:
    /** @param width of the picture [px]; an odd one is made even. */
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
