#include "components/noise/FieldFilter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "types/VectorMath.hpp"

namespace insonify::noise {
namespace {

constexpr size_t blocks = 64;              ///< Philox blocks that are drawn at a time.
constexpr size_t block_bins = 2 * blocks;  ///< Bins whose complex fields these blocks contain.
constexpr size_t filtered_bins = 256;      ///< Bins of a beam that are filtered at a time.
constexpr size_t margin = 64;              ///< Max reach of a filter to either side [bins].
constexpr size_t random_bins = filtered_bins + 2 * margin;

/** Real and imaginary parts of a field along a beam. */
template <size_t count>
struct Field {
    float real[count], imaginary[count];
};

/** Fills white noise of the bins from `margin` before the chunk to `margin` behind it. */
INSONIFY_VECTOR_CLONES
void drawField(const BeamKey& key, size_t chunk, Field<random_bins>& field) {
    static_assert(random_bins % block_bins == 0 && filtered_bins % block_bins == 0);
    uint32_t words[4][blocks];
    for (size_t part = 0; part < random_bins / block_bins; ++part) {
        const size_t first = (chunk * (filtered_bins / block_bins) + part) * blocks;
        for (size_t i = 0; i < blocks; ++i) {
            const Counter block =
                philox({static_cast<uint32_t>(first + i), key.beam, key.ping_low, key.ping_high}, key.seed);
            for (size_t word = 0; word < 4; ++word) words[word][i] = block[word];
        }
        for (size_t half = 0; half < 2; ++half)
            for (size_t i = 0; i < blocks; ++i) {
                const Normals drawn = normals(words[2 * half][i], words[2 * half + 1][i]);
                field.real[part * block_bins + half * blocks + i] = drawn.first;
                field.imaginary[part * block_bins + half * blocks + i] = drawn.second;
            }
    }
}

/** out[i] = sum over t of half[abs(t)] in[margin + i + t]. */
INSONIFY_VECTOR_CLONES
void filterAlong(const float* in, const float* half, size_t taps, float* __restrict out) {
    for (size_t i = 0; i < filtered_bins; ++i) out[i] = half[0] * in[margin + i];
    for (size_t t = 1; t < taps; ++t)
        for (size_t i = 0; i < filtered_bins; ++i) out[i] += half[t] * (in[margin + i - t] + in[margin + i + t]);
}

INSONIFY_VECTOR_CLONES
void addWeighted(const float* in, float weight, float* __restrict out, size_t count) {
    for (size_t i = 0; i < count; ++i) out[i] += weight * in[i];
}

INSONIFY_VECTOR_CLONES
void addSquares(const Field<filtered_bins>& field, float scale, float* __restrict out, size_t count) {
    for (size_t i = 0; i < count; ++i)
        out[i] += scale * (field.real[i] * field.real[i] + field.imaginary[i] * field.imaginary[i]);
}

}  // namespace

std::vector<float> gaussianFilter(double width) {
    // The filter's spectrum is the root of the power spectrum, whose Fourier coefficients are the correlations.
    constexpr size_t points = 1024, longest = 256;
    std::vector<double> spectrum(points), half;
    for (size_t m = 0; m < points; ++m) {
        double power = 1;
        for (size_t lag = 1; lag < longest; ++lag)
            power += 2 * std::exp(-0.5 * std::pow(static_cast<double>(lag) / width, 2)) *
                     std::cos(2 * std::numbers::pi * static_cast<double>(m * lag % points) / points);
        spectrum[m] = std::sqrt(std::max(power, 0.0));
    }
    double sum = 0;
    for (size_t t = 0; t <= margin; ++t) {
        double tap = 0;
        for (size_t m = 0; m < points; ++m)
            tap += spectrum[m] * std::cos(2 * std::numbers::pi * static_cast<double>(m * t % points) / points) / points;
        half.push_back(tap);
        sum += (t == 0 ? 1 : 2) * tap * tap;
    }
    constexpr double minimum = 1e-5;  // relative to the middle tap
    while (half.size() > 1 && std::abs(half.back()) < minimum * half.front()) half.pop_back();
    std::vector<float> taps;
    for (const double tap : half) taps.push_back(static_cast<float>(tap / std::sqrt(sum)));
    return taps;
}

FieldFilter::FieldFilter(const FilterConfig& config)
    : looks_(config.looks),
      along_(config.correlation_bins ? gaussianFilter(*config.correlation_bins) : std::vector<float>{1}),
      across_(config.correlation_beams ? gaussianFilter(*config.correlation_beams) : std::vector<float>{1}),
      beams_((2 * across_.size() - 1) * 2 * filtered_bins) {}

void FieldFilter::fillBeam(const BeamKey& key, size_t chunk, size_t number, size_t slot) {
    Field<random_bins> drawn;
    drawField({key.seed, key.beam | static_cast<uint32_t>(number), key.ping_low, key.ping_high}, chunk, drawn);
    float* const kept = &beams_[slot % (2 * across_.size() - 1) * 2 * filtered_bins];
    filterAlong(drawn.real, along_.data(), along_.size(), kept);
    filterAlong(drawn.imaginary, along_.data(), along_.size(), kept + filtered_bins);
}

void FieldFilter::addPower(size_t first_slot, float scale, size_t bin_count, float* variates) const {
    Field<filtered_bins> field{};
    const size_t reach = across_.size() - 1, span = 2 * reach + 1;
    for (size_t i = 0; i < span; ++i) {
        const float weight = across_[i < reach ? reach - i : i - reach];
        const float* const kept = &beams_[(first_slot + i) % span * 2 * filtered_bins];
        addWeighted(kept, weight, field.real, filtered_bins);
        addWeighted(kept + filtered_bins, weight, field.imaginary, filtered_bins);
    }
    addSquares(field, scale, variates, bin_count);
}

double FieldFilter::powerInRing(size_t beam_count) const {
    const size_t reach = across_.size() - 1;
    if (beam_count > 2 * reach) return 1;
    std::vector<double> folded(beam_count, 0.0);
    for (size_t i = 0; i <= 2 * reach; ++i)
        folded[i % beam_count] += static_cast<double>(across_[i < reach ? reach - i : i - reach]);
    double power = 0;
    for (const double weight : folded) power += weight * weight;
    return power;
}

void FieldFilter::draw(const BeamKey& key, const BeamOrder& order, size_t bin_count, std::vector<float>& variates) {
    const size_t beam_count = order.beams.size(), reach = across_.size() - 1;
    variates.assign(beam_count * bin_count, 0.0f);
    // White noise is numbered from `reach` before the first beam; in a ring, that of the beam itself.
    const auto numberOf = [&](size_t slot) {
        return order.is_ring ? (slot + reach * (beam_count - 1)) % beam_count + reach : slot;
    };
    const double power = order.is_ring ? powerInRing(beam_count) : 1;
    const float scale = power == 1 ? 0.5f / static_cast<float>(looks_) : static_cast<float>(0.5 / (looks_ * power));
    for (int look = 0; look < looks_; ++look) {
        // This key differs from that of every unfiltered variate.
        const BeamKey own{{key.seed[0], key.seed[1] ^ 0x9E3779B9u * static_cast<uint32_t>(look + 1)},
                          key.beam,
                          key.ping_low,
                          key.ping_high};
        for (size_t chunk = 0; chunk * filtered_bins < bin_count; ++chunk) {
            const size_t first = chunk * filtered_bins, count = std::min(filtered_bins, bin_count - first);
            for (size_t slot = 0; slot < 2 * reach; ++slot) fillBeam(own, chunk, numberOf(slot), slot);
            for (size_t place = 0; place < beam_count; ++place) {
                fillBeam(own, chunk, numberOf(place + 2 * reach), place + 2 * reach);
                addPower(place, scale, count, &variates[order.beams[place] * bin_count + first]);
            }
        }
    }
}

}  // namespace insonify::noise
