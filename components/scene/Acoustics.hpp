#pragma once
#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "components/acoustics/Matter.hpp"
#include "components/scene/Scene.hpp"
#include "types/geometry/Geometry.hpp"
#include "types/text/Describe.hpp"

namespace insonify::scene {

/** Splits the name of an object or material into lower-case words of letters: "seaSurface_2::Water" is sea, surface,
 *  water. At least one word is returned, which may be empty. */
std::vector<std::string> splitWords(const std::string& name);

/** Returns the names of matter and sediments in the name of a material, as modellers write it: "Steel.001",
 *  "M_Rusty-Steel", "Material_Aluminium" and "traceIron 2". Each name occurs once, in the order of the material's
 *  name. */
std::vector<std::string_view> matterIn(const std::string& name);

/** Returns a geometry in which materials without acoustic values take those of the matter or sediment in their names.
 *  One notice lists these materials, and those whose names contain several, which keep the default. Returns the same
 *  pointer if no name contains any. */
types::GeometryPtr applyMaterialNames(const types::GeometryPtr& geometry);

/** Seabeds with a Lambert parameter fitted to APL-UW TR 9407 at 100 kHz (ACOUSTICS.md 3.2). */
enum class Sediment {
    RoughRock,
    Rock,
    Cobble,
    SandyGravel,
    CoarseSand,
    MediumSand,
    FineSand,
    MuddySand,
    VeryFineSand,
    CoarseSilt,
    SandySilt,
    MediumSilt,
    FineSilt,
    VeryFineSilt,
    Clay,
    Mackenzie
};

using acoustics::Matter;

double lambertDb(Sediment sediment);  ///< [dB]
double reflection(Matter matter);     ///< Signed pressure reflection coefficient [1].
/** Lambert parameter that gives a convex body of this reflection its target strength: -9.23 + 20 log10|R| [dB],
 *  ACOUSTICS.md 3.3. */
double lambertDb(Matter matter);

/** The medium behind a shell (ACOUSTICS.md 5.26). */
enum class Fill { Water, Air, Oil, Sand, Mud };

/** A thin wall of a solid, given by name or by numbers. A number replaces the value of the named matter. */
struct ShellAcoustics {
    std::optional<double> thickness_mm;
    std::optional<Matter> material;
    std::optional<double> density, sound_speed, shear_speed, loss;
    std::optional<Fill> fill;
    std::optional<double> fill_density, fill_sound_speed, fill_loss;

    void check(types::Diagnostics& diagnostics) const;
    /** Returns the shell. Requires that check() reports nothing. */
    types::Shell shell() const;

    static void describe(auto& self, auto& visit) {
        visit({"thickness_mm", "mm", "of the wall", 1e-3, 1000}, self.thickness_mm);
        visit({"material", "", "matter of the table that has these numbers: density, speeds and loss"}, self.material);
        visit({"density", "kg/m^3", "of the wall", 25, 23000}, self.density);
        visit({"sound_speed", "m/s", "of its longitudinal waves", 100, 20000}, self.sound_speed);
        visit({"shear_speed", "m/s", "of its shear waves; 0: it has none", 0, 10000}, self.shear_speed);
        visit({"loss", "1", "imaginary over real part of its wave numbers", 0, 1}, self.loss);
        visit({"fill", "", "medium behind the wall"}, self.fill);
        visit({"fill_density", "kg/m^3", "of the medium behind the wall, in place of that of `fill`", 25, 20000},
              self.fill_density);
        visit({"fill_sound_speed", "m/s", "of the medium behind the wall, in place of that of `fill`", 200, 6000},
              self.fill_sound_speed);
        visit({"fill_loss", "1", "imaginary over real part of its wave number", 0, 1}, self.fill_loss);
    }

private:
    void checkFill(types::Diagnostics& diagnostics) const;
};

/** The acoustic values that a file or a property gives to a material. An absent value does not change the material.
 *
 *  A `shell` makes the surface a thin wall: its echo is that of a rigid body times the reflection of the wall. A
 *  `sediment` sets the seabed and lambert_db. A `material` sets the matter, reflection and lambert_db. Numbers next to
 *  either refine it: a `lambert_db` by Lambert's law, a `table` by measurements. A `lambert_db`, `reflection` or
 *  `roughness_slope` replaces the law of the matter. */
struct Acoustics {
    std::optional<Sediment> sediment;
    std::optional<Matter> material;
    std::optional<double> lambert_db, reflection, roughness_slope, reflectivity;
    std::optional<bool> mirror;
    std::optional<std::string> table;
    std::optional<ShellAcoustics> shell;
    std::vector<glm::dvec2> measured;  ///< Contents of `table` after it was read [deg, dB].

    /** Reads `table`, whose path is relative to `folder`. Adds errors to `diagnostics`. */
    void readTable(const std::filesystem::path& folder, types::Diagnostics& diagnostics);
    void applyTo(types::Material& target) const;
    void check(types::Diagnostics& diagnostics) const;

    static void describe(auto& self, auto& visit) {
        visit({"sediment", "", "a seabed of the table: its law at the sonar's frequency, else its lambert_db"},
              self.sediment);
        visit({"material", "",
               "matter of the table: its law at the sonar's frequency, else its reflection and "
               "lambert_db"},
              self.material);
        visit({"lambert_db", "dB", "Lambert parameter, backscatter at normal incidence", -200, 20}, self.lambert_db);
        visit({"reflection", "1", "signed pressure reflection coefficient at normal incidence", -1, 1},
              self.reflection);
        visit({"roughness_slope", "1", "rms slope of the micro-relief: adds the lobe of a `reflection`", 0, 10},
              self.roughness_slope);
        visit({"mirror", "", "reflects as a flat mirror, by `reflection` or all of the sound: for multipath"},
              self.mirror);
        visit({"reflectivity", "1", "factor of cerqueira2017", 0, 1}, self.reflectivity);
        visit({"table", "", "instead: CSV file with grazing_deg,strength_db"}, self.table);
        visit({"shell", "", "the surface is a thin wall, which sound passes through"}, self.shell);
    }
};

/** The value of a key in a file: a number, a text, a boolean, or none of them. The key "shell.density" is in a
 *  block. */
using AcousticValue = std::variant<std::monostate, double, std::string, bool>;
using AcousticValues = std::map<std::string, AcousticValue>;

/** Returns the acoustics given by the keys and values of a file in `folder`. Adds errors to `diagnostics`.
 *  @param others keys that the caller reads, for the list of what is known */
Acoustics readAcoustics(const AcousticValues& values, const std::filesystem::path& folder,
                        types::Diagnostics& diagnostics, const std::vector<std::string>& others = {});

/** Returns the geometry of `scene` with acoustic values replaced by name. A name is that of a material, or of a node
 *  and all nodes below it; a node takes precedence over a material. Copies nothing when there is nothing to replace. An
 *  unknown name is a diagnostic at path `materials.<name>`. */
types::GeometryPtr overrideMaterials(const Scene& scene, const std::map<std::string, Acoustics>& materials,
                                     types::Diagnostics& diagnostics);

}  // namespace insonify::scene

template <>
struct insonify::types::EnumNames<insonify::scene::Sediment> {
    static constexpr std::string_view names[] = {"rough_rock",     "rock",           "cobble",     "sandy_gravel",
                                                 "coarse_sand",    "medium_sand",    "fine_sand",  "muddy_sand",
                                                 "very_fine_sand", "coarse_silt",    "sandy_silt", "medium_silt",
                                                 "fine_silt",      "very_fine_silt", "clay",       "mackenzie"};
};
template <>
struct insonify::types::EnumNames<insonify::scene::Fill> {
    static constexpr std::string_view names[] = {"water", "air", "oil", "sand", "mud"};
};
