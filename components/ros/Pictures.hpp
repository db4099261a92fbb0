#pragma once
#include <string>

#include "components/ros/SensorMessages.hpp"
#include "types/Image.hpp"

namespace insonify::ros {

/** Converts a picture to sensor_msgs/Image: grey of 8 or 16 bits, RGB, BGR. Throws std::invalid_argument for other
 *  modes, and for a picture without the pixels that it announces. */
void convert(const types::Image& picture, const std::string& frame_id, Image& message);

/** Converts back, for the same encodings. */
void convert(const Image& message, types::Image& picture);

}  // namespace insonify::ros
