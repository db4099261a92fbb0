#include "components/study/FractalFloor.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "components/study/Shapes.hpp"
#include "types/Hash.hpp"

namespace insonify::study {
namespace {

using Complex = std::complex<double>;

/** Fourier-transforms every `stride`-th of n values in place, n a power of two (Cooley and Tukey, 1965). */
void transform(Complex* values, size_t n, size_t stride) {
    for (size_t i = 1, j = 0; i < n; ++i) {
        size_t bit = n / 2;
        for (; j & bit; bit /= 2) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(values[i * stride], values[j * stride]);
    }
    for (size_t length = 2; length <= n; length *= 2)
        for (size_t k = 0; k < length / 2; ++k) {
            const Complex turn =
                std::polar(1.0, 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(length));
            for (size_t i = k; i < n; i += length) {
                Complex &a = values[i * stride], &b = values[(i + length / 2) * stride];
                const Complex turned = b * turn;
                b = a - turned;
                a += turned;
            }
        }
}

/** Returns a standard complex Gaussian number (Box and Muller, 1958). */
Complex gaussian(uint64_t seed, uint64_t a, uint64_t b) {
    const uint64_t word = types::hashed(seed, a, b);
    return std::polar(std::sqrt(-2 * std::log(types::unit(word >> 32))),
                      2 * std::numbers::pi * types::unit(word & 0xffffffffu));
}

types::Mesh patchOf(const FractalFloor& floor, const std::vector<double>& heights, int from_x, int to_x, int from_y,
                    int to_y) {
    const double step = floor.side / (floor.points - 1);
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    const auto across = static_cast<uint32_t>(to_y - from_y + 1);
    for (int i = from_x; i <= to_x; ++i)
        for (int j = from_y; j <= to_y; ++j)
            positions.push_back(glm::dvec3(floor.centre_x + i * step - floor.side / 2, j * step - floor.side / 2,
                                           heights[static_cast<size_t>(i * floor.points + j)] - floor.depth));
    for (uint32_t i = 0; i < static_cast<uint32_t>(to_x - from_x); ++i)
        for (uint32_t j = 0; j + 1 < across; ++j) {
            const uint32_t a = i * across + j, b = a + across;
            indices.insert(indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    return meshOf(std::move(positions), std::move(indices));
}

}  // namespace

std::vector<double> heightsOf(const FractalFloor& floor) {
    const auto n = static_cast<size_t>(floor.points);
    std::vector<Complex> amplitudes(n * n);
    const auto wavenumber = [n](size_t i) { return static_cast<double>(i <= n / 2 ? i : n - i); };
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < n; ++j)
            if (i + j > 0)
                amplitudes[i * n + j] = gaussian(floor.seed, i, j) *
                                        std::pow(std::hypot(wavenumber(i), wavenumber(j)), (floor.slope - 1) / 2);
    for (size_t i = 0; i < n; ++i) transform(&amplitudes[i * n], n, 1);
    for (size_t j = 0; j < n; ++j) transform(&amplitudes[j], n, n);
    std::vector<double> heights;
    double squares = 0;
    for (const Complex& value : amplitudes) {
        heights.push_back(value.real());
        squares += value.real() * value.real();
    }
    const double scale = floor.rms / std::sqrt(squares / static_cast<double>(n * n));
    for (double& height : heights) height *= scale;
    return heights;
}

types::Mesh meshOf(const FractalFloor& floor) {
    return patchOf(floor, heightsOf(floor), 0, floor.points - 1, 0, floor.points - 1);
}

std::vector<types::Mesh> tilesOf(const FractalFloor& floor, int tiles) {
    const std::vector<double> heights = heightsOf(floor);
    const auto edge = [&](int tile) { return (floor.points - 1) * tile / tiles; };
    std::vector<types::Mesh> meshes;
    for (int i = 0; i < tiles; ++i)
        for (int j = 0; j < tiles; ++j)
            meshes.push_back(patchOf(floor, heights, edge(i), edge(i + 1), edge(j), edge(j + 1)));
    return meshes;
}

}  // namespace insonify::study
