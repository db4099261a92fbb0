#include "components/scene/motion/Animation.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace insonify::scene {
namespace {

/** Makes a quaternion x, y, z, w one of unit length, and its rate the rate of that. */
void normalise(std::span<double> value, std::span<double> rate) {
    double square = 0, along = 0;
    for (size_t i = 0; i < 4; ++i) square += value[i] * value[i], along += value[i] * rate[i];
    const double length = std::sqrt(square);
    if (!(length > 0)) return void(value[3] = 1);
    for (size_t i = 0; i < 4; ++i) {
        rate[i] = (rate[i] - value[i] * along / square) / length;
        value[i] /= length;
    }
}

/** The shorter way from one quaternion to another at a constant rate, over `seconds`. */
void slerp(const double* from, const double* to, double share, double seconds, std::span<double> value,
           std::span<double> rate) {
    constexpr double nearly_same = 1e-6;  // [rad]
    double cosine = 0;
    for (size_t i = 0; i < 4; ++i) cosine += from[i] * to[i];
    const double sign = cosine < 0 ? -1 : 1, angle = std::acos(std::min(1.0, std::abs(cosine))), sine = std::sin(angle);
    const bool is_line = angle < nearly_same;
    const double a = is_line ? 1 - share : std::sin((1 - share) * angle) / sine;
    const double b = is_line ? share : std::sin(share * angle) / sine;
    const double per_a = is_line ? -1 : -angle * std::cos((1 - share) * angle) / sine;
    const double per_b = is_line ? 1 : angle * std::cos(share * angle) / sine;
    for (size_t i = 0; i < 4; ++i) {
        value[i] = a * from[i] + b * sign * to[i];
        rate[i] = (per_a * from[i] + per_b * sign * to[i]) / seconds;
    }
    normalise(value, rate);
}

/** The rate of the rotation matrix of a unit quaternion that changes by `rate`. */
glm::dmat3 rotationRate(const glm::dquat& q, const glm::dquat& rate) {
    const glm::dquat twice = rate * glm::conjugate(q);  // half the angular velocity, in the frame turned into
    const glm::dvec3 turn = 2.0 * glm::dvec3(twice.x, twice.y, twice.z);
    const glm::dmat3 rotation = glm::mat3_cast(q);
    return {glm::cross(turn, rotation[0]), glm::cross(turn, rotation[1]), glm::cross(turn, rotation[2])};
}

}  // namespace

void KeyFrames::at(double time, std::span<double> value, std::span<double> rate) const {
    value = value.first(width);
    rate = rate.first(width);
    const size_t stride = (interpolation == Interpolation::CubicSpline ? 3 : 1) * width;
    const size_t middle = interpolation == Interpolation::CubicSpline ? width : 0;
    const auto next = static_cast<size_t>(std::ranges::upper_bound(times, time) - times.begin());
    std::ranges::fill(rate, 0.0);
    const bool is_before = next == 0, is_behind = next == times.size();
    if (is_before || is_behind || interpolation == Interpolation::Step) {
        const double* const key = &values[(is_before ? 0 : next - 1) * stride + middle];
        std::copy_n(key, width, value.begin());
        if (is_rotation) normalise(value, rate);
        return;
    }
    const double* const from = &values[(next - 1) * stride];
    const double* const to = &values[next * stride];
    const double seconds = times[next] - times[next - 1], s = (time - times[next - 1]) / seconds;
    if (interpolation == Interpolation::Linear) {
        if (is_rotation) return slerp(from, to, s, seconds, value, rate);
        for (size_t i = 0; i < width; ++i) {
            value[i] = from[i] + s * (to[i] - from[i]);
            rate[i] = (to[i] - from[i]) / seconds;
        }
        return;
    }
    const double s2 = s * s, s3 = s2 * s;
    for (size_t i = 0; i < width; ++i) {
        const double p = from[width + i], m = seconds * from[2 * width + i], q = to[width + i], n = seconds * to[i];
        value[i] = (2 * s3 - 3 * s2 + 1) * p + (s3 - 2 * s2 + s) * m + (3 * s2 - 2 * s3) * q + (s3 - s2) * n;
        rate[i] = ((6 * s2 - 6 * s) * (p - q) + (3 * s2 - 4 * s + 1) * m + (3 * s2 - 2 * s) * n) / seconds;
    }
    if (is_rotation) normalise(value, rate);
}

glm::dmat4 NodeShape::matrix() const {
    return glm::scale(glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(rotation), scale);
}

glm::dmat4 NodeShape::matrixRate() const {
    const glm::dmat3 turn = rotationRate(rotation, rotation_rate), held = glm::mat3_cast(rotation);
    glm::dmat4 result(0);
    for (int axis = 0; axis < 3; ++axis)
        result[axis] = glm::dvec4(turn[axis] * scale[axis] + held[axis] * scale_rate[axis], 0);
    result[3] = glm::dvec4(translation_rate, 0);
    return result;
}

}  // namespace insonify::scene
