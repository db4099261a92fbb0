#pragma once
#include <array>
#include <opencv2/core.hpp>

#include "components/output/tasks/PictureConfig.hpp"

namespace insonify::output {

/** Blue, green and red of each of the 256 levels. */
using Palette = std::array<cv::Vec3b, 256>;
Palette paletteOf(ColourMap map);

inline const cv::Scalar background{26, 19, 14};  ///< The background's blue, green, red.
inline const cv::Scalar title_ground{44, 33, 25};
inline const cv::Vec3b ink{226, 220, 210};  ///< Lines and text.

}  // namespace insonify::output
