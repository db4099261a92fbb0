#pragma once
// What poses and readings share: what is not known of them, and covariances in other axes.
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace insonify::ros {

inline bool isUnknown(glm::dvec3 v) { return std::isnan(v.x) || std::isnan(v.y) || std::isnan(v.z); }
inline bool isUnknown(const glm::dmat3& m) { return isUnknown(m[0]) || isUnknown(m[1]) || isUnknown(m[2]); }

/** A covariance, whose columns are vectors, where `turn` turns a vector: C becomes A C A^T. */
template <class Turn>
glm::dmat3 both(const glm::dmat3& covariance, Turn&& turn) {
    const auto columns = [&](const glm::dmat3& m) { return glm::dmat3(turn(m[0]), turn(m[1]), turn(m[2])); };
    return columns(glm::transpose(columns(covariance)));
}

}  // namespace insonify::ros
