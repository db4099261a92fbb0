#pragma once
// Counter-based random numbers without state: elements may be computed in any order. All functions are written for
// loops that the compiler turns into vector code.
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "types/geometry/VectorMath.hpp"

namespace insonify::noise {

using Counter = std::array<uint32_t, 4>;
using Key = std::array<uint32_t, 2>;

/** The part of Philox's counter and key that is the same for all numbers of a beam; bin and stream are the rest. */
struct BeamKey {
    Key seed;
    uint32_t beam;
    uint32_t ping_low, ping_high;
};

/** Returns four words of 32 random bits for a counter and a key, by Philox4x32-10. J. Salmon et al., "Parallel random
 *  numbers: as easy as 1, 2, 3", SC 2011. */
inline Counter philox(Counter counter, Key key) {
    for (int round = 0; round < 10; ++round) {
        const uint64_t first = uint64_t{0xD2511F53} * counter[0];
        const uint64_t third = uint64_t{0xCD9E8D57} * counter[2];
        counter = {static_cast<uint32_t>(third >> 32) ^ counter[1] ^ key[0], static_cast<uint32_t>(third),
                   static_cast<uint32_t>(first >> 32) ^ counter[3] ^ key[1], static_cast<uint32_t>(first)};
        key[0] += 0x9E3779B9;
        key[1] += 0xBB67AE85;
    }
    return counter;
}

/** Returns -ln(u) for u = (bits + 0.5) / 2^32: exponentially distributed with unit mean, in [1.2e-10, 22.9], to a
 *  relative error of 1e-6. */
inline float exponential(uint32_t bits) {
    constexpr uint32_t half_root = 0xB504F333;  // 2^32 sqrt(1/2): above it 1 - u is small, and exact from ~bits
    const float above = -(static_cast<float>(~bits) + 0.5f) * 0x1p-32f;
    // Smaller u is split into 2^exponent and a mantissa in [sqrt(1/2), sqrt(2)).
    const float u = (static_cast<float>(bits) + 0.5f) * 0x1p-32f;
    const types::PowersOfTwo parts = types::split(u);
    const bool near_one = bits >= half_root;
    const float x = near_one ? above : parts.rest;
    const float powers = near_one ? 0.0f : static_cast<float>(parts.powers);
    return -(types::log1pSmall(x) + powers * 0.69314718f);
}

struct Normals {
    float first, second;
};

/** Returns two independent variates of N(0, 1), at most 6.8 from 0 (Box and Muller 1958). */
inline Normals normals(uint32_t radius_bits, uint32_t angle_bits) {
    const float radius = std::sqrt(2.0f * exponential(radius_bits));
    // The angle is 2 pi angle_bits / 2^32: the nearest quarter turn and a rest within pi / 4 of it.
    const uint32_t quarter = (angle_bits + 0x20000000u) >> 30;
    const float rest = (static_cast<float>(static_cast<int32_t>(angle_bits - (quarter << 30))) + 0.5f) *
                       static_cast<float>(std::numbers::pi * 0x1p-31);
    const float square = rest * rest;
    const float sine =
        rest + rest * square * ((-1.9515295891e-4f * square + 8.3321608736e-3f) * square - 1.6666654611e-1f);
    const float cosine =
        1.0f - 0.5f * square +
        square * square * ((2.443315711809948e-5f * square - 1.388731625493765e-3f) * square + 4.166664568298827e-2f);
    const bool swapped = quarter & 1;
    const float along = swapped ? sine : cosine;
    const float across = swapped ? cosine : sine;
    const float along_sign = ((quarter + 1) & 2) ? -radius : radius;
    const float across_sign = (quarter & 2) ? -radius : radius;
    return {along * along_sign, across * across_sign};
}

}  // namespace insonify::noise
