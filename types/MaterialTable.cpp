#include "types/MaterialTable.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace insonify::types {
namespace {

struct Row {
    std::string_view name;
    double value;
};

/// Lambert parameter [dB].
constexpr Row sediments[] = {
    {"rough_rock", -5.0},      {"rock", -5.0},
    {"cobble", -8.1},          {"sandy_gravel", -11.7},
    {"coarse_sand", -14.2},    {"medium_sand", -16.7},
    {"fine_sand", -19.3},      {"muddy_sand", -20.0},
    {"very_fine_sand", -20.0}, {"coarse_silt", -20.2},
    {"sandy_silt", -20.4},     {"medium_silt", -23.7},
    {"fine_silt", -23.7},      {"very_fine_silt", -23.7},
    {"silty_clay", -23.7},     {"clay", -23.7},
    {"mackenzie", -27.0},
};

/// Pressure reflection coefficient at normal incidence [1]; the middle where the literature gives a span.
constexpr Row solids[] = {
    {"steel", 0.936},
    {"carbon_steel", 0.936},
    {"bronze", 0.93},
    {"cast_iron", 0.91},
    {"aluminium", 0.835},
    {"granite", 0.81},
    {"basalt", 0.81},
    {"concrete", 0.69},
    {"limestone", 0.65},
    {"gravel", 0.40},
    {"ice", 0.39},
    {"pvc", 0.37},
    {"sand", 0.355},
    {"acrylic", 0.35},
    {"hdpe", 0.21},
    {"neoprene", 0.15},
    {"mud", 0.06},
    {"natural_rubber", -0.02},
    {"waterlogged_wood", -0.07},
    {"dry_wood", -0.5},
    {"closed_cell_foam", -0.94},
    {"air", -0.9995},
};

constexpr double smooth_sphere_db = -9.23;  ///< 10 log10(3 / (8 pi)).

const Row* find(std::span<const Row> table, std::string_view name) {
    const auto row = std::ranges::find(table, name, &Row::name);
    return row == table.end() ? nullptr : &*row;
}

std::vector<std::string> names(std::span<const Row> table) {
    std::vector<std::string> all;
    for (const Row& row : table) all.emplace_back(row.name);
    return all;
}

}  // namespace

bool applySediment(std::string_view name, Material& material) {
    const Row* row = find(sediments, name);
    if (!row) return false;
    material.lambert_db = static_cast<float>(row->value);
    material.has_acoustics = true;
    return true;
}

bool applyMaterial(std::string_view name, Material& material) {
    const Row* row = find(solids, name);
    if (!row) return false;
    material.reflection = static_cast<float>(row->value);
    material.lambert_db = static_cast<float>(smooth_sphere_db + 20 * std::log10(std::abs(row->value)));
    material.has_acoustics = true;
    return true;
}

std::vector<std::string> sedimentNames() { return names(sediments); }
std::vector<std::string> materialNames() { return names(solids); }

}  // namespace insonify::types
