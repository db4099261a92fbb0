#include "components/python/Arrays.hpp"

#include <pybind11/stl.h>

#include <stdexcept>
#include <utility>

#include "components/output/FanImage.hpp"
#include "types/ConfigError.hpp"

namespace insonify::python {
namespace {

/** Numbers that belong to a sample, which an array keeps alive. */
template <class Number, class Sample>
py::array viewOf(const std::vector<Number>& numbers, std::vector<py::ssize_t> shape,
                 std::shared_ptr<const Sample> owner) {
    auto* const kept = new std::shared_ptr<const Sample>(std::move(owner));
    const py::capsule keeper(kept, [](void* held) { delete static_cast<std::shared_ptr<const Sample>*>(held); });
    py::array_t<Number> array(std::move(shape), numbers.data(), keeper);
    array.attr("flags").attr("writeable") = false;
    return array;
}

std::vector<py::ssize_t> gridOf(const auto& sample) {
    return {static_cast<py::ssize_t>(sample.beam_count), static_cast<py::ssize_t>(sample.bin_count)};
}

}  // namespace

py::array binsOf(const types::SonarPtr& ping) { return viewOf(ping->bins, gridOf(*ping), ping); }

py::array_t<double> bearingsOf(const types::Sonar& ping) {
    py::array_t<double> bearings(static_cast<py::ssize_t>(ping.bearings.size()));
    for (size_t i = 0; i < ping.bearings.size(); ++i) bearings.mutable_data()[i] = ping.bearings[i].rad;
    return bearings;
}

py::array_t<double> rangesOf(const types::Sonar& ping) {
    py::array_t<double> ranges(static_cast<py::ssize_t>(ping.bin_count));
    for (uint32_t k = 0; k < ping.bin_count; ++k) ranges.mutable_data()[k] = ping.binStart(k + 0.5);
    return ranges;
}

py::dict truthOf(const types::SonarTruthPtr& truth) {
    py::dict all;
    types::SonarTruth::forEachArray(*truth, [&](const char* name, const auto& numbers, auto) {
        all[name] = viewOf(numbers, gridOf(*truth), truth);
    });
    all["objects"] = py::cast(truth->objects);
    return all;
}

py::array_t<uint8_t> pixelsOf(const types::Image& picture) {
    const size_t channels = picture.pixel_size;
    if (!picture.holdsPixels() || (channels != 1 && channels != 3))
        throw std::invalid_argument("the picture is compressed, or has no bytes for pixels");
    py::array_t<uint8_t> pixels({py::ssize_t{picture.size.height}, py::ssize_t{picture.size.width}, py::ssize_t{3}});
    uint8_t* to = pixels.mutable_data();
    const bool blue_first = picture.frame_mode == types::ImageMode::Bgr;
    for (size_t row = 0; row < picture.size.height; ++row)
        for (size_t column = 0; column < picture.size.width; ++column)
            for (size_t colour = 0; colour < 3; ++colour) {
                const size_t from = channels == 1 ? 0 : blue_first ? 2 - colour : colour;
                *to++ = picture.image[row * picture.row_size + column * channels + from];
            }
    return pixels;
}

py::array_t<uint8_t> fanOf(const types::Sonar& ping, const output::DisplayConfig& display) {
    types::Diagnostics diagnostics;
    display.check(diagnostics);
    if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
    types::Image picture;
    {
        const py::gil_scoped_release others;
        output::FanImage(display).paint(ping, picture);
    }
    return pixelsOf(picture);
}

types::Pose poseOf(const Numbers& position, const Numbers& orientation) {
    if (position.size() != 3) throw std::invalid_argument("a position has 3 numbers");
    if (orientation.size() != 4) throw std::invalid_argument("an orientation is a quaternion w, x, y, z");
    types::Pose pose;
    const double *p = position.data(), *q = orientation.data();
    pose.position = {p[0], p[1], p[2]};
    pose.orientation = glm::dquat(q[0], q[1], q[2], q[3]);
    return pose;
}

}  // namespace insonify::python
