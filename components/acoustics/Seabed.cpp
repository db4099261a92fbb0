#include "components/acoustics/Seabed.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "components/acoustics/Validity.hpp"

namespace insonify::acoustics {
namespace {

constexpr double finest_phi = 9, coarsest_phi = -1;
constexpr double water_speed_km_s = 1.528;  // speed of sound that the report's loss parameters are for

/** A name of table 2 with its mean grain size. */
struct GrainRow {
    std::string_view name;
    double phi;
};
constexpr GrainRow grains[] = {
    {"sandy_gravel", -1},      {"very_coarse_sand", -0.5},
    {"muddy_sandy_gravel", 0}, {"coarse_sand", 0.5},
    {"gravelly_sand", 0.5},    {"gravelly_muddy_sand", 1},
    {"medium_sand", 1.5},      {"muddy_gravel", 2},
    {"fine_sand", 2.5},        {"silty_sand", 2.5},
    {"muddy_sand", 3},         {"very_fine_sand", 3.5},
    {"clayey_sand", 4},        {"coarse_silt", 4.5},
    {"sandy_silt", 5},         {"gravelly_mud", 5},
    {"medium_silt", 5.5},      {"sand_silt_clay", 5.5},
    {"sandy_mud", 6},          {"silt", 6},  // as in table 3
    {"fine_silt", 6.5},        {"clayey_silt", 6.5},
    {"sandy_clay", 7},         {"very_fine_silt", 7.5},
    {"silty_clay", 8},         {"clay", 9},
};

/** A name of table 2 that has its own parameters. */
struct RockRow {
    std::string_view name;
    double speed_ratio, roughness;
};
constexpr RockRow rocks[] = {
    {"rough_rock", 2.5, 0.20693},
    {"rock", 2.5, 0.01862},
    // The report's cobble is printed illegibly: 0.0156 gives its table 3 to 0.3 dB, 0.0186 misses it by 1.7 dB.
    {"cobble", 1.8, 0.0156},
    {"gravel", 1.8, 0.0156},
};

/** Equation 2. */
double densityRatio(double m) {
    if (m < 1) return 0.007797 * m * m - 0.17057 * m + 2.3139;
    if (m < 5.3) return -0.0165406 * m * m * m + 0.2290201 * m * m - 1.1069031 * m + 3.0455;
    return -0.0012973 * m + 1.1565;
}

/** Equation 3. */
double speedRatio(double m) {
    if (m < 1) return 0.002709 * m * m - 0.056452 * m + 1.2778;
    if (m < 5.3) return -0.0014881 * m * m * m + 0.0213937 * m * m - 0.1382798 * m + 1.3425;
    return -0.0024324 * m + 1.0019;
}

/** Equation 5, after Hamilton 1972 [dB/(m kHz)]. */
double attenuation(double m) {
    if (m < 0) return 0.4556;
    if (m < 2.6) return 0.4556 + 0.0245 * m;
    if (m < 4.5) return 0.1978 + 0.1245 * m;
    if (m < 6) return 8.0399 - 2.5228 * m + 0.20098 * m * m;
    return 0.9431 - 0.2041 * m + 0.0117 * m * m;
}

/** Equations 9 and 10: from the rms relief of a track of a metre [cm^4]. */
double roughness(double m) {
    const double relief_cm = m < 5 ? (2.03846 - 0.26923 * m) / (1 + 0.076923 * m) : 0.5;
    return 0.00207 * relief_cm * relief_cm;
}

template <class Row>
const Row* find(const Row* begin, const Row* end, std::string_view name) {
    const Row* found = std::find_if(begin, end, [&](const Row& row) { return row.name == name; });
    return found == end ? nullptr : found;
}

}  // namespace

Seabed seabedOfGrainSize(double phi) {
    const double m = std::clamp(phi, coarsest_phi, finest_phi);
    Seabed seabed;
    seabed.density_ratio = densityRatio(m);
    seabed.speed_ratio = speedRatio(m);
    seabed.loss = attenuation(m) * seabed.speed_ratio * water_speed_km_s * std::numbers::ln10 / (40 * std::numbers::pi);
    seabed.volume = m < 5.5 ? 0.002 : 0.001;
    seabed.roughness = roughness(m);
    return seabed;
}

std::string outsideGrainSizes(double phi) { return outside({{"phi", phi, coarsest_phi, finest_phi}}); }

std::optional<Seabed> seabedNamed(std::string_view name) {
    if (const GrainRow* grain = find(std::begin(grains), std::end(grains), name)) return seabedOfGrainSize(grain->phi);
    if (const RockRow* rock = find(std::begin(rocks), std::end(rocks), name))
        return Seabed{2.5, rock->speed_ratio, 0.01374, 0.002, rock->roughness, 3.25};
    return {};
}

std::optional<double> grainSizeNamed(std::string_view name) {
    const GrainRow* grain = find(std::begin(grains), std::end(grains), name);
    return grain ? std::optional(grain->phi) : std::nullopt;
}

std::vector<std::string> seabedNames() {
    std::vector<std::string> names;
    for (const RockRow& rock : rocks) names.emplace_back(rock.name);
    for (const GrainRow& grain : grains) names.emplace_back(grain.name);
    return names;
}

}  // namespace insonify::acoustics
