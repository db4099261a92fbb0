#include "components/sonar/config/ImperfectionsConfig.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "types/Angle.hpp"
#include "types/Hash.hpp"

namespace insonify::sonar {
namespace {

/** Streams of independent random numbers of one device. */
enum ErrorStream : uint64_t { element_errors = 1, element_failures, beam_errors, beam_failures };

uint64_t errorSeed(uint32_t seed, ErrorStream stream) { return types::hashed(seed, 0x6d706572, stream); }

/** Two independent variates of N(0, 1) (Box and Muller 1958). */
std::complex<double> normalPair(uint64_t seed, size_t place) {
    const uint64_t word = types::hashed(seed, place, 0);
    return std::polar(std::sqrt(-2 * std::log(types::unit(word >> 32))),
                      2 * std::numbers::pi * types::unit(word & 0xffffffff));
}

/** Returns whether the element or beam `place` has failed: at random, or because the list contains it. */
bool hasFailed(uint64_t seed, size_t place, double share, const std::vector<uint32_t>& list) {
    return types::unit(types::hashed(seed, place, 1) >> 32) < share ||
           std::ranges::find(list, static_cast<uint32_t>(place)) != list.end();
}

}  // namespace

std::vector<std::complex<double>> ImperfectionsConfig::elementFactors(size_t count) const {
    std::vector<std::complex<double>> factors;
    for (size_t m = 0; m < count; ++m) {
        const std::complex<double> errors = normalPair(errorSeed(seed, element_errors), m);
        const bool failed = hasFailed(errorSeed(seed, element_failures), m, dead_element_share, dead_elements);
        factors.push_back(failed ? 0.0
                                 : std::polar(std::pow(10, errors.real() * gain_error_db / 20),
                                              errors.imag() * types::radians(phase_error_deg)));
    }
    return factors;
}

std::vector<float> ImperfectionsConfig::beamFactors(size_t count) const {
    std::vector<float> factors;
    for (size_t k = 0; k < count; ++k) {
        const double error = normalPair(errorSeed(seed, beam_errors), k).real() * beam_gain_error_db;
        const bool failed = hasFailed(errorSeed(seed, beam_failures), k, dead_beam_share, dead_beams);
        factors.push_back(failed ? 0.0f : static_cast<float>(std::pow(10, error / 10)));
    }
    return factors;
}

}  // namespace insonify::sonar
