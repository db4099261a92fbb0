#pragma once
#include <cstddef>
#include <optional>
#include <string_view>

#include "types/text/Describe.hpp"

namespace insonify::acoustics {

/** Matter that bodies and walls are made of (ACOUSTICS.md 3.3). */
enum class Matter {
    Steel,
    CarbonSteel,
    Aluminium,
    CastIron,
    Bronze,
    Granite,
    Basalt,
    Concrete,
    Limestone,
    Gravel,
    Sand,
    Mud,
    Pvc,
    Acrylic,
    Hdpe,
    Neoprene,
    NaturalRubber,
    WaterloggedWood,
    DryWood,
    ClosedCellFoam,
    Ice,
    Air,
    Glass,
    Fibreglass,
    Rubber,
    Wood,
    Rock,
    Rope,
    Net,
    Fouling,
    HumanBody,
    Pet,
    Polypropylene,
    Paper,
    PaintedMetal
};

/** Properties of a matter and of a surface that is made of it. */
struct MatterProperties {
    Matter matter;
    double reflection;   ///< Pressure reflection coefficient against sea water at normal incidence, signed [1].
    double density;      ///< [kg/m^3]
    double sound_speed;  ///< Speed of compressional waves [m/s].
    double shear_speed;  ///< Speed of shear waves [m/s]; 0: a fluid.
    double loss;         ///< Imaginary over real part of the wave numbers [1].
    double roughness;    ///< Rms height of the surface's relief [m]; 0: unknown, Lambert's law applies.
    double length;       ///< Correlation length of the relief [m].
    bool is_wall;        ///< Walls, and therefore shells, may be made of this matter.
    std::string_view source, roughness_source;  ///< Author and year.

    bool hasRoughness() const { return roughness > 0; }
};

const MatterProperties& getProperties(Matter matter);
/** Returns the matter of a name such as "steel"; none for a name that the table does not have. */
std::optional<Matter> matterNamed(std::string_view name);
std::string_view getName(Matter matter);
size_t matterCount();

}  // namespace insonify::acoustics

template <>
struct insonify::types::EnumNames<insonify::acoustics::Matter> {
    static constexpr std::string_view names[] = {"steel",
                                                 "carbon_steel",
                                                 "aluminium",
                                                 "cast_iron",
                                                 "bronze",
                                                 "granite",
                                                 "basalt",
                                                 "concrete",
                                                 "limestone",
                                                 "gravel",
                                                 "sand",
                                                 "mud",
                                                 "pvc",
                                                 "acrylic",
                                                 "hdpe",
                                                 "neoprene",
                                                 "natural_rubber",
                                                 "waterlogged_wood",
                                                 "dry_wood",
                                                 "closed_cell_foam",
                                                 "ice",
                                                 "air",
                                                 "glass",
                                                 "fibreglass",
                                                 "rubber",
                                                 "wood",
                                                 "rock",
                                                 "rope",
                                                 "net",
                                                 "fouling",
                                                 "human_body",
                                                 "pet",
                                                 "polypropylene",
                                                 "paper",
                                                 "painted_metal"};
};
