#pragma once
// A hilly floor of many triangles, and the processor time of the thread that works on it.
#include <cmath>
#include <ctime>
#include <utility>
#include <vector>

#include "tests/support/Scenes.hpp"

namespace insonify::test {

/** A hilly floor of `cells` x `cells` squares of two triangles each, from -600 to 1200 m on both axes, one cluster. */
inline types::Mesh hills(int cells) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (int i = 0; i <= cells; ++i)
        for (int k = 0; k <= cells; ++k) {
            const double x = -600 + 1800.0 * i / cells, y = -600 + 1800.0 * k / cells;
            positions.emplace_back(x, y, -20 + 3 * std::sin(0.031 * x) * std::cos(0.023 * y));
        }
    const auto at = [cells](int i, int k) { return static_cast<uint32_t>(i * (cells + 1) + k); };
    for (int i = 0; i < cells; ++i)
        for (int k = 0; k < cells; ++k)
            indices.insert(indices.end(),
                           {at(i, k), at(i + 1, k), at(i, k + 1), at(i, k + 1), at(i + 1, k), at(i + 1, k + 1)});
    return getMesh(std::move(positions), std::move(indices));
}

/** Returns the processor time that this thread takes for some work [s]. */
inline double processorSeconds(auto&& work) {
    const auto now = [] {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    const double start = now();
    work();
    return now() - start;
}

}  // namespace insonify::test
