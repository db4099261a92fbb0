#pragma once
#include <cstdint>
#include <vector>

#include "components/ros/Options.hpp"
#include "components/ros/SensorMessages.hpp"
#include "types/Sonar.hpp"

namespace insonify::viewer {

/** Draws pings as sensor_msgs/Image, mono8: the fan as seen from above, ahead is up and port is left. A pixel shows the
 *  strongest of the echoes that it covers, as a level of components/ros/Pings.hpp; 0 is no echo, and outside the fan.
 *
 *  A table maps pixels to bins until bearings, widths, bins or range change. */
class FanPicture {
public:
    static constexpr uint32_t longest_side = 720;  ///< [px]

    /** Throws std::invalid_argument for a ping whose lists do not match its counts, and std::out_of_range for a time
     *  that ROS cannot represent. */
    void draw(const types::Sonar& ping, const ros::SonarOptions& options, ros::Image& message);

private:
    /** The bins of one beam that a pixel covers. */
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
