#include "components/noise/GammaTable.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

namespace insonify::noise {
namespace {

constexpr int steps = 8192;
constexpr double tail = 32;  ///< exp(-tail) is below the smallest tail of the table.

/** Shares of the law below and above points of y = ln x, evenly spaced. */
struct Shares {
    double low, step;
    std::vector<double> below, above;
    double y(size_t i) const { return low + step * static_cast<double>(i); }
};

/** Returns y where shape (1 + y - exp(y)) = -tail. By Chernoff's bound less than exp(-tail) of the law is farther
 *  out. */
double endOf(double shape, double inside, double outside) {
    for (int i = 0; i < 200; ++i) {
        const double y = (inside + outside) / 2;
        (shape * (1 + y - std::exp(y)) > -tail ? inside : outside) = y;
    }
    return outside;
}

/** Integrates the density of y = ln x of a gamma variate x of unit mean, by Simpson's rule over each step. */
Shares sharesOf(double shape) {
    constexpr double minimum = -90;  // exp(-90) is as good as 0 in a float
    const double low = endOf(shape, 0, minimum), high = endOf(shape, 0, 40);
    const double scale = shape * std::log(shape) - std::lgamma(shape);
    const auto density = [&](double y) { return std::exp(scale + shape * (y - std::exp(y))); };
    Shares shares{low, (high - low) / steps, std::vector<double>(steps + 1), std::vector<double>(steps + 1)};
    // Beyond `low` the density falls as exp(shape (1 - x) y) or faster.
    shares.below[0] = density(low) / (shape * (1 - std::exp(low)));
    std::vector<double> parts(steps);
    for (size_t i = 0; i < steps; ++i) {
        const double from = shares.y(i), to = shares.y(i + 1);
        parts[i] = shares.step / 6 * (density(from) + 4 * density((from + to) / 2) + density(to));
        shares.below[i + 1] = shares.below[i] + parts[i];
    }
    for (size_t i = steps; i-- > 0;) shares.above[i] = shares.above[i + 1] + parts[i];
    return shares;
}

/** Returns the y between points `i` and `i` + 1 where ln of the share is `wanted`. */
double between(const Shares& shares, const std::vector<double>& share, size_t i, double wanted) {
    const double from = std::log(share[i]), to = std::log(share[i + 1]);
    return shares.y(i) + shares.step * std::clamp((wanted - from) / (to - from), 0.0, 1.0);
}

/** Returns the y above which the share is exp(-t). Uses the smaller of the two shares, which is more accurate. */
double quantile(const Shares& shares, double t) {
    const bool is_low = t < 0.6931;
    const double wanted = is_low ? std::log(-std::expm1(-t)) : -t, share = std::exp(wanted);
    if (is_low && share <= shares.below[0]) return -std::numeric_limits<double>::infinity();
    const std::vector<double>& known = is_low ? shares.below : shares.above;
    const auto found = is_low ? std::lower_bound(known.begin(), known.end(), share)
                              : std::lower_bound(known.begin(), known.end(), share, std::greater<>());
    const auto i = static_cast<size_t>(std::clamp<std::ptrdiff_t>(found - known.begin() - 1, 0, steps - 2));
    return between(shares, known, i, wanted);
}

}  // namespace

GammaTable::GammaTable(double shape) {
    const Shares shares = sharesOf(shape);
    constexpr float minimum = std::numeric_limits<float>::min();  // smaller numbers are slow, and as good as 0
    for (int32_t bits = first_bits; bits <= last_bits; bits += cell_size) {
        const double y = quantile(shares, static_cast<double>(std::bit_cast<float>(bits)));
        const auto x = static_cast<float>(std::exp(y));
        table_.push_back(x < minimum ? 0.0f : x);
    }
}

}  // namespace insonify::noise
