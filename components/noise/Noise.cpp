#include "components/noise/Noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "components/acoustics/AmbientNoise.hpp"
#include "components/noise/Random.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::noise {
namespace {

double computePower(double decibels) { return std::pow(10.0, decibels / 10); }

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

constexpr int steps = 8192;
constexpr double tail = 32;  ///< exp(-tail) is below the smallest tail of the table.

/** Shares of the law below and above points of y = ln x, evenly spaced. */
struct Shares {
    double low, step;
    std::vector<double> below, above;
    double y(size_t i) const { return low + step * static_cast<double>(i); }
};

/** Returns y where shape (1 + y - exp(y)) = -tail. By Chernoff's bound less than exp(-tail) of the law is farther
 *  out. */
double findEnd(double shape, double inside, double outside) {
    for (int i = 0; i < 200; ++i) {
        const double y = (inside + outside) / 2;
        (shape * (1 + y - std::exp(y)) > -tail ? inside : outside) = y;
    }
    return outside;
}

/** Integrates the density of y = ln x of a gamma variate x of unit mean, by Simpson's rule over each step. */
Shares computeShares(double shape) {
    constexpr double minimum = -90;  // exp(-90) is as good as 0 in a float
    const double low = findEnd(shape, 0, minimum), high = findEnd(shape, 0, 40);
    const double scale = shape * std::log(shape) - std::lgamma(shape);
    const auto density = [&](double y) { return std::exp(scale + shape * (y - std::exp(y))); };
    Shares shares{low, (high - low) / steps, std::vector<double>(steps + 1), std::vector<double>(steps + 1)};
    // Beyond `low` the density falls as exp(shape (1 - x) y) or faster.
    shares.below[0] = density(low) / (shape * (1 - std::exp(low)));
    std::vector<double> parts(steps);
    for (size_t i = 0; i < steps; ++i) {
        const double from = shares.y(i), to = shares.y(i + 1);
        parts[i] = shares.step / 6 * (density(from) + 4 * density((from + to) / 2) + density(to));
        shares.below[i + 1] = shares.below[i] + parts[i];
    }
    for (size_t i = steps; i-- > 0;) shares.above[i] = shares.above[i + 1] + parts[i];
    return shares;
}

/** Returns the y between points `i` and `i` + 1 where ln of the share is `wanted`. */
double between(const Shares& shares, const std::vector<double>& share, size_t i, double wanted) {
    const double from = std::log(share[i]), to = std::log(share[i + 1]);
    return shares.y(i) + shares.step * std::clamp((wanted - from) / (to - from), 0.0, 1.0);
}

/** Returns the y above which the share is exp(-t). Uses the smaller of the two shares, which is more accurate. */
double quantile(const Shares& shares, double t) {
    const bool is_low = t < 0.6931;
    const double wanted = is_low ? std::log(-std::expm1(-t)) : -t, share = std::exp(wanted);
    if (is_low && share <= shares.below[0]) return -std::numeric_limits<double>::infinity();
    const std::vector<double>& known = is_low ? shares.below : shares.above;
    const auto found = is_low ? std::lower_bound(known.begin(), known.end(), share)
                              : std::lower_bound(known.begin(), known.end(), share, std::greater<>());
    const auto i = static_cast<size_t>(std::clamp<std::ptrdiff_t>(found - known.begin() - 1, 0, steps - 2));
    return between(shares, known, i, wanted);
}

/** Philox blocks are drawn 64 at a time: bin 256 c + 64 w + i of a beam gets word w of block 64 c + i. */
constexpr size_t batch = 64;
constexpr size_t chunk_bins = 4 * batch;

/** Uniform words, then variates, of the bins of one chunk. */
using Words = std::array<uint32_t, chunk_bins>;
using Variates = std::array<float, chunk_bins>;

/** Independent sets of variates for one bin: bits of the counter's beam word. */
enum class Stream : uint32_t { Speckle = 0, Additive = 0x80000000, Ambient = 0x40000000, Texture = 0xC0000000 };

inline void drawWords(const BeamKey& key, Stream stream, size_t chunk, Words& words) {
    for (size_t i = 0; i < batch; ++i) {
        const Counter block = philox({static_cast<uint32_t>(chunk * batch + i),
                                      key.beam | static_cast<uint32_t>(stream), key.ping_low, key.ping_high},
                                     key.seed);
        for (size_t word = 0; word < 4; ++word) words[word * batch + i] = block[word];
    }
}

INSONIFY_VECTOR_CLONES
void drawExponentials(const BeamKey& key, Stream stream, size_t chunk, Variates& variates) {
    Words words;
    drawWords(key, stream, chunk, words);
    for (size_t i = 0; i < chunk_bins; ++i) variates[i] = exponential(words[i]);
}

INSONIFY_VECTOR_CLONES
void drawNormals(const BeamKey& key, Stream stream, size_t chunk, Variates& variates) {
    Words words;
    drawWords(key, stream, chunk, words);
    for (size_t pair = 0; pair < chunk_bins; pair += 2 * batch)
        for (size_t i = pair; i < pair + batch; ++i) {
            const Normals drawn = normals(words[i], words[i + batch]);
            variates[i] = drawn.first;
            variates[i + batch] = drawn.second;
        }
}

/** Replaces exponential variates by gamma variates. */
INSONIFY_VECTOR_CLONES
void turnToGamma(const float* values, Variates& variates) {
    for (float& variate : variates) variate = GammaTable::variate(values, variate);
}

/** Computes out = (in texture + mean) factor. */
INSONIFY_VECTOR_CLONES
void multiplyFields(const float* in, const Variates& texture, float mean, const Variates& factor, float* out,
                    size_t size) {
    for (size_t i = 0; i < size; ++i) out[i] = (in[i] * texture[i] + mean) * factor[i];
}

constexpr uint32_t low(uint64_t word) { return static_cast<uint32_t>(word); }
constexpr uint32_t high(uint64_t word) { return static_cast<uint32_t>(word >> 32); }

}  // namespace

void AmbientConfig::check(types::Diagnostics& diagnostics) const {
    const std::pair<const char*, const std::optional<double>&> computed[] = {
        {"wind_m_s", wind_m_s}, {"bandwidth_khz", bandwidth_khz}, {"source_level_db", source_level_db}};
    if (!level_db && !wind_m_s && !bandwidth_khz && !source_level_db)
        return diagnostics.push_back(
            {"", "has no value; give level_db, or wind_m_s, bandwidth_khz and source_level_db"});
    for (const auto& [name, value] : computed) {
        if (level_db && value) diagnostics.push_back({name, "is given together with level_db; give one of the two"});
        if (!level_db && !value)
            diagnostics.push_back({"", std::string("has no ") + name + ", which is needed without level_db"});
    }
    if (bandwidth_khz && *bandwidth_khz > 2 * frequency_khz)
        diagnostics.push_back({"bandwidth_khz", fmt::format("is {:g} kHz; a band about {:g} kHz may have {:g} kHz",
                                                            *bandwidth_khz, frequency_khz, 2 * frequency_khz)});
}

double ambientIntensity(const AmbientConfig& ambient) {
    if (ambient.level_db) return computePower(*ambient.level_db);
    const double spectrum = acoustics::coatesSpectrumDb(ambient.frequency_khz, *ambient.wind_m_s, ambient.shipping);
    return computePower(spectrum + 10 * std::log10(1e3 * *ambient.bandwidth_khz) - ambient.directivity_index_db -
                        *ambient.source_level_db);
}

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
    const auto getNumber = [&](size_t slot) {
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
            for (size_t slot = 0; slot < 2 * reach; ++slot) fillBeam(own, chunk, getNumber(slot), slot);
            for (size_t place = 0; place < beam_count; ++place) {
                fillBeam(own, chunk, getNumber(place + 2 * reach), place + 2 * reach);
                addPower(place, scale, count, &variates[order.beams[place] * bin_count + first]);
            }
        }
    }
}

GammaTable::GammaTable(double shape) {
    const Shares shares = computeShares(shape);
    constexpr float minimum = std::numeric_limits<float>::min();  // smaller numbers are slow, and as good as 0
    for (int32_t bits = first_bits; bits <= last_bits; bits += cell_size) {
        const double y = quantile(shares, static_cast<double>(std::bit_cast<float>(bits)));
        const auto x = static_cast<float>(std::exp(y));
        table_.push_back(x < minimum ? 0.0f : x);
    }
}

void SpeckleConfig::check(types::Diagnostics& diagnostics) const {
    const auto require = [&](const char* name, const std::optional<double>& value, bool needed, const char* owner) {
        if (needed && !value) diagnostics.push_back({name, std::string("is absent; law: ") + owner + " needs it"});
        if (!needed && value) diagnostics.push_back({name, std::string("is given; it belongs to law: ") + owner});
    };
    require("looks", looks, law == SpeckleLaw::Gamma, "gamma");
    require("shape", shape, law == SpeckleLaw::K, "k");
}

/** One run of bins, at most a chunk long. */
struct Noise::Run {
    const BeamKey& key;
    size_t chunk;
    const float* clean;
    float* noisy;
    size_t size;
    size_t offset;  ///< Index of the first bin in the ping.

    void multiplyBy(const Variates& factor, float mean) const {
        for (size_t i = 0; i < size; ++i) noisy[i] = (clean[i] + mean) * factor[i];
    }
    uint64_t multiplyByNormals(const SpeckleConfig& speckle) const {
        const float mean = static_cast<float>(speckle.mean), deviation = static_cast<float>(speckle.deviation);
        Variates normal;
        drawNormals(key, Stream::Speckle, chunk, normal);
        uint32_t clamped = 0;
        for (size_t i = 0; i < size; ++i) {
            const float factor = mean + deviation * normal[i];
            clamped += factor < 0;
            noisy[i] = clean[i] * (factor > 0 ? factor : 0.0f);
        }
        return clamped;
    }
    /** Fills variates of unit mean: filtered variates where there are any, else exponential variates. */
    void draw(Stream stream, const std::vector<float>& filtered, Variates& variates) const {
        if (filtered.empty()) return drawExponentials(key, stream, chunk, variates);
        std::copy_n(filtered.data() + offset, size, variates.data());
    }
    void addVariates(Stream stream, const std::vector<float>& filtered, float level) const {
        Variates noise;
        draw(stream, filtered, noise);
        for (size_t i = 0; i < size; ++i) noisy[i] += level * noise[i];
    }
};

Noise::Noise(const NoiseConfig& config) : config_(config) {
    if (config.speckle && config.speckle->law == SpeckleLaw::Gamma) gamma_.emplace(config.speckle->looks.value_or(1));
    if (config.speckle && config.speckle->law == SpeckleLaw::K) gamma_.emplace(config.speckle->shape.value_or(1));
    if (config.filter && !config.filter->isNeutral()) filter_.emplace(*config.filter);
    if (config.ambient) ambient_ = static_cast<float>(std::min(ambientIntensity(*config.ambient), 1e30));
    if (config.additive) additive_ = static_cast<float>(std::pow(10.0, config.additive->level_db / 10));
}

uint64_t Noise::multiply(const Run& run) const {
    if (config_.speckle->law == SpeckleLaw::Gaussian) return run.multiplyByNormals(*config_.speckle);
    Variates factor, texture;
    run.draw(Stream::Speckle, filtered_.factor, factor);
    if (config_.speckle->law == SpeckleLaw::K) {
        drawExponentials(run.key, Stream::Texture, run.chunk, texture);
        turnToGamma(gamma_->values(), texture);
        multiplyFields(run.clean, texture, ambient_, factor, run.noisy, run.size);
    } else if (config_.speckle->law == SpeckleLaw::Gamma) {
        turnToGamma(gamma_->values(), factor);
        run.multiplyBy(factor, 0);
    } else {
        run.multiplyBy(factor, ambient_);
    }
    return 0;
}

uint64_t Noise::addTo(const Run& run) const {
    uint64_t clamped = 0;
    if (config_.speckle)
        clamped = multiply(run);
    else
        std::copy_n(run.clean, run.size, run.noisy);
    if (addsAmbient()) run.addVariates(Stream::Ambient, filtered_.ambient, ambient_);
    if (config_.additive) run.addVariates(Stream::Additive, filtered_.additive, additive_);
    return clamped;
}

/** Returns whether the noise of the sea is added as a separate intensity, and not in the mean of the speckle. */
bool Noise::addsAmbient() const {
    const bool has_ambient =
        config_.speckle && (config_.speckle->law == SpeckleLaw::Rayleigh || config_.speckle->law == SpeckleLaw::K);
    return config_.ambient && !has_ambient;
}

/** Sorts the beams along their arc where their neighbours matter; those of unknown bearing follow. */
void Noise::setOrder(const types::Sonar& ping) {
    std::vector<uint32_t>& beams = order_.beams;
    beams.clear();
    order_.is_ring = false;
    if (filter_->isAcross()) {
        arc_.take(ping);
        beams.assign(arc_.beams.begin(), arc_.beams.end());
        order_.is_ring = beams.size() == ping.beam_count && arc_.isRing();
    }
    for (uint32_t beam = 0; beam < ping.beam_count && beams.size() < ping.beam_count; ++beam)
        if (beam >= ping.bearings.size() || !std::isfinite(ping.bearings[beam].rad) || !filter_->isAcross())
            beams.push_back(beam);
}

void Noise::drawFiltered(const types::Sonar& ping, uint64_t seed) {
    const uint64_t time = static_cast<uint64_t>(ping.time.microseconds);
    const auto draw = [&](Stream stream, bool wanted, std::vector<float>& variates) {
        const BeamKey key{{low(seed), high(seed)}, static_cast<uint32_t>(stream), low(time), high(time)};
        if (wanted) filter_->draw(key, order_, ping.bin_count, variates);
    };
    setOrder(ping);
    draw(Stream::Speckle, config_.speckle.has_value(), filtered_.factor);
    draw(Stream::Ambient, addsAmbient(), filtered_.ambient);
    draw(Stream::Additive, config_.additive.has_value(), filtered_.additive);
}

uint64_t Noise::add(const types::Sonar& clean, types::Sonar& noisy) {
    noisy.copyHeader(clean);
    const uint64_t ping = static_cast<uint64_t>(clean.time.microseconds), seed = config_.seed.value_or(1);
    if (filter_) drawFiltered(clean, seed);
    uint64_t clamped = 0;
    for (uint32_t beam = 0; beam < clean.beam_count; ++beam) {
        const BeamKey key{{low(seed), high(seed)}, beam, low(ping), high(ping)};
        for (size_t bin = 0; bin < clean.bin_count; bin += chunk_bins) {
            const size_t offset = size_t{beam} * clean.bin_count + bin;
            const size_t size = std::min<size_t>(chunk_bins, clean.bin_count - bin);
            clamped += addTo({key, bin / chunk_bins, &clean.bins[offset], &noisy.bins[offset], size, offset});
        }
    }
    return clamped;
}

}  // namespace insonify::noise
