#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace insonify::types {

/** Mixes the bits of a word by the finaliser of SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number
 *  generators", 2014). */
inline uint64_t mixedBits(uint64_t x) {
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/** Returns a random word that depends only on the seed of a stream and a place (a, b) in it. */
inline uint64_t hashed(uint64_t seed, uint64_t a, uint64_t b) {
    constexpr uint64_t golden = 0x9e3779b97f4a7c15u;
    return mixedBits(mixedBits(mixedBits(seed + golden) + a * golden + 1) + b * golden);
}

/** Returns a random word that depends only on a name and a number of it. */
inline uint64_t hashedName(std::string_view name, uint64_t number = 0) {
    uint64_t hash = number;
    for (const char letter : name) hash = hashed(hash, static_cast<unsigned char>(letter), 0);
    return hash;
}

/** Returns 32 random bits as a number in (0, 1), ends excluded. */
inline double unit(uint64_t bits32) { return (static_cast<double>(bits32) + 0.5) * 0x1p-32; }

/** Returns 64 random bits as a variate of N(0, 1) (Box and Muller 1958). */
inline double normal(uint64_t bits) {
    return std::sqrt(-2 * std::log(unit(bits >> 32))) * std::cos(2 * std::numbers::pi * unit(bits & 0xffffffff));
}

}  // namespace insonify::types
