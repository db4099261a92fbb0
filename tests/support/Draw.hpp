#pragma once
// Random numbers of property tests, and how many cases are drawn.
#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <random>

namespace insonify::test {

/** Numbers of a seed, the same on every machine. */
class Draw {
public:
    explicit Draw(uint64_t seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    int upTo(int count) { return static_cast<int>(between(0, count)); }
    bool once(int in) { return upTo(in) == 0; }
    template <size_t N>
    const char* oneOf(const char* const (&all)[N]) {
        return all[upTo(N)];
    }

private:
    std::mt19937_64 engine_;
};

/** Seeds of the cases that a test draws: `few` of them from 1 on. INSONIFY_DRAWS draws more in a campaign, and
 *  INSONIFY_DRAWS_FROM begins at another seed. */
struct Seeds {
    uint64_t first = 1, count;

    explicit Seeds(uint64_t few) : count(few) {
        if (const char* more = std::getenv("INSONIFY_DRAWS")) count = std::strtoull(more, nullptr, 10);
        if (const char* from = std::getenv("INSONIFY_DRAWS_FROM")) first = std::strtoull(from, nullptr, 10);
    }
    uint64_t end() const { return first + count; }
};

}  // namespace insonify::test
