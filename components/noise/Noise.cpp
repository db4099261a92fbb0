#include "components/noise/Noise.hpp"

#include <algorithm>
#include <cmath>

#include "components/noise/Random.hpp"

// The AVX2 version uses no fused multiply-add, so both give the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define INSONIFY_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define INSONIFY_VECTOR_CLONES
#endif

namespace insonify::noise {
namespace {

/** Philox blocks are drawn 64 at a time: bin 256 c + 64 w + i of a beam gets word w of block 64 c + i. */
constexpr size_t lanes = 64;
constexpr size_t chunk_bins = 4 * lanes;

/** Uniform words, then variates, of the bins of one chunk. */
using Words = std::array<uint32_t, chunk_bins>;
using Variates = std::array<float, chunk_bins>;

/** Independent sets of variates for one bin: a bit of the counter's beam word. */
enum class Stream : uint32_t { Speckle = 0, Additive = 0x80000000 };

/** What, with bin and stream, makes the counter and the key. */
struct BeamKey {
    Key seed;
    uint32_t beam;
    uint32_t ping_low, ping_high;
};

inline void drawWords(const BeamKey& key, Stream stream, size_t chunk, Words& words) {
    for (size_t i = 0; i < lanes; ++i) {
        const Counter block = philox({static_cast<uint32_t>(chunk * lanes + i),
                                      key.beam | static_cast<uint32_t>(stream), key.ping_low, key.ping_high},
                                     key.seed);
        for (size_t word = 0; word < 4; ++word) words[word * lanes + i] = block[word];
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
    for (size_t pair = 0; pair < chunk_bins; pair += 2 * lanes)
        for (size_t i = pair; i < pair + lanes; ++i) {
            const Normals drawn = normals(words[i], words[i + lanes]);
            variates[i] = drawn.first;
            variates[i + lanes] = drawn.second;
        }
}

/** One run of bins, at most a chunk long. */
struct Run {
    const BeamKey& key;
    size_t chunk;
    const float* clean;
    float* noisy;
    size_t size;
};

void applyRayleigh(const Run& run) {
    Variates factor;
    drawExponentials(run.key, Stream::Speckle, run.chunk, factor);
    for (size_t i = 0; i < run.size; ++i) run.noisy[i] = run.clean[i] * factor[i];
}

uint64_t applyGaussian(const SpeckleConfig& config, const Run& run) {
    const float mean = static_cast<float>(config.mean), deviation = static_cast<float>(config.deviation);
    Variates normal;
    drawNormals(run.key, Stream::Speckle, run.chunk, normal);
    uint32_t clamped = 0;
    for (size_t i = 0; i < run.size; ++i) {
        const float factor = mean + deviation * normal[i];
        clamped += factor < 0;
        run.noisy[i] = run.clean[i] * (factor > 0 ? factor : 0.0f);
    }
    return clamped;
}

void addExponential(float level, const Run& run) {
    Variates noise;
    drawExponentials(run.key, Stream::Additive, run.chunk, noise);
    for (size_t i = 0; i < run.size; ++i) run.noisy[i] += level * noise[i];
}

uint64_t addNoise(const NoiseConfig& config, float level, const Run& run) {
    uint64_t clamped = 0;
    if (!config.speckle)
        std::copy_n(run.clean, run.size, run.noisy);
    else if (config.speckle->law == SpeckleLaw::Rayleigh)
        applyRayleigh(run);
    else
        clamped = applyGaussian(*config.speckle, run);
    if (config.additive) addExponential(level, run);
    return clamped;
}

void copyAllButBins(const types::Sonar& from, types::Sonar& to) {
    to.time = from.time;
    to.timestamps = from.timestamps;
    to.bin_duration = from.bin_duration;
    to.beam_width = from.beam_width;
    to.beam_height = from.beam_height;
    to.bearings = from.bearings;
    to.speed_of_sound = from.speed_of_sound;
    to.bin_count = from.bin_count;
    to.beam_count = from.beam_count;
    to.bins.resize(from.bins.size());
}

constexpr uint32_t low(uint64_t word) { return static_cast<uint32_t>(word); }
constexpr uint32_t high(uint64_t word) { return static_cast<uint32_t>(word >> 32); }

}  // namespace

uint64_t addNoise(const NoiseConfig& config, const types::Sonar& clean, types::Sonar& noisy) {
    copyAllButBins(clean, noisy);
    const float level = config.additive ? static_cast<float>(std::pow(10.0, config.additive->level_db / 10)) : 0.0f;
    const uint64_t ping = static_cast<uint64_t>(clean.time.microseconds);
    uint64_t clamped = 0;
    for (uint32_t beam = 0; beam < clean.beam_count; ++beam) {
        const BeamKey key{{low(config.seed), high(config.seed)}, beam, low(ping), high(ping)};
        for (size_t bin = 0; bin < clean.bin_count; bin += chunk_bins) {
            const size_t offset = size_t{beam} * clean.bin_count + bin;
            const size_t size = std::min<size_t>(chunk_bins, clean.bin_count - bin);
            clamped += addNoise(config, level, {key, bin / chunk_bins, &clean.bins[offset], &noisy.bins[offset], size});
        }
    }
    return clamped;
}

}  // namespace insonify::noise
