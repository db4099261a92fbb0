#include "types/geometry/Weld.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace insonify::types {
namespace {

constexpr double noise = 0x1p-22;  ///< Rounding of a coordinate, relative to all coordinates [1].
constexpr double of_edge = 1.0 / 16;
constexpr uint32_t nobody = std::numeric_limits<uint32_t>::max();

/** Returns the median length of the edges, of a sample of at most some thousand [m]. */
double medianEdge(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
    constexpr size_t enough = 4096;
    const size_t triangles = indices.size() / 3, step = std::max<size_t>(1, triangles / enough);
    std::vector<double> lengths;
    for (size_t t = 0; t < triangles; t += step)
        for (size_t k = 0; k < 3; ++k)
            lengths.push_back(glm::distance(glm::dvec3(positions[indices[3 * t + k]]),
                                            glm::dvec3(positions[indices[3 * t + (k + 1) % 3]])));
    if (lengths.empty()) return 0;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::ranges::nth_element(lengths, middle);
    return *middle;
}

/** Returns the distance within which two vertices are at the same place [m]. */
double sameWithin(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const uint32_t index : indices) {
        low = glm::min(low, positions[index]);
        high = glm::max(high, positions[index]);
    }
    if (indices.empty()) return 0;
    const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low),
                     farthest = glm::max(glm::abs(glm::dvec3(low)), glm::abs(glm::dvec3(high)));
    const double extent = std::max({size.x, size.y, size.z}), largest = std::max({farthest.x, farthest.y, farthest.z});
    if (largest <= extent) return noise * extent;
    return std::max(noise * extent, std::min(noise * largest, of_edge * medianEdge(positions, indices)));
}

/** The first vertices of places, by cells of space. */
class Places {
public:
    Places(const std::vector<glm::vec3>& positions, double within)
        : positions_(positions),
          within_(within),
          per_cell_(1 / std::max(cells * within, 1e-30)),
          first_(std::bit_ceil(2 * positions.size() + 1), nobody),
          next_(positions.size(), nobody) {}

    /** Returns the first vertex of the place of a vertex, which becomes one itself where there is none. */
    uint32_t of(uint32_t vertex) {
        const glm::dvec3 at(positions_[vertex]), own = cellOf(at);
        const glm::dvec3 low = cellOf(at - within_), high = cellOf(at + within_);
        uint32_t found = nobody;
        for (int corner = 0; corner < 8; ++corner) {  // at most two cells in each direction
            const bool right = corner & 1, up = corner & 2, on = corner & 4;
            if ((right && high.x == low.x) || (up && high.y == low.y) || (on && high.z == low.z)) continue;
            found = std::min(found, within({right ? high.x : low.x, up ? high.y : low.y, on ? high.z : low.z}, at));
        }
        if (found != nobody) return found;
        uint32_t& head = first_[slot(own)];
        next_[vertex] = head;
        return head = vertex;
    }

private:
    static constexpr double cells = 8;  ///< Side of a cell, in distances of one place [1].

    glm::dvec3 cellOf(const glm::dvec3& at) const { return glm::floor(at * per_cell_); }
    size_t slot(const glm::dvec3& cell) const {
        uint64_t key = 0;
        for (const double number : {cell.x, cell.y, cell.z}) {
            key = (key ^ std::bit_cast<uint64_t>(number + 0.0)) * 0x9e3779b97f4a7c15u;
            key ^= key >> 29;
        }
        return key & (first_.size() - 1);
    }
    uint32_t within(const glm::dvec3& cell, const glm::dvec3& at) const {
        uint32_t lowest = nobody;
        for (uint32_t i = first_[slot(cell)]; i != nobody; i = next_[i]) {
            const glm::dvec3 off = glm::dvec3(positions_[i]) - at;
            if (glm::dot(off, off) <= within_ * within_) lowest = std::min(lowest, i);
        }
        return lowest;
    }

    const std::vector<glm::vec3>& positions_;
    double within_, per_cell_;
    std::vector<uint32_t> first_, next_;  ///< Lists of first vertices of the same slot.
};

}  // namespace

std::vector<uint32_t> weldedPlaces(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
    std::vector<uint32_t> first(positions.size());
    Places places(positions, sameWithin(positions, indices));
    for (uint32_t vertex = 0; vertex < positions.size(); ++vertex) first[vertex] = places.of(vertex);
    return first;
}

}  // namespace insonify::types
