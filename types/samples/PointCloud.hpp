#pragma once
#include <cstddef>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "types/Time.hpp"

namespace insonify::types {

/** Points at one time, field for field Rock's base::samples::Pointcloud.
 *
 *  The colour of a point contains the intensity of its echo, because Rock's type has no other field for it: red, green
 *  and blue are the intensity on the scale of the bins, and alpha is 1. */
struct PointCloud {
    static constexpr const char* type_name = "/base/samples/Pointcloud";
    static constexpr bool shared = true;

    Time time;
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec4> colors;

    void clear() { points.clear(), colors.clear(); }
    void reserve(size_t count) { points.reserve(count), colors.reserve(count); }
    /** Adds a point [m] with the intensity of its echo [1]. */
    void add(const glm::dvec3& point, double intensity) {
        points.push_back(point);
        colors.emplace_back(intensity, intensity, intensity, 1);
    }
    /** Returns the intensity of point k; 0 for points without colours [1]. */
    double intensity(size_t k) const { return colors.empty() ? 0 : colors[k].x; }

    const char* diagnostic() const {
        return colors.empty() || colors.size() == points.size() ? nullptr
                                                                : "has other numbers of points than of colours";
    }
    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the points were true"}, self.time);
        visit({"points", "m", "x, y, z"}, self.points);
        visit({"colors", "1", "red, green, blue, alpha of each point, or none"}, self.colors);
    }
};
using PointCloudPtr = std::shared_ptr<const PointCloud>;

}  // namespace insonify::types
