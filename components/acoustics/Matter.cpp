#include "components/acoustics/Matter.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "components/acoustics/Seabed.hpp"

namespace insonify::acoustics {
namespace {

/** Ratio of the equivalent sand grain of pipes (Moody 1944) to the rms height of the surface: Adams et al. 2012 [1]. */
constexpr double sand_over_rms = 3.1;
constexpr double rms(double sand_grain) { return sand_grain / sand_over_rms; }

/** Ratio of correlation length to rms height for surfaces without a published length: decided here [1]. */
constexpr double length_over_rms = 10;

/** Ratio of rms height to diameter of a row of round strands: that of a half circle about its mean [1]. */
const double strand_rms = std::sqrt(2.0 / 3 - std::pow(std::numbers::pi / 4, 2)) / 2;
constexpr double strand_length = 0.25;                    ///< Correlation length over diameter [1].
constexpr double rope_strand = 0.010, net_twine = 0.002;  ///< Diameters [m].

/** Returns the rms height of rock for wavelengths up to `longest` [m], by the spectrum w_2 K^-gamma of APL-UW TR
 *  9407. */
double rockRms(double longest) {
    const Seabed rock = seabedNamed("rock").value();
    const double lowest = 2 * std::numbers::pi / (100 * longest), over = rock.roughness_slope - 2;  // [rad/cm], [1]
    return std::sqrt(2 * std::numbers::pi * rock.roughness * std::pow(lowest, -over) / over) / 100;
}
constexpr double computeLength(double longest) { return longest / (2 * std::numbers::pi); }
constexpr double longest_of_bed = 1, longest_of_block = 0.1;  ///< [m]

/** A solid whose grains or fibres are mixed with water. */
struct Mixed {
    double density, modulus;  ///< [kg/m^3], [Pa]
};
constexpr Mixed calcite{2710, 70e9}, cell_wall{1500, 10e9};

/** Returns the speed of sound [m/s] of a mixture of water and a solid of a density [kg/m^3], by Wood's equation
 *  (1955). */
double mixtureSpeed(double density, const Mixed& solid) {
    constexpr double water = 1025, water_speed = 1500;
    const double share = (density - water) / (solid.density - water);
    return 1 / std::sqrt(density * ((1 - share) / (water * water_speed * water_speed) + share / solid.modulus));
}
constexpr double fouling_density = 1400, paper_density = (1025 + cell_wall.density) / 2;  ///< [kg/m^3]

constexpr std::string_view none = "not known";
constexpr std::string_view moody = "Moody 1944, by Adams et al. 2012; length decided here";
constexpr std::string_view report = "APL-UW 1994, rock";

const MatterProperties table[] = {
    // clang-format off
    {Matter::Steel, 0.936, 7850, 5900, 3230, 1e-4, rms(46e-6), length_over_rms * rms(46e-6), true,
     "ASTM E494 2015, density Haynes 2014", moody},
    {Matter::CarbonSteel, 0.936, 7850, 5900, 3230, 1e-4, rms(400e-6), length_over_rms * rms(400e-6), true,
     "ASTM E494 2015, density Haynes 2014", "Idelchik 2007, corroded steel, by Adams et al. 2012; length decided here"},
    {Matter::Aluminium, 0.835, 2700, 6320, 3130, 1e-4, rms(1.5e-6), length_over_rms * rms(1.5e-6), true,
     "Haynes 2014, speeds of duralumin", moody},
    {Matter::CastIron, 0.91, 7200, 4600, 2650, 1e-3, rms(260e-6), length_over_rms * rms(260e-6), true,
     "ASTM E494 2015, middle of its range", moody},
    {Matter::Bronze, 0.93, 8860, 4500, 2230, 1e-3, rms(1.5e-6), length_over_rms * rms(1.5e-6), true,
     "ASTM E494 2015, compressional speed typical", moody},
    {Matter::Granite, 0.81, 2650, 5500, 3000, 2e-3, rockRms(longest_of_block), computeLength(longest_of_block), true,
     "Carmichael 1989", report},
    {Matter::Basalt, 0.81, 2700, 5400, 3000, 2e-3, rockRms(longest_of_block), computeLength(longest_of_block), true,
     "Carmichael 1989", report},
    {Matter::Concrete, 0.69, 2300, 3700, 2200, 1e-2, rms(1e-3), length_over_rms * rms(1e-3), true,
     "Malhotra and Carino 2004", moody},
    {Matter::Limestone, 0.65, 2400, 3000, 1700, 1e-2, rockRms(longest_of_block), computeLength(longest_of_block), true,
     "Jensen et al. 2011", report},
    {Matter::Gravel, 0.40, 2000, 1800, 180, 0.011, 0, 0, false, "Jensen et al. 2011", none},
    {Matter::Sand, 0.355, 1900, 1650, 110, 0.0147, 0, 0, false, "Jensen et al. 2011", none},
    {Matter::Mud, 0.06, 1174, 1470, 0, 0.001, 0, 0, false, "APL-UW 1994, clay", none},
    {Matter::Pvc, 0.37, 1380, 2400, 1060, 1e-2, rms(1.5e-6), length_over_rms * rms(1.5e-6), true,
     "Krautkrämer and Krautkrämer 1990", moody},
    {Matter::Acrylic, 0.35, 1190, 2700, 1340, 5e-3, rms(1.5e-6), length_over_rms * rms(1.5e-6), true,
     "Selfridge 1985, shear speed typical", moody},
    {Matter::Hdpe, 0.21, 960, 2430, 950, 1e-2, rms(1.5e-6), length_over_rms * rms(1.5e-6), true,
     "Selfridge 1985, shear speed typical", moody},
    {Matter::Neoprene, 0.15, 1310, 1600, 0, 5e-2, rms(10e-6), length_over_rms * rms(10e-6), true,
     "Selfridge 1985", "Idelchik 2007, smooth rubber, by Adams et al. 2012; length decided here"},
    {Matter::NaturalRubber, -0.02, 950, 1550, 0, 2e-2, rms(10e-6), length_over_rms * rms(10e-6), true,
     "Haynes 2014", "Idelchik 2007, smooth rubber, by Adams et al. 2012; length decided here"},
    {Matter::WaterloggedWood, -0.07, 1000, 1340, 0, 5e-2, rms(400e-6), length_over_rms * rms(400e-6), false,
     "typical, in the range of Fediuk et al. 2020", moody},
    {Matter::DryWood, -0.5, 500, 1025, 0, 5e-2, rms(400e-6), length_over_rms * rms(400e-6), false,
     "Bucur 2006, softwood across the grain", moody},
    {Matter::ClosedCellFoam, -0.94, 60, 800, 0, 5e-2, 100e-6, 300e-6, false,
     "Gibson and Ashby 1997, PVC foam", "Gibson and Ashby 1997, cells of 0.3 mm"},
    {Matter::Ice, 0.39, 917, 3800, 1900, 5e-3, 0, 0, true, "typical, speeds 5 % below Selfridge 1985", none},
    {Matter::Air, -0.9995, 1.23, 340, 0, 0, 0, 0, false, "Kinsler et al. 2000", none},
    {Matter::Glass, 0.80, 2500, 5660, 3420, 5e-4, rms(1.5e-6), length_over_rms * rms(1.5e-6), true,
     "Krautkrämer and Krautkrämer 1990", moody},
    {Matter::Fibreglass, 0.57, 1800, 3100, 1700, 1e-2, rms(5.2e-6), length_over_rms * rms(5.2e-6), true,
     "typical laminate", "AWWA 2014, pipes, by Adams et al. 2012; length decided here"},
    {Matter::Rubber, 0.28, 1200, 2300, 0, 2e-2, rms(10e-6), length_over_rms * rms(10e-6), true,
     "Krautkrämer and Krautkrämer 1990, vulcanised",
     "Idelchik 2007, smooth rubber, by Adams et al. 2012; length decided here"},
    {Matter::Wood, 0.15, 1100, 1900, 0, 5e-2, rms(400e-6), length_over_rms * rms(400e-6), false,
     "Bucur 2006, wet oak across the grain", moody},
    {Matter::Rock, 0.72, 2562, 3750, 1970, 0.01374, rockRms(longest_of_bed), computeLength(longest_of_bed), false,
     "APL-UW 1994; shear speed Pickett 1963", report},
    {Matter::Rope, 0.31, 1110, 2620, 1070, 2e-2, strand_rms * rope_strand, strand_length * rope_strand, false,
     "Haynes 2014, nylon", "derived here, strands of 10 mm"},
    {Matter::Net, 0.31, 1110, 2620, 1070, 2e-2, strand_rms * net_twine, strand_length * net_twine, false,
     "Haynes 2014, nylon", "derived here, twine of 2 mm"},
    {Matter::Fouling, 0.14, fouling_density, mixtureSpeed(fouling_density, calcite), 0, 5e-2, rms(3e-3),
     length_over_rms * rms(3e-3), false, "ISO 19902 2020, by Wood 1955",
     "Schultz 2007, medium calcareous, by Adams et al. 2012; length decided here"},
    {Matter::HumanBody, 0.08, 1109, 1624, 0, 5e-2, 20e-6, 200e-6, false, "Hasgall et al. 2022, skin",
     "Tchvialeva et al. 2010; length decided here"},
    {Matter::Pet, 0.39, 1380, 2540, 1150, 1e-2, rms(1.5e-6), length_over_rms * rms(1.5e-6), true,
     "Selfridge 1985, Mylar; density and shear speed typical", moody},
    {Matter::Polypropylene, 0.22, 880, 2740, 1200, 5e-3, rms(1.5e-6), length_over_rms * rms(1.5e-6), true,
     "Selfridge 1985, shear speed typical", moody},
    {Matter::Paper, 0.17, paper_density, mixtureSpeed(paper_density, cell_wall), 0, 5e-2, 6e-6, length_over_rms * 6e-6,
     true, "Gibson and Ashby 1997, half cell walls of fibres, by Wood 1955",
     "typical of uncoated paper; length decided here"},
    {Matter::PaintedMetal, 0.936, 7850, 5900, 3230, 1e-4, rms(30e-6), length_over_rms * rms(30e-6), true,
     "ASTM E494 2015, density Haynes 2014, steel",
     "Schultz 2007, coating as applied, by Adams et al. 2012; length decided here"},
    // clang-format on
};

}  // namespace

const MatterProperties& getProperties(Matter matter) { return table[static_cast<size_t>(matter)]; }

std::optional<Matter> matterNamed(std::string_view name) {
    const auto& names = types::EnumNames<Matter>::names;
    const auto* found = std::ranges::find(names, name);
    return found == std::end(names) ? std::nullopt : std::optional(static_cast<Matter>(found - names));
}

std::string_view getName(Matter matter) { return types::EnumNames<Matter>::names[static_cast<size_t>(matter)]; }

size_t matterCount() { return std::size(table); }

}  // namespace insonify::acoustics
