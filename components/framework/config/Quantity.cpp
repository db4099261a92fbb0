#include "components/framework/config/Quantity.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

namespace insonify::framework {
namespace {

struct Named {
    std::string_view name;
    Unit unit;
};
constexpr Named units[] = {
    {"m", {1, 0, {1, 0, 0, 0, 0}}},    {"g", {1e-3, 0, {0, 1, 0, 0, 0}}},
    {"s", {1, 0, {0, 0, 1, 0, 0}}},    {"K", {1, 0, {0, 0, 0, 1, 0}}},
    {"rad", {1, 0, {0, 0, 0, 0, 1}}},  {"deg", {std::numbers::pi / 180, 0, {0, 0, 0, 0, 1}}},
    {"Hz", {1, 0, {0, 0, -1, 0, 0}}},  {"N", {1, 0, {1, 1, -2, 0, 0}}},
    {"Pa", {1, 0, {-1, 1, -2, 0, 0}}}, {"bar", {1e5, 0, {-1, 1, -2, 0, 0}}},
};
constexpr std::pair<std::string_view, double> prefixes[] = {{"", 1},     {"M", 1e6},   {"k", 1e3},  {"d", 1e-1},
                                                            {"c", 1e-2}, {"mu", 1e-6}, {"m", 1e-3}, {"u", 1e-6},
                                                            {"n", 1e-9}, {"p", 1e-12}};

std::optional<Unit> prefixed(std::string_view name) {
    for (const auto& [prefix, factor] : prefixes)
        for (const Named& named : units) {
            if (name.size() != prefix.size() + named.name.size()) continue;
            if (!name.starts_with(prefix) || !name.ends_with(named.name)) continue;
            Unit unit = named.unit;
            unit.scale *= factor;
            return unit;
        }
    return std::nullopt;
}

Unit product(const Unit& a, const Unit& b, int power) {
    Unit unit{a.scale * std::pow(b.scale, power), 0, a.dimension};
    for (size_t i = 0; i < unit.dimension.size(); ++i) unit.dimension[i] += power * b.dimension[i];
    return unit;
}

/** "m", "s^-1" */
std::optional<Unit> powered(std::string_view text) {
    const size_t hat = text.find('^');
    const auto unit = prefixed(text.substr(0, hat));
    if (!unit || hat == std::string_view::npos) return unit;
    int power = 0;
    const char *begin = text.data() + hat + 1, *end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(begin, end, power);
    if (error != std::errc() || stop != end || std::abs(power) > 9) return std::nullopt;
    return product(Unit{}, *unit, power);
}

/** Takes "3.5" from the front of "3.5.m"; false when there is no number followed by a point and a name. */
bool consumeNumber(std::string_view& text, double& number) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || !std::isfinite(number)) return false;
    text.remove_prefix(static_cast<size_t>(stop - text.data()));
    if (*(stop - 1) == '.') return !text.empty();  // "20." in "20.deg" is also a number
    if (text.size() < 2 || text.front() != '.') return false;
    text.remove_prefix(1);
    return true;
}

}  // namespace

std::optional<Unit> unitOf(std::string_view name) {
    if (name == "1") return Unit{};
    if (name == "degC") return Unit{1, 273.15, {0, 0, 0, 1, 0}};
    const size_t slash = name.find('/');
    const auto above = powered(name.substr(0, slash));
    if (!above || slash == std::string_view::npos) return above;
    const auto below = powered(name.substr(slash + 1));
    return below ? std::optional(product(*above, *below, -1)) : std::nullopt;
}

std::optional<Quantity> Quantity::parse(std::string_view text) {
    Quantity quantity;
    if (!consumeNumber(text, quantity.number)) return std::nullopt;
    while (!text.empty()) {
        const size_t end = std::min(text.find('.'), text.size());
        const std::string_view word = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (text.empty() && (word == "round" || word == "floor" || word == "ceil")) {
            quantity.rounding = word.front();
            return quantity;
        }
        const auto unit = powered(word);
        if (!unit) return std::nullopt;
        quantity.unit = product(quantity.unit, *unit, 1);
    }
    return quantity;
}

std::optional<double> Quantity::in(const Unit& other) const {
    if (unit.dimension != other.dimension) return std::nullopt;
    const bool same = unit.scale == other.scale && unit.zero == other.zero;  // no digit changes
    const double converted = same ? number : (number * unit.scale + unit.zero - other.zero) / other.scale;
    if (rounding == 'r') return std::round(converted);
    if (rounding == 'f') return std::floor(converted);
    return rounding == 'c' ? std::ceil(converted) : converted;
}

}  // namespace insonify::framework
