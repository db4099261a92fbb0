#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "types/Describe.hpp"

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
        visit({"source_level_db", "dB re 1 uPa m", "of the sonar", -300, 400}, self.source_level_db);
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
        if (isNone())
            return diagnostics.push_back({"filter", "has nothing to filter; give speckle, ambient or additive"});
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

}  // namespace insonify::noise

template <>
struct insonify::types::EnumNames<insonify::noise::SpeckleLaw> {
    static constexpr std::string_view names[] = {"rayleigh", "gamma", "k", "gaussian"};
};
