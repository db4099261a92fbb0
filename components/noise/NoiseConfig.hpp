#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "types/Describe.hpp"

namespace insonify::noise {

/** Rayleigh: a factor of unit mean, exponentially distributed, on intensity: many scatterers in every bin.
 *  Gaussian: the factor N(mean, deviation), clamped at 0, of Cerqueira et al. 2017. */
enum class SpeckleLaw { Rayleigh, Gaussian };

struct SpeckleConfig {
    SpeckleLaw law = SpeckleLaw::Rayleigh;
    double mean = 0.4;
    double deviation = 0.15;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"law", "", "rayleigh: exponential factor on intensity; gaussian: normal factor, clamped at 0"},
              self.law);
        visit(Field{"mean", "1", "of the gaussian factor", 0, 1e6}, self.mean);
        visit(Field{"deviation", "1", "standard deviation of the gaussian factor", 0, 1e6}, self.deviation);
    }
};

struct AdditiveConfig {
    double level_db = -60;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(types::Field{"level_db", "dB", "mean of the added noise, 10 log10 on the scale of the bins", -3000, 300},
              self.level_db);
    }
};

/** What noise a ping gets: a block that is absent is not computed. */
struct NoiseConfig {
    uint64_t seed = 1;
    std::optional<SpeckleConfig> speckle;
    std::optional<AdditiveConfig> additive;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"seed", "1", "of the random numbers: the same seed and ping times give the same noise"}, self.seed);
        visit(Field{"speckle", "", "multiplicative noise; absent: none"}, self.speckle);
        visit(Field{"additive", "", "exponentially distributed background; absent: none"}, self.additive);
    }
};

}  // namespace insonify::noise

template <>
struct insonify::types::EnumNames<insonify::noise::SpeckleLaw> {
    static constexpr std::string_view names[] = {"rayleigh", "gaussian"};
};
