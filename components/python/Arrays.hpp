#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "components/output/PictureConfig.hpp"
#include "types/Image.hpp"
#include "types/Pose.hpp"
#include "types/Sonar.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::python {
namespace py = pybind11;

/** Bins [beams, bins], float32: the ping's own memory, which stays as long as the array does. Not to be written to. */
py::array binsOf(const types::SonarPtr& ping);
/** Bearing of each beam [rad], positive to port. */
py::array_t<double> bearingsOf(const types::Sonar& ping);
/** Slant range at the middle of each bin [m]. */
py::array_t<double> rangesOf(const types::Sonar& ping);
/** What is told of each bin, [beams, bins], by its name in the truth; the truth's own memory. */
py::dict truthOf(const types::SonarTruthPtr& truth);
/** Pixels [height, width, 3], uint8, red first. */
py::array_t<uint8_t> pixelsOf(const types::Image& picture);
/** The ping as a fan. Throws types::ConfigError for what no picture can be. */
py::array_t<uint8_t> fanOf(const types::Sonar& ping, const output::DisplayConfig& display);

/** Numbers one after the other, whatever the array of the caller is. */
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/** A pose of three numbers and a quaternion w, x, y, z. */
types::Pose poseOf(const Numbers& position, const Numbers& orientation);

}  // namespace insonify::python
