#include "components/acoustics/ElementField.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insonify::acoustics {
namespace {

constexpr long places_per_unit = 16;

}  // namespace

std::vector<double> elementWeights(size_t count, double aperture, const Taper& taper) {
    std::vector<double> weights;
    const auto terms = static_cast<size_t>(std::ceil(std::min(0.5 * static_cast<double>(count), aperture)));
    const auto size = static_cast<double>(count);
    for (size_t m = 0; m < count; ++m) {
        const double place = (static_cast<double>(m) + 0.5) / size - 0.5;
        double weight = 1;
        for (size_t n = 1; n < terms; ++n)
            weight += 2 * taper.amplitude(static_cast<double>(n)) *
                      std::cos(2 * std::numbers::pi * static_cast<double>(n) * place);
        weights.push_back(weight / size);
    }
    return weights;
}

double elementPlace(size_t element, size_t count) {
    return (static_cast<double>(element) + 0.5) / static_cast<double>(count) - 0.5;
}

ElementField::ElementField(std::span<const std::complex<double>> parts)
    : period_(static_cast<long>(parts.size()) * places_per_unit), sign_(parts.size() % 2 == 0 ? -1 : 1) {
    table_.resize(static_cast<size_t>(period_));
    for (size_t m = 0; m < parts.size(); ++m) {
        if (parts[m] == 0.0) continue;
        const double turns = elementPlace(m, parts.size()) / places_per_unit;
        const std::complex<double> step = std::polar(1.0, 2 * std::numbers::pi * turns);
        std::complex<double> turned = parts[m];
        for (size_t place = 0; place < table_.size(); ++place) {
            if (place % 256 == 0)  // so that rounding does not add up
                turned = parts[m] * std::polar(1.0, 2 * std::numbers::pi * turns * static_cast<double>(place));
            table_[place] += turned;
            turned *= step;
        }
    }
}

std::complex<double> ElementField::entry(long place) const {
    const long rest = place % period_, within = rest < 0 ? rest + period_ : rest;
    const bool is_negative = sign_ < 0 && (place - within) / period_ % 2 != 0;
    return is_negative ? -table_[static_cast<size_t>(within)] : table_[static_cast<size_t>(within)];
}

std::complex<double> ElementField::at(double u) const {
    if (table_.empty()) return 0;
    const double place = u * places_per_unit, low = std::floor(place), t = place - low;
    const long first = static_cast<long>(low);
    // Lagrange's cubic through the two places to either side.
    return entry(first - 1) * (-t * (t - 1) * (t - 2) / 6) + entry(first) * ((t + 1) * (t - 1) * (t - 2) / 2) -
           entry(first + 1) * ((t + 1) * t * (t - 2) / 2) + entry(first + 2) * ((t + 1) * t * (t - 1) / 6);
}

}  // namespace insonify::acoustics
