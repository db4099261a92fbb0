#pragma once
// Random numbers of a place, and phases of fields, for vectorised loops: without function calls. To be included only by
// files that are compiled without contraction.
#include <cmath>
#include <cstdint>

#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {

/** A fixed 32-bit integer hash (C. Wellons' lowbias32). */
inline uint32_t mixed(uint32_t x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

/** Returns the number of a square or cube of a lattice at any place; it wraps round after 2^32. */
inline uint32_t makeSquare(double whole) {
    return static_cast<uint32_t>(static_cast<int64_t>(std::fmod(whole, 4294967296.0)));
}

/** Rounds to the nearest whole number, for less than 2^22, without a call. */
inline float nearest(float x) { return (x + 12582912.0f) - 12582912.0f; }

/** Returns a uniform number in (0, 1) of 16 bits. */
inline float uniform(uint32_t bits) {
    return (static_cast<float>(static_cast<int32_t>(bits & 0xffffu)) + 0.5f) * 0x1p-16f;
}

inline float logarithm(float x) {
    const types::PowersOfTwo parts = types::split(x);
    return types::log1pSmall(parts.rest) + 0.693147181f * static_cast<float>(parts.powers);
}

/** Return sine and cosine of turns within [-1/2, 1/2]; polynomials at Chebyshev's points, within 1e-6. */
inline float computeSine(float turns) {
    const float s = turns * turns;
    float sum = 3.19933885f;
    sum = sum * s + -14.8683228f;
    sum = sum * s + 42.0160758f;
    sum = sum * s + -76.7015377f;
    sum = sum * s + 81.6050236f;
    sum = sum * s + -41.341697f;
    return turns * (sum * s + 6.28318527f);
}
inline float computeCosine(float turns) {
    const float s = turns * turns;
    float sum = 6.52865816f;
    sum = sum * s + -25.9675992f;
    sum = sum * s + 60.167631f;
    sum = sum * s + -85.4501395f;
    sum = sum * s + 64.9391175f;
    sum = sum * s + -19.7392045f;
    return sum * s + 0.999999989f;
}

}  // namespace insonify::sonar
