#pragma once
#include <array>
#include <cstdint>

namespace insonify::framework {

/** Durations in a histogram of 1 % steps from 0.1 us to 1000 s: adding never allocates; quantiles are within 1 %. */
class Statistics {
public:
    void add(double seconds);
    uint64_t count() const { return count_; }
    double median() const { return quantile(0.5); }
    double p99() const { return quantile(0.99); }
    double max() const { return max_; }
    /** Smallest duration that a share `q` of all does not exceed [s]; 0 when there is none. */
    double quantile(double q) const;

private:
    static constexpr int steps = 2315;  // ln(1e10) / ln(1.01)
    std::array<uint32_t, steps> histogram_{};
    uint64_t count_ = 0;
    double max_ = 0;
};

}  // namespace insonify::framework
