// insonify backscatter
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <optional>

#include "components/acoustics/Backscatter.hpp"
#include "components/acoustics/Matter.hpp"
#include "components/acoustics/Plate.hpp"
#include "components/acoustics/RoughSurface.hpp"
#include "components/acoustics/Seabed.hpp"
#include "components/command/CommandLine.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/Json.hpp"
#include "components/scene/Acoustics.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

constexpr double mackenzie_db = -27;      // ACOUSTICS.md 3.2
constexpr double water_density = 1025;    ///< [kg/m^3]
constexpr double min_strength_db = -300;  ///< Printed for zero backscatter.

struct BackscatterOptions {
    std::string sediment, material;
    std::optional<double> grain_size_phi, lambert_db, shell_mm;
    std::string fill = "water";
    double frequency_khz = 0, sound_speed = 1500;
    std::vector<double> grazing_deg = {1, 2, 3, 5, 7, 10, 15, 20, 30, 40, 50, 60, 70, 80, 85, 90};
    bool json = false;
};

/** A scatterer: its name, law and parameters, and sigma_b over the grazing angle [rad]. */
struct Scatterer {
    std::string name, law;
    Json parameters;
    std::function<double(double)> section;
    std::vector<std::string> outside = {};            ///< Parameters outside of the law's validity.
    std::vector<std::string> notes = {};              ///< Other warnings.
    std::function<double(double)> diffuse = {};       ///< The diffuse part without the lobe, if there is a lobe.
    std::map<std::string, std::string> sources = {};  ///< Author and year of the parameters.
    /** What a wall reflects and passes at a grazing angle [rad]; null: no wall. */
    std::function<acoustics::PlateShares(double)> shares = {};
};

void require(const char* option, double value, double min, double max) {
    if (!(value >= min && value <= max))
        throw types::ConfigError("", option, fmt::format("is {:g}; must be from {:g} to {:g}", value, min, max));
}

void check(const BackscatterOptions& options) {
    require("--frequency-khz", options.frequency_khz, 0.001, 1e5);
    require("--sound-speed", options.sound_speed, 100, 20000);
    for (const double angle : options.grazing_deg) require("--grazing-deg", angle, 0, 90);
    if (options.grain_size_phi) require("--grain-size-phi", *options.grain_size_phi, -20, 20);
    if (options.lambert_db) require("--lambert-db", *options.lambert_db, -200, 20);
    if (options.shell_mm) require("--shell-mm", *options.shell_mm, 1e-3, 1000);
    if (options.shell_mm && options.material.empty())
        throw types::ConfigError("", "--shell-mm", "is given without --material, the matter of the wall");
    const int given = (options.sediment.empty() ? 0 : 1) + (options.material.empty() ? 0 : 1) +
                      (options.grain_size_phi ? 1 : 0) + (options.lambert_db ? 1 : 0);
    if (given != 1)
        throw types::ConfigError("", "backscatter",
                                 fmt::format("names {} scatterers; give one of --sediment, --grain-size-phi, "
                                             "--lambert-db and --material",
                                             given));
}

Scatterer lambert(std::string name, double lambert_db, Json parameters) {
    parameters["lambert_db"] = lambert_db;
    return {std::move(name), "lambert", std::move(parameters),
            [lambert_db](double grazing) { return acoustics::lambertSection(lambert_db, std::sin(grazing)); }};
}

Scatterer ofSeabed(std::string name, const acoustics::Seabed& seabed, Json parameters,
                   const BackscatterOptions& options) {
    const std::pair<const char*, double> values[] = {{"density_ratio", seabed.density_ratio},
                                                     {"speed_ratio", seabed.speed_ratio},
                                                     {"loss_parameter", seabed.loss},
                                                     {"volume_parameter", seabed.volume},
                                                     {"spectral_strength_cm4", seabed.roughness},
                                                     {"spectral_exponent", seabed.roughness_slope}};
    for (const auto& [key, value] : values) parameters[key] = value;
    const acoustics::SeabedBackscatter model(seabed, options.frequency_khz, options.sound_speed);
    Scatterer scatterer{std::move(name), "apl_uw_tr_9407", std::move(parameters),
                        [model](double grazing) { return model.crossSection(grazing); }};
    const std::string outside = acoustics::outsideSeabedModel(options.frequency_khz, options.sound_speed);
    if (!outside.empty()) scatterer.outside.push_back(outside);
    return scatterer;
}

[[noreturn]] void refuseName(const char* option, const std::string& name, const std::vector<std::string>& known) {
    throw types::ConfigError(
        "", option, fmt::format("is '{}'; {}may be {}", name, types::didYouMean(name, known), fmt::join(known, ", ")));
}

Scatterer ofSediment(const BackscatterOptions& options) {
    const std::string& name = options.sediment;
    if (name == "mackenzie") return lambert(name, mackenzie_db, Json::object());
    std::vector<std::string> known = acoustics::seabedNames();
    known.emplace_back("mackenzie");
    const std::optional<acoustics::Seabed> seabed = acoustics::seabedNamed(name);
    if (!seabed) refuseName("--sediment", name, known);
    Json parameters = Json::object();
    if (const auto phi = acoustics::grainSizeNamed(name)) parameters["grain_size_phi"] = *phi;
    return ofSeabed(name, *seabed, std::move(parameters), options);
}

Scatterer ofGrainSize(const BackscatterOptions& options) {
    const double phi = *options.grain_size_phi;
    Scatterer scatterer =
        ofSeabed(fmt::format("{:g} phi", phi), acoustics::seabedOfGrainSize(phi), {{"grain_size_phi", phi}}, options);
    if (const std::string outside = acoustics::outsideGrainSizes(phi); !outside.empty())
        scatterer.outside.push_back(outside);
    return scatterer;
}

Json listParameters(const acoustics::MatterProperties& matter) {
    return {{"reflection", matter.reflection},
            {"density_kg_m3", matter.density},
            {"sound_speed_m_s", matter.sound_speed},
            {"shear_speed_m_s", matter.shear_speed},
            {"loss_parameter", matter.loss},
            {"roughness_um", 1e6 * matter.roughness},
            {"correlation_length_um", 1e6 * matter.length}};
}

/** Returns a thin wall with water before it: Lambert's law of a rigid surface times what the wall reflects at normal
 *  incidence (ACOUSTICS.md 3.10). */
Scatterer makeWall(acoustics::Matter matter, const BackscatterOptions& options) {
    scene::ShellAcoustics given;
    given.thickness_mm = options.shell_mm;
    given.material = matter;
    const auto& fills = types::EnumNames<scene::Fill>::names;
    given.fill = static_cast<scene::Fill>(std::ranges::find(fills, options.fill) - std::begin(fills));
    const types::Shell shell = given.shell();
    const acoustics::Plate plate = acoustics::makePlate(shell);
    const acoustics::Fluid water{water_density, options.sound_speed}, behind = acoustics::getFluidBehind(shell, water);
    const double frequency = 1000 * options.frequency_khz;
    const auto shares = [=](double grazing) {
        return acoustics::computeShares(plate, water, behind, frequency, std::sin(grazing));
    };
    const double reflected = shares(std::numbers::pi / 2).reflected;
    Json parameters = {{"thickness_mm", *options.shell_mm},
                       {"half_waves", acoustics::countHalfWaves(plate, frequency)},
                       {"half_wave_khz", plate.sound_speed / (2000 * plate.thickness)}};
    parameters.update(listParameters(acoustics::getProperties(matter)));
    Scatterer wall =
        lambert(std::string(acoustics::getName(matter)),
                10 * std::log10(std::max(3 / (8 * std::numbers::pi) * reflected, 1e-20)), std::move(parameters));
    wall.law = "thin_wall";
    wall.shares = shares;
    if (!shell.has_air && acoustics::isNearResonance(plate, frequency))
        wall.notes.push_back("the wall is near a half-wave resonance, where it passes most sound");
    return wall;
}

/** Returns a rough solid, or Lambert's law where the relief is unknown. */
Scatterer ofMaterial(const BackscatterOptions& options) {
    const auto& names = types::EnumNames<acoustics::Matter>::names;
    const std::string& name = options.material;
    const std::optional<acoustics::Matter> known = acoustics::matterNamed(name);
    if (!known) refuseName("--material", name, {std::begin(names), std::end(names)});
    if (options.shell_mm && !acoustics::getProperties(*known).is_wall) {
        std::vector<std::string> walls;
        for (size_t i = 0; i < acoustics::matterCount(); ++i)
            if (const auto matter = static_cast<acoustics::Matter>(i); acoustics::getProperties(matter).is_wall)
                walls.emplace_back(acoustics::getName(matter));
        refuseName("--material", name, walls);
    }
    if (options.shell_mm) return makeWall(*known, options);
    const acoustics::MatterProperties& matter = acoustics::getProperties(*known);
    Scatterer scatterer = lambert(name, scene::lambertDb(*known), listParameters(matter));
    if (matter.hasRoughness()) {
        const acoustics::RoughSurface surface =
            acoustics::makeRoughSurface(matter, options.frequency_khz, water_density, options.sound_speed);
        scatterer.law = "rough_solid";
        scatterer.parameters["reflection"] = surface.reflection();
        scatterer.parameters["lobe_share"] = surface.lobeShare();
        scatterer.parameters["lobe_slope"] = std::sqrt(surface.squareSlope());
        scatterer.section = [surface](double grazing) { return acoustics::solidSection(surface, grazing); };
        scatterer.diffuse = [surface](double grazing) { return surface.diffuse(grazing); };
    }
    scatterer.sources = {{"density_and_speeds", std::string(matter.source)},
                         {"roughness", std::string(matter.roughness_source)}};
    return scatterer;
}

Scatterer makeScatterer(const BackscatterOptions& options) {
    if (!options.sediment.empty()) return ofSediment(options);
    if (options.grain_size_phi) return ofGrainSize(options);
    if (options.lambert_db) return lambert("lambert", *options.lambert_db, Json::object());
    return ofMaterial(options);
}

double getDecibels(double share) { return std::max(min_strength_db, 10 * std::log10(share)); }

/** Returns 10 log10 of sigma_b. Below 0.001 deg it is the value at 0.001 deg, so that Lambert's law stays finite. */
double strengthDb(const std::function<double(double)>& section, double grazing_deg) {
    const double strength = section(std::max(grazing_deg, 0.001) * std::numbers::pi / 180);
    return getDecibels(strength);
}

Json backscatterReport(const BackscatterOptions& options) {
    const Scatterer scatterer = makeScatterer(options);
    Json strengths = Json::array(), warnings = Json::array();
    for (const double angle : options.grazing_deg) strengths.push_back(strengthDb(scatterer.section, angle));
    for (const std::string& outside : scatterer.outside)
        warnings.push_back(fmt::format("{} is extrapolated: {}", scatterer.law, outside));
    for (const std::string& note : scatterer.notes) warnings.push_back(note);
    Json report = {{"name", scatterer.name},
                   {"law", scatterer.law},
                   {"parameters", scatterer.parameters},
                   {"grazing_deg", options.grazing_deg},
                   {"strength_db", strengths},
                   {"warnings", warnings}};
    if (scatterer.diffuse)
        for (const double angle : options.grazing_deg)
            report["diffuse_db"].push_back(strengthDb(scatterer.diffuse, angle));
    if (scatterer.shares)
        for (const double angle : options.grazing_deg) {
            const acoustics::PlateShares shares = scatterer.shares(types::radians(angle));
            report["reflected_db"].push_back(getDecibels(shares.reflected));
            report["passed_db"].push_back(getDecibels(shares.passed));
        }
    if (!scatterer.sources.empty()) report["sources"] = scatterer.sources;
    return report;
}

void printBackscatter(const Json& report) {
    std::vector<std::pair<const char*, const char*>> columns = {{"strength_db", "strength [dB]"}};
    for (const auto& column : {std::pair("diffuse_db", "without the lobe [dB]"),
                               std::pair("reflected_db", "wall reflects [dB]"), std::pair("passed_db", "passes [dB]")})
        if (report.contains(column.first)) columns.push_back(column);
    console::printResult("{}, by law {}\n", report["name"].get<std::string>(), report["law"].get<std::string>());
    for (const auto& [key, value] : report["parameters"].items())
        console::printResult("  {:22} {:.5g}\n", key, value.get<double>());
    if (report.contains("sources"))
        for (const auto& [key, source] : report["sources"].items())
            console::printResult("  source of {:12} {}\n", key, source.get<std::string>());
    std::string head = "grazing [deg]";
    for (const auto& [key, title] : columns) head += fmt::format("   {}", title);
    console::printResult("{}\n", head);
    for (size_t i = 0; i < report["grazing_deg"].size(); ++i) {
        std::string row = fmt::format("  {:11g}", report["grazing_deg"][i].get<double>());
        for (const auto& [key, title] : columns)
            row += fmt::format("   {:{}.2f}", report[key][i].get<double>(), std::string_view(title).size());
        console::printResult("{}\n", row);
    }
    for (const Json& line : report["warnings"]) console::printResult("warning: {}\n", line.get<std::string>());
}

int showBackscatter(const BackscatterOptions& options) {
    check(options);
    const Json report = backscatterReport(options);
    options.json ? print(report) : printBackscatter(report);
    return 0;
}

}  // namespace

void addBackscatterCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<BackscatterOptions>();
    CLI::App* command = app.add_subcommand("backscatter", "Computes how strongly a seabed or a material scatters back");
    command->add_option("--sediment", options->sediment, "a seabed of APL-UW TR 9407 by its name");
    command->add_option("--grain-size-phi", options->grain_size_phi, "a seabed by its mean grain size [phi]");
    command->add_option("--lambert-db", options->lambert_db, "Lambert's law with this parameter [dB]");
    command->add_option("--material", options->material, "a material by its name, see `describe materials`");
    command->add_option("--shell-mm", options->shell_mm, "a wall of the material, this thick, in place of a body [mm]");
    command->add_option("--fill", options->fill, "the medium behind the wall")
        ->capture_default_str()
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(types::EnumNames<scene::Fill>::names),
                                                       std::end(types::EnumNames<scene::Fill>::names))));
    command->add_option("--frequency-khz", options->frequency_khz, "[kHz]")->required();
    command->add_option("--sound-speed", options->sound_speed, "in the water [m/s]")->capture_default_str();
    command->add_option("--grazing-deg", options->grazing_deg, "grazing angle [deg]; may be repeated")
        ->allow_extra_args(false);
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] { action = [options] { return showBackscatter(*options); }; });
}

}  // namespace insonify::command
