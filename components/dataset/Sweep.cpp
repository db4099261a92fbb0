#include "components/dataset/Sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "types/text/Hash.hpp"

namespace insonify::dataset {
namespace {

constexpr double millionths = 1e6;

double inMillionths(double value) { return std::round(value * millionths) / millionths; }

/** Checks that "x" is [min, max] or absent. */
void checkSpan(const char* name, const auto& span, bool needed, types::Diagnostics& diagnostics) {
    if (span.empty() && needed) diagnostics.push_back({name, "is missing; give [min, max]"});
    if (!span.empty() && (span.size() != 2 || span[1] < span[0]))
        diagnostics.push_back({name, span.size() == 2 ? "must be [min, max], the min not above the max"
                                                      : "must be two numbers, [min, max]"});
}

}  // namespace

uint64_t Axis::stepCount() const { return count ? *count : std::max<uint64_t>(1, values.size()); }

double Axis::step(uint64_t number) const {
    if (!count) return values.empty() ? 0 : values[number];
    if (*count == 1) return *from;
    return *from + (*to - *from) * static_cast<double>(number) / static_cast<double>(*count - 1);
}

double Axis::draw(uint64_t random) const {
    const double first = types::unit(random >> 32), second = types::unit(random & 0xffffffff);
    if (!uniform.empty()) return inMillionths(uniform[0] + (uniform[1] - uniform[0]) * first);
    if (normal.empty()) return step(0);
    const double variate = std::sqrt(-2 * std::log(first)) * std::cos(2 * std::numbers::pi * second);
    return inMillionths(normal[0] + normal[1] * variate);
}

void Axis::check(types::Diagnostics& diagnostics) const {
    const int ways = (from || to || count) + !uniform.empty() + !normal.empty();
    if (ways > 1) diagnostics.push_back({"", "is given in several ways; steps, uniform or normal"});
    if (ways == 0 && values.empty())
        diagnostics.push_back({"", "is empty; give a number, a list, {from, to, count}, {uniform} or {normal}"});
    if ((from || to || count) && !(from && to && count))
        diagnostics.push_back({"", "needs all of from, to and count for steps"});
    checkSpan("uniform", uniform, false, diagnostics);
    if (!normal.empty() && (normal.size() != 2 || normal[1] < 0))
        diagnostics.push_back({"normal", "must be two numbers, [mean, deviation], the deviation not below 0"});
}

std::string DrawnSetting::draw(uint64_t random) const {
    return choice.empty() ? fmt::format("{}", law.draw(random)) : choice[random % choice.size()].yaml;
}

uint64_t PoseAxes::gridSize() const {
    uint64_t size = 1;
    forEach(*this, [&](const char*, const char*, const Axis& axis) {
        size = std::min<uint64_t>(size * axis.stepCount(), 1'000'000'000'000);
    });
    return size;
}

void TrajectoryPoses::check(types::Diagnostics& diagnostics) const {
    times.check(diagnostics);
    if (file.empty()) diagnostics.push_back({"", "has no file"});
    if (count.has_value() == period.has_value())
        diagnostics.push_back({"", "must have one of count and period, which set the number of poses"});
    if (from && to && *to < *from)
        diagnostics.push_back({"to", fmt::format("is {:g} s; must not be before from, {:g} s", *to, *from)});
}

void ObjectGroup::check(types::Diagnostics& diagnostics) const {
    if (names.empty()) diagnostics.push_back({"names", "is missing; give names of nodes of the scene"});
    checkSpan("x", x, true, diagnostics);
    checkSpan("y", y, true, diagnostics);
    checkSpan("z", z, false, diagnostics);
    checkSpan("roll_deg", roll_deg, false, diagnostics);
    checkSpan("pitch_deg", pitch_deg, false, diagnostics);
    checkSpan("yaw_deg", yaw_deg, false, diagnostics);
    checkSpan("scale", scale, false, diagnostics);
    checkSpan("count", count, false, diagnostics);
    for (const auto& [name, span] :
         {std::pair{"roll_deg", &roll_deg}, {"pitch_deg", &pitch_deg}, {"yaw_deg", &yaw_deg}})
        if (any_turn && !span->empty())
            diagnostics.push_back({name, "is given with any_turn; only one may set the turn"});
    if (ground && !z.empty()) diagnostics.push_back({"ground", "is given with z; only one may set the height"});
}

Part Split::of(uint64_t seed, uint64_t index) const {
    constexpr uint64_t stream = 0x73706c6974;
    const double place = types::unit(types::hashed(seed, index, stream) >> 32);
    if (place < train) return Part::Train;
    return place < train + val || test == 0 ? Part::Val : Part::Test;
}

void Split::check(types::Diagnostics& diagnostics) const {
    const double sum = train + val + test;
    if (std::abs(sum - 1) > 1e-9)
        diagnostics.push_back({"", fmt::format("adds up to {:g}; train, val and test must add up to 1", sum)});
}

bool matches(const std::string& pattern, const std::string& name) {
    // The position after the last *, and the end of the text that it matched: if the rest does not match, it takes one
    // more letter.
    size_t p = 0, n = 0, star = std::string::npos, taken = 0;
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = ++p, taken = n;
        } else if (p < pattern.size() && pattern[p] == name[n]) {
            ++p, ++n;
        } else if (star != std::string::npos) {
            p = star, n = ++taken;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

}  // namespace insonify::dataset
