#include "components/scene/SurfaceMaps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "components/scene/Acoustics.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::scene {
namespace {

/** Returns the class of a text; none if it is not a whole number from 0 to 254. */
std::optional<uint8_t> getValue(const std::string& text) {
    int value = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > 254 ||
        text != std::to_string(value))  // 1 and 01 would be the same class
        return {};
    return static_cast<uint8_t>(value);
}

template <class E>
std::optional<E> named(const std::string& name) {
    const auto& names = types::EnumNames<E>::names;
    const auto* found = std::ranges::find(names, name);
    if (found == std::end(names)) return {};
    return static_cast<E>(found - names);
}

double linear(double decibels) { return std::pow(10, decibels / 10); }

}  // namespace

void MapValues::check(types::Diagnostics& diagnostics) const {
    if (decibels.empty() == classes.empty())
        return diagnostics.push_back(
            {"", fmt::format("has {} decibels {} classes; must have one of the two",
                             classes.empty() ? "neither" : "both", classes.empty() ? "nor" : "and")});
    if (!decibels.empty() && decibels.size() != 2)
        diagnostics.push_back({"decibels", fmt::format("has {} numbers; must have two", decibels.size())});
    if (values.size() != 2 || !(values[0] != values[1]))
        diagnostics.push_back({"values", "must be two numbers that differ"});
    if (classes.size() > max_classes)
        diagnostics.push_back({"classes", fmt::format("are {}; at most {}", classes.size(), max_classes)});
    for (const auto& [value, name] : classes)
        if (!getValue(value))
            diagnostics.push_back({"classes", fmt::format("has {}; a class is a whole number from 0 to 254", value)});
}

float MapValues::strengthAt(double value) const {
    if (decibels.empty() || std::isnan(value)) return 1;
    const double share = std::clamp((value - values[0]) / (values[1] - values[0]), 0.0, 1.0);
    return static_cast<float>(linear(decibels[0] + share * (decibels[1] - decibels[0])));
}

float MapValues::maxStrength() const {
    return decibels.empty() ? 1.0f : static_cast<float>(linear(std::max(decibels[0], decibels[1])));
}

types::SurfaceMap surfaceMap(std::span<const float> values, int width, int height, const MapValues& meaning,
                             std::vector<int> materials) {
    types::SurfaceMap map;
    map.width = width, map.height = height;
    if (meaning.classes.empty()) {
        map.strengths.reserve(values.size());
        for (const float value : values) map.strengths.push_back(meaning.strengthAt(static_cast<double>(value)));
        return map;
    }
    std::map<float, uint8_t> numbers;
    for (const auto& [value, name] : meaning.classes) {
        const auto number = static_cast<uint8_t>(numbers.size());
        numbers[getValue(value).value_or(0)] = number;
    }
    map.materials = std::move(materials);
    map.classes.reserve(values.size());
    for (const float value : values) {
        const auto known = std::isnan(value) ? numbers.end() : numbers.find(value);  // NaN equals any key
        map.classes.push_back(known == numbers.end() ? types::SurfaceMap::no_class : known->second);
    }
    return map;
}

std::vector<int> getMaterials(const MapValues& meaning, const std::string& path, types::Geometry& geometry,
                              types::Diagnostics& diagnostics) {
    std::vector<int> materials;
    for (const auto& [value, name] : meaning.classes) {
        const auto known = std::ranges::find(geometry.materials, name, &types::Material::name);
        materials.push_back(static_cast<int>(known - geometry.materials.begin()));
        if (known != geometry.materials.end()) continue;
        Acoustics acoustics;
        acoustics.sediment = named<Sediment>(name);
        if (!acoustics.sediment) acoustics.material = named<Matter>(name);
        if (!acoustics.sediment && !acoustics.material) {
            std::vector<std::string> names(std::begin(types::EnumNames<Sediment>::names),
                                           std::end(types::EnumNames<Sediment>::names));
            names.insert(names.end(), std::begin(types::EnumNames<Matter>::names),
                         std::end(types::EnumNames<Matter>::names));
            for (const types::Material& material : geometry.materials)
                if (std::ranges::count(names, material.name) == 0) names.push_back(material.name);
            diagnostics.push_back(
                {path + "." + value,
                 fmt::format("is {}; {}may be {}", name, types::didYouMean(name, names), fmt::join(names, ", "))});
            continue;
        }
        types::Material material;
        material.name = name;
        acoustics.applyTo(material);
        geometry.materials.push_back(std::move(material));
    }
    return materials;
}

}  // namespace insonify::scene
