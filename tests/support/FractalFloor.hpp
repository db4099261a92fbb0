#pragma once
// A sea floor that is rough at every scale: what fewer triangles cannot stand for.
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/Scenes.hpp"

namespace insonify::test {

/** A square of `cells` x `cells` cells of two triangles, whose heights have a rms of 0.35 m and along any track a power
 *  that falls with the wave number's power of -2.7. */
class FractalFloor {
public:
    /** `size` wide about (x, 0), at a mean height of 0 [m]. */
    FractalFloor(uint32_t seed, uint32_t cells, double size, double x) : side_(cells + 1) {
        const std::vector<Wave> waves = wavesOf(seed, size, 2 * size / cells);
        for (uint32_t i = 0; i < side_; ++i)
            for (uint32_t j = 0; j < side_; ++j) {
                const double px = x + size * (1.0 * i / cells - 0.5), py = size * (1.0 * j / cells - 0.5);
                double height = 0;
                for (const Wave& wave : waves)
                    height += wave.amplitude * std::cos(wave.x * px + wave.y * py + wave.phase);
                points_.emplace_back(px, py, height);
            }
    }

    /** `count` x `count` cells from cell (row, column) on, as a mesh of their own. */
    types::Mesh part(uint32_t row, uint32_t column, uint32_t count) const {
        std::vector<glm::vec3> positions;
        std::vector<uint32_t> indices;
        for (uint32_t i = row; i <= row + count; ++i)
            for (uint32_t j = column; j <= column + count; ++j) positions.push_back(points_[i * side_ + j]);
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t j = 0; j < count; ++j) {
                const uint32_t a = i * (count + 1) + j, b = a + count + 1;
                indices.insert(indices.end(), {a, b, b + 1, a, b + 1, a + 1});
            }
        return meshOf(std::move(positions), std::move(indices));
    }

private:
    struct Wave {
        double x, y, phase, amplitude;
    };

    /** Waves of all lengths from `longest` to `shortest` in all directions. */
    static std::vector<Wave> wavesOf(uint32_t seed, double longest, double shortest) {
        constexpr int count = 128;
        constexpr double slope_along_a_track = -2.7, rms = 0.35;
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
        std::vector<Wave> waves;
        double variance = 0;
        for (int i = 0; i < count; ++i) {
            const double k = 2 * std::numbers::pi / longest * std::pow(longest / shortest, (i + 0.5) / count);
            const double power = std::pow(k, slope_along_a_track + 1), heading = angle(random);  // of a step of ln(k)
            waves.push_back({k * std::cos(heading), k * std::sin(heading), angle(random), std::sqrt(2 * power)});
            variance += power;
        }
        for (Wave& wave : waves) wave.amplitude *= rms / std::sqrt(variance);
        return waves;
    }

    uint32_t side_;
    std::vector<glm::vec3> points_;
};

}  // namespace insonify::test
