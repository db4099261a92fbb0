#include "components/scene/Acoustics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace insonify::scene {
namespace {

// In the order of the enums.
constexpr double kSedimentLambertDb[] = {-5.0,  -3.7,  -8.1,  -11.7, -14.2, -16.7, -19.3, -20.0,
                                         -20.0, -20.2, -20.4, -23.7, -23.7, -23.7, -23.7, -27.0};
constexpr double kReflection[] = {0.936, 0.936, 0.835, 0.91, 0.93, 0.81,  0.81,  0.69, 0.65,  0.40, 0.355,
                                  0.06,  0.37,  0.35,  0.21, 0.15, -0.02, -0.07, -0.5, -0.94, 0.39, -0.9995};
static_assert(std::size(kSedimentLambertDb) == std::size(types::EnumNames<Sediment>::names));
static_assert(std::size(kReflection) == std::size(types::EnumNames<Matter>::names));

/** Fills a described struct from values by key; collects what is wrong. */
class ValueReader {
public:
    ValueReader(const AcousticValues& values, types::Problems& problems) : values_(values), problems_(problems) {}

    template <class T>
    void operator()(const types::Field& field, std::optional<T>& value) {
        known_.emplace_back(field.name);
        if (const auto found = values_.find(field.name); found != values_.end()) read(field, found->second, value);
    }
    void refuseUnknown() {
        for (const auto& [key, value] : values_)
            if (std::ranges::count(known_, key) == 0)
                problems_.push_back({key, fmt::format("is not known; may be {}", fmt::join(known_, ", "))});
    }

private:
    void read(const types::Field& field, const AcousticValue& from, std::optional<double>& value) {
        const auto* number = std::get_if<double>(&from);
        if (number && *number >= field.min && *number <= field.max)
            value = *number;
        else
            problems_.push_back(
                {field.name, fmt::format("is {}; must be a number from {} to {}", text(from), field.min, field.max)});
    }
    template <types::NamedEnum E>
    void read(const types::Field& field, const AcousticValue& from, std::optional<E>& value) {
        const auto& names = types::EnumNames<E>::names;
        const auto* name = std::get_if<std::string>(&from);
        const auto* found = name ? std::ranges::find(names, *name) : std::end(names);
        if (found != std::end(names))
            value = static_cast<E>(found - names);
        else
            problems_.push_back({field.name, fmt::format("is {}; may be {}", text(from), fmt::join(names, ", "))});
    }
    static std::string text(const AcousticValue& value) {
        if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
        const auto* name = std::get_if<std::string>(&value);
        return name ? fmt::format("\"{}\"", *name) : "no number and no text";
    }

    const AcousticValues& values_;
    types::Problems& problems_;
    std::vector<std::string> known_;
};

}  // namespace

double lambertDb(Sediment sediment) { return kSedimentLambertDb[static_cast<size_t>(sediment)]; }

double reflection(Matter matter) { return kReflection[static_cast<size_t>(matter)]; }

double lambertDb(Matter matter) { return -9.23 + 20 * std::log10(std::abs(reflection(matter))); }

void Acoustics::applyTo(types::Material& target) const {
    if (sediment) target.lambert_db = static_cast<float>(lambertDb(*sediment));
    if (material) {
        target.lambert_db = static_cast<float>(lambertDb(*material));
        target.reflection = static_cast<float>(scene::reflection(*material));
    }
    if (lambert_db) target.lambert_db = static_cast<float>(*lambert_db);
    if (reflection) target.reflection = static_cast<float>(*reflection);
    if (roughness_slope) target.roughness_slope = static_cast<float>(*roughness_slope);
    if (reflectivity) target.reflectivity = static_cast<float>(*reflectivity);
    target.has_acoustics = true;
}

void Acoustics::check(types::Problems& problems) const {
    if (sediment && material) problems.push_back({"material", "stands beside `sediment`; give one of the two"});
}

Acoustics readAcoustics(const AcousticValues& values, types::Problems& problems) {
    Acoustics acoustics;
    ValueReader reader(values, problems);
    Acoustics::describe(acoustics, reader);
    reader.refuseUnknown();
    acoustics.check(problems);
    return acoustics;
}

}  // namespace insonify::scene
