#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "components/noise/Random.hpp"
#include "types/geometry/BeamArc.hpp"
#include "types/samples/Sonar.hpp"
#include "types/text/Describe.hpp"

namespace insonify::noise {

/** Laws of the speckle factor on intensity. Rayleigh: exponential of unit mean, for many scatterers in every bin.
 *  Gamma: the mean of `looks` exponential factors. K: exponential with a gamma-distributed mean of `shape`, for few or
 *  patchy scatterers. Gaussian: N(mean, deviation), clamped at 0, by Cerqueira et al. 2017. */
enum class SpeckleLaw { Rayleigh, Gamma, K, Gaussian };

struct SpeckleConfig {
    SpeckleLaw law = SpeckleLaw::Rayleigh;
    std::optional<double> looks = {}, shape = {};
    double mean = 0.4;
    double deviation = 0.15;

    static void describe(auto& self, auto& visit) {
        visit({"law", "",
               "rayleigh: exponential factor on intensity; gamma: mean of several; k: exponential of gamma "
               "distributed mean (Jakeman and Pusey 1976); gaussian: normal factor, clamped at 0 (Cerqueira et "
               "al. 2017)"},
              self.law);
        visit({"looks", "1", "law gamma: number of exponential factors that are averaged", 1, 1e4}, self.looks);
        visit({"shape", "1", "law k: 1 to 20 on sea floors; larger values approach rayleigh", 1e-3, 1e6}, self.shape);
        visit({"mean", "1", "of the gaussian factor", 0, 1e6}, self.mean);
        visit({"deviation", "1", "standard deviation of the gaussian factor", 0, 1e6}, self.deviation);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Noise of the sea at the receiver: its mean intensity in a bin, or the quantities that determine it. */
struct AmbientConfig {
    std::optional<double> level_db, wind_m_s, bandwidth_khz, source_level_db;
    double directivity_index_db = 0;
    double frequency_khz = 750;
    double shipping = 0.5;

    static void describe(auto& self, auto& visit) {
        visit({"level_db", "dB", "mean intensity in a bin, relative to the source", -3000, 300}, self.level_db);
        visit({"wind_m_s", "m/s", "instead: speed of the wind, for Coates' formula", 0, 100}, self.wind_m_s);
        visit({"directivity_index_db", "dB", "of the receiver; reduces the noise by this", 0, 100},
              self.directivity_index_db);
        visit({"bandwidth_khz", "kHz", "of the receiver", 1e-3, 1e4}, self.bandwidth_khz);
        visit({"source_level_db", "dB re 1 uPa m", "of the sonar", -300, 300}, self.source_level_db);
        visit({"frequency_khz", "kHz", "of the sonar", 1e-3, 1e4}, self.frequency_khz);
        visit({"shipping", "1", "activity of ships, whose noise is below 1 kHz", 0, 1}, self.shipping);
    }
    void check(types::Diagnostics& diagnostics) const;
};

struct AdditiveConfig {
    double level_db = -60;

    static void describe(auto& self, auto& visit) {
        visit({"level_db", "dB", "mean of the added noise, 10 log10 on the scale of the bins", -3000, 300},
              self.level_db);
    }
};

/** The receiver's filter and averaging of looks, which apply to speckle and noise (ACOUSTICS.md 6.8). */
struct FilterConfig {
    int looks = 1;
    std::optional<double> correlation_bins = {}, correlation_beams = {};

    /** Returns whether one look is taken of independent bins, as without a filter. */
    bool isNeutral() const { return looks == 1 && !correlation_bins && !correlation_beams; }

    static void describe(auto& self, auto& visit) {
        visit({"looks", "1", "independent intensities that are averaged in each bin", 1, 256}, self.looks);
        visit({"correlation_bins", "1",
               "bins in range over which the correlation of intensities falls to 1/e; absent: bins are "
               "independent",
               0.1, 16},
              self.correlation_bins);
        visit({"correlation_beams", "1", "the same across beams; absent: beams are independent", 0.1, 16},
              self.correlation_beams);
    }
};

/** The noise of a ping. An absent block is not simulated. */
struct NoiseConfig {
    std::optional<uint64_t> seed = {};  ///< None: 1. A deployment gives each task its own seed.
    std::optional<SpeckleConfig> speckle;
    std::optional<AmbientConfig> ambient;
    std::optional<AdditiveConfig> additive;
    std::optional<FilterConfig> filter = {};

    bool isNone() const { return !speckle && !ambient && !additive; }

    static void describe(auto& self, auto& visit) {
        visit({"seed", "1",
               "of the random numbers: the same seed and ping times give the same noise; absent: a hash of the "
               "deployment's seed and the task's name"},
              self.seed);
        visit({"speckle", "", "multiplicative noise; absent: none"}, self.speckle);
        visit({"ambient", "", "noise of the sea (Coates 1990), the same at every range before any gain; absent: none"},
              self.ambient);
        visit({"additive", "", "exponentially distributed background, for model cerqueira2017; absent: none"},
              self.additive);
        visit({"filter", "",
               "the receiver's filter and averaging of looks, applied to speckle (rayleigh, k) and noise; absent: "
               "one look, independent in each bin"},
              self.filter);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (!filter) return;
        if (speckle && speckle->law == SpeckleLaw::Gamma)
            diagnostics.push_back(
                {"filter", "is given with speckle.law: gamma; give law: rayleigh, whose looks filter.looks averages"});
        if (speckle && speckle->law == SpeckleLaw::Gaussian)
            diagnostics.push_back(
                {"filter", "is given with speckle.law: gaussian, which is no field; give rayleigh or k"});
    }
};

/** Returns the mean intensity of the noise in a bin, relative to the source: 10^((N + 10 log10 B - DI - SL) / 10)
 *  [1]. */
double ambientIntensity(const AmbientConfig& ambient);

/** Returns half of a symmetric filter, from its middle on. Filtered white noise of unit power has the correlation
 *  exp(-(lag / width)^2 / 2) of fields at whole lags, and so exp(-(lag / width)^2) of intensities. The squares of the
 *  whole filter sum up to 1. `width` is at most 16 lags. */
std::vector<float> gaussianFilter(double width);

/** The beams of a ping as neighbours of each other. */
struct BeamOrder {
    std::vector<uint32_t> beams;  ///< Indices into the ping's beams, each once: neighbours follow each other.
    bool is_ring = false;         ///< Whether the last and the first are neighbours.
};

/** Variates of unit mean with a receiver's correlation: complex Gaussian noise that is filtered in range and across
 *  beams, squared, and averaged over looks (ACOUSTICS.md 6.8).
 *
 *  The noise of a bin depends only on the key, the beam's place in the order and the bin, not on the size of the ping;
 *  in a ring also on the number of beams. */
class FieldFilter {
public:
    explicit FieldFilter(const FilterConfig& config);

    /** Fills the variates of all beams. `key.beam` contains only the bits of a stream. Allocates nothing when
     *  `variates` has had this size before. */
    void draw(const BeamKey& key, const BeamOrder& order, size_t bin_count, std::vector<float>& variates);

    bool isAcross() const { return across_.size() > 1; }  ///< Whether it correlates beams.

private:
    /** Fills white noise, filtered in range, of the beam of a number into a slot. */
    void fillBeam(const BeamKey& key, size_t chunk, size_t number, size_t slot);
    void addPower(size_t first_slot, float scale, size_t bin_count, float* variates) const;
    /** Returns the mean power of the fields of a ring, whose beams the filter may meet several times [1]. */
    double powerInRing(size_t beam_count) const;

    int looks_;
    std::vector<float> along_, across_;  ///< Halves of the filters in range and across beams.
    std::vector<float> beams_;           ///< Fields of the beams that `across_` spans, filtered in range.
};

/** Turns exponential variates t of unit mean into gamma variates of unit mean and a shape. The gamma variate is the
 *  quantile whose upper tail is exp(-t), from a table with 256 entries per octave of t, linear between them. */
class GammaTable {
public:
    /** Takes some milliseconds.
     *  @param shape from 1e-3 to 1e6 [1]; the variance is 1 / shape */
    explicit GammaTable(double shape);

    const float* values() const { return table_.data(); }
    /** Returns the gamma variate of an exponential variate t in [1e-10, 23]; `values` are those of a table. */
    static float variate(const float* values, float t) {
        const int32_t place = std::bit_cast<int32_t>(t) - first_bits;
        const int32_t cell = place >> cell_shift;
        const float rest = static_cast<float>(place & (cell_size - 1)) * (1.0f / cell_size);
        return values[cell] + rest * (values[cell + 1] - values[cell]);
    }

private:
    static constexpr int cell_shift = 15, cell_size = 1 << cell_shift;  ///< Size of a cell in the bits of t.
    static constexpr int32_t first_bits = std::bit_cast<int32_t>(0x1p-34f), last_bits = std::bit_cast<int32_t>(0x1p5f);

    std::vector<float> table_;
};

/** Adds speckle and noise to the intensities of pings before they reach the receiver.
 *
 *  Speckle multiplies. The noise of the sea is added. With `rayleigh` and `k` it is added as a field: one exponential
 *  variate scales the sum of both means. With the other laws it is a separate, exponentially distributed intensity.
 *
 *  The variate of a bin depends only on (seed, ping, beam, bin), where the ping is identified by its time in
 *  microseconds. A replayed log therefore gets the same noise as the original run. */
class Noise {
public:
    explicit Noise(const NoiseConfig& config);

    /** Copies `clean` to `noisy` and adds noise to the bins. NaN stays NaN, and no bin becomes negative unless it was.
     *  Allocates nothing after the first ping of this shape.
     *  @return the number of gaussian factors that were below 0 and clamped */
    uint64_t add(const types::Sonar& clean, types::Sonar& noisy);

    /** Returns the mean intensity that is added to a bin; 0 without added noise [1]. */
    double background() const { return static_cast<double>(ambient_) + static_cast<double>(additive_); }

private:
    struct Run;
    /** Filtered variates of all bins of a ping: for the factor on echoes, the noise of the sea and additive noise.
     *  Empty when not used. */
    struct Filtered {
        std::vector<float> factor, ambient, additive;
    };
    bool addsAmbient() const;
    void setOrder(const types::Sonar& ping);
    void drawFiltered(const types::Sonar& ping, uint64_t seed);
    uint64_t addTo(const Run& run) const;
    uint64_t multiply(const Run& run) const;

    NoiseConfig config_;
    std::optional<GammaTable> gamma_;  ///< Table of laws gamma and k.
    std::optional<FieldFilter> filter_;
    Filtered filtered_;
    types::BeamArc arc_;
    BeamOrder order_;                   ///< Of the beams of the ping, for the filter.
    float ambient_ = 0, additive_ = 0;  ///< Mean intensities [1].
};

}  // namespace insonify::noise

template <>
struct insonify::types::EnumNames<insonify::noise::SpeckleLaw> {
    static constexpr std::string_view names[] = {"rayleigh", "gamma", "k", "gaussian"};
};
