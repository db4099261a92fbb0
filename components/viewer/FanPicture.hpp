#pragma once
#include <cstdint>
#include <vector>

#include "components/ros/Options.hpp"
#include "components/ros/SensorMessages.hpp"
#include "types/Sonar.hpp"

namespace insonify::viewer {

/** Pings as sensor_msgs/Image, mono8: the fan as seen from above, ahead is up and port is left; a pixel has the
 * strongest of the echoes that it covers, as the levels of components/ros/Pings.hpp; 0 is no echo, and outside of
 * the fan.
 *
 *  Where each pixel's echoes are is tabled, and kept until bearings, widths, bins or range change. */
class FanPicture {
public:
    static constexpr uint32_t longest_side = 720;  ///< [px]

    /** std::invalid_argument for a ping that is not well shaped, std::out_of_range for a time that ROS cannot hold. */
    void draw(const types::Sonar& ping, const ros::SonarOptions& options, ros::Image& message);

private:
    /** Bins of one beam that a pixel covers. */
    struct Covered {
        uint32_t first = 0, count = 0;  ///< Index into the bins of a ping; 0: none.
    };
    bool fits(const types::Sonar& ping) const;
    void build(const types::Sonar& ping);

    std::vector<types::Angle> bearings_;
    types::Angle beam_width_;
    uint32_t bin_count_ = 0;
    double bin_m_ = 0;
    uint32_t width_ = 0, height_ = 0;
    std::vector<Covered> table_;
};

}  // namespace insonify::viewer
