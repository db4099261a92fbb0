// insonify backscatter
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>

#include "components/acoustics/Backscatter.hpp"
#include "components/acoustics/SeabedBackscatter.hpp"
#include "components/deployer/CommandLine.hpp"
#include "components/deployer/Json.hpp"
#include "components/scene/Acoustics.hpp"
#include "types/DidYouMean.hpp"

namespace insonify::deployer {
namespace {

constexpr double mackenzie_db = -27;  // ACOUSTICS.md 3.2

struct BackscatterOptions {
    std::string sediment, material;
    std::optional<double> grain_size_phi, lambert_db;
    double frequency_khz = 0, sound_speed = 1500;
    std::vector<double> grazing_deg = {1, 2, 3, 5, 7, 10, 15, 20, 30, 40, 50, 60, 70, 80, 85, 90};
    bool json = false;
};

/** What scatters: its name, law and numbers, and sigma_b over the grazing angle [rad]. */
struct Scatterer {
    std::string name, law;
    Json parameters;
    std::function<double(double)> section;
    std::vector<std::string> outside = {};  ///< What lies outside of the law's validity.
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

Scatterer ofMaterial(const std::string& name) {
    const auto& names = types::EnumNames<scene::Matter>::names;
    for (size_t i = 0; i < std::size(names); ++i)
        if (names[i] == name) {
            const auto matter = static_cast<scene::Matter>(i);
            return lambert(name, scene::lambertDb(matter), {{"reflection", scene::reflection(matter)}});
        }
    refuseName("--material", name, {std::begin(names), std::end(names)});
}

Scatterer scattererOf(const BackscatterOptions& options) {
    if (!options.sediment.empty()) return ofSediment(options);
    if (options.grain_size_phi) return ofGrainSize(options);
    if (options.lambert_db) return lambert("lambert", *options.lambert_db, Json::object());
    return ofMaterial(options.material);
}

/** 10 log10 of sigma_b; below 0.001 deg that of 0.001 deg, so that Lambert's law is no level of nothing. */
double strengthDb(const Scatterer& scatterer, double grazing_deg) {
    return 10 * std::log10(scatterer.section(std::max(grazing_deg, 0.001) * std::numbers::pi / 180));
}

Json backscatterReport(const BackscatterOptions& options) {
    const Scatterer scatterer = scattererOf(options);
    Json strengths = Json::array(), warnings = Json::array();
    for (const double angle : options.grazing_deg) strengths.push_back(strengthDb(scatterer, angle));
    for (const std::string& outside : scatterer.outside)
        warnings.push_back(fmt::format("{} is extrapolated: {}", scatterer.law, outside));
    return {{"name", scatterer.name},
            {"law", scatterer.law},
            {"parameters", scatterer.parameters},
            {"grazing_deg", options.grazing_deg},
            {"strength_db", strengths},
            {"warnings", warnings}};
}

void printBackscatter(const Json& report) {
    fmt::print("{}, by law {}\n", report["name"].get<std::string>(), report["law"].get<std::string>());
    for (const auto& [key, value] : report["parameters"].items())
        fmt::print("  {:22} {:.5g}\n", key, value.get<double>());
    fmt::print("grazing [deg]   strength [dB]\n");
    for (size_t i = 0; i < report["grazing_deg"].size(); ++i)
        fmt::print("  {:11g}   {:13.2f}\n", report["grazing_deg"][i].get<double>(),
                   report["strength_db"][i].get<double>());
    for (const Json& line : report["warnings"]) fmt::print("warning: {}\n", line.get<std::string>());
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
    command->add_option("--frequency-khz", options->frequency_khz, "[kHz]")->required();
    command->add_option("--sound-speed", options->sound_speed, "in the water [m/s]")->capture_default_str();
    command->add_option("--grazing-deg", options->grazing_deg, "grazing angle [deg]; may be repeated")
        ->allow_extra_args(false);
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] { action = [options] { return showBackscatter(*options); }; });
}

}  // namespace insonify::deployer
