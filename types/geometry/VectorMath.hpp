#pragma once
// Arithmetic for loops that the compiler turns into vector code: no branches, no library calls.
#include <bit>
#include <cstdint>

// Compiles a function in versions for vectors of 512, 256 and 128 bits; the best version for the processor runs.
// Without contraction (-ffp-contract=off) all give the same bits. Not used with sanitizers, because the choice of a
// version would run before they are initialised.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define INSONIFY_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define INSONIFY_VECTOR_CLONES
#endif

namespace insonify::types {

/** Returns ln(1 + x) for x in [sqrt(1/2) - 1, sqrt(2) - 1], to a relative error of 1e-7 (minimax polynomial of Cephes'
 *  logf). */
inline float log1pSmall(float x) {
    constexpr float coefficients[] = {-1.1514610310e-1f, 1.1676998740e-1f, -1.2420140846e-1f, 1.4249322787e-1f,
                                      -1.6668057665e-1f, 2.0000714765e-1f, -2.4999993993e-1f, 3.3333331174e-1f};
    float sum = 7.0376836292e-2f;
    for (const float coefficient : coefficients) sum = sum * x + coefficient;
    const float square = x * x;
    return x + (x * square * sum - 0.5f * square);
}

/** A number (1 + rest) 2^powers with rest in [sqrt(1/2) - 1, sqrt(2) - 1]. */
struct PowersOfTwo {
    float rest;
    int32_t powers;
};

/** Splits a positive, finite float of full precision (at least 1.2e-38). */
inline PowersOfTwo split(float x) {
    constexpr int32_t half_root = 0x3F3504F3;  // bits of sqrt(1/2)
    const int32_t bits = std::bit_cast<int32_t>(x) - half_root;
    return {std::bit_cast<float>((bits & 0x007FFFFF) + half_root) - 1.0f, bits >> 23};
}

/** Returns 10 log10(x) [dB] of a positive, finite float, accurate to 2e-5 dB. */
inline float decibels(float x) {
    constexpr float per_ln = 4.3429448f, per_power = 3.0102999566f;
    const bool is_small = x < 0x1p-100f;
    const PowersOfTwo parts = split(is_small ? x * 0x1p64f : x);
    return per_ln * log1pSmall(parts.rest) + per_power * static_cast<float>(parts.powers - (is_small ? 64 : 0));
}

/** Returns e^x for x up to 88, to the last bit of a float in all but some of 10^4 cases. */
inline float exponential(float x) {
    constexpr double per_ln2 = 1.4426950408889634, ln2 = 0.6931471805599453;
    constexpr double whole_bits = 0x1.8p52;  // a sum with it has whole numbers in its low bits
    const double at = double{x} < -200 ? -200 : double{x};
    const double shifted = at * per_ln2 + whole_bits, rest = at - (shifted - whole_bits) * ln2;
    constexpr double coefficients[] = {1.0 / 362880, 1.0 / 40320, 1.0 / 5040, 1.0 / 720, 1.0 / 120,
                                       1.0 / 24,     1.0 / 6,     1.0 / 2,    1,         1};
    double sum = 1.0 / 3628800;  // of Taylor's series, within 1e-12
    for (const double coefficient : coefficients) sum = sum * rest + coefficient;
    return static_cast<float>(
        std::bit_cast<double>((std::bit_cast<uint64_t>(shifted) << 52) + std::bit_cast<uint64_t>(sum)));
}

}  // namespace insonify::types
