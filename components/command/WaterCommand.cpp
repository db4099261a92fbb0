// insonify water
#include <fmt/core.h>

#include <cmath>
#include <iterator>
#include <memory>

#include "components/acoustics/Absorption.hpp"
#include "components/acoustics/SoundSpeed.hpp"
#include "components/command/CommandLine.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/Json.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

using acoustics::AbsorptionLaw, acoustics::SoundSpeedLaw;

struct WaterOptions {
    acoustics::Water water;
    std::vector<double> frequencies_khz;
    bool json = false;
};

void require(const char* option, double value, double min, double max) {
    if (!(value >= min && value <= max))
        throw types::ConfigError("", option, fmt::format("is {:g}; must be from {:g} to {:g}", value, min, max));
}

/** Checks the range in which every formula has a meaning; each is valid in a smaller range. */
void check(const WaterOptions& options) {
    require("--temperature-celsius", options.water.temperature_celsius, -100, 400);
    require("--salinity-psu", options.water.salinity_psu, 0, 400);
    require("--depth", options.water.depth, 0, 1e5);
    require("--ph", options.water.ph, 0, 14);
    require("--latitude-deg", options.water.latitude_deg, -90, 90);
    for (const double frequency : options.frequencies_khz) require("--frequency-khz", frequency, 0.001, 1e7);
}

/** Calls `visit(name, law)` for each law. */
template <class Law, class Visit>
void forEachLaw(const Visit& visit) {
    const auto& names = types::EnumNames<Law>::names;
    for (size_t i = 0; i < std::size(names); ++i) visit(std::string(names[i]), static_cast<Law>(i));
}

void warn(Json& warnings, const std::string& law, const std::string& outside) {
    if (!outside.empty()) warnings.push_back(fmt::format("{} is extrapolated: {}", law, outside));
}

Json waterReport(const WaterOptions& options) {
    Json speeds = Json::object(), absorptions = Json::object(), warnings = Json::array();
    forEachLaw<SoundSpeedLaw>([&](const std::string& name, SoundSpeedLaw law) {
        speeds[name] = acoustics::soundSpeed(law, options.water);
        warn(warnings, name, outsideValidity(law, options.water));
    });
    forEachLaw<AbsorptionLaw>([&](const std::string& name, AbsorptionLaw law) {
        absorptions[name] = Json::array();
        for (const double frequency : options.frequencies_khz) {
            absorptions[name].push_back(acoustics::absorptionDbPerM(law, frequency, options.water));
            warn(warnings, fmt::format("{} at {:g} kHz", name, frequency),
                 outsideValidity(law, frequency, options.water));
        }
    });
    return {{"sound_speed_m_s", speeds},
            {"absorption_db_per_m", absorptions},
            {"frequency_khz", options.frequencies_khz},
            {"warnings", warnings}};
}

void printWater(const Json& report) {
    console::printResult("speed of sound [m/s]\n");
    for (const auto& [law, speed] : report["sound_speed_m_s"].items())
        console::printResult("  {:18} {:.3f}\n", law, speed.get<double>());
    if (!report["frequency_khz"].empty()) {
        console::printResult("absorption, one way [dB/m]\n  {:18}", "");
        for (const Json& frequency : report["frequency_khz"])
            console::printResult(" {:>11}", fmt::format("{:g} kHz", frequency.get<double>()));
        console::printResult("\n");
        for (const auto& [law, values] : report["absorption_db_per_m"].items()) {
            console::printResult("  {:18}", law);
            for (const Json& value : values) console::printResult(" {:>11.5g}", value.get<double>());
            console::printResult("\n");
        }
    }
    for (const Json& line : report["warnings"]) console::printResult("warning: {}\n", line.get<std::string>());
}

int showWater(const WaterOptions& options) {
    check(options);
    const Json report = waterReport(options);
    options.json ? print(report) : printWater(report);
    return 0;
}

}  // namespace

void addWaterCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<WaterOptions>();
    acoustics::Water& water = options->water;
    CLI::App* command = app.add_subcommand("water", "Computes speed of sound and absorption by every formula");
    command->add_option("--temperature-celsius", water.temperature_celsius, "[degC]")->capture_default_str();
    command->add_option("--salinity-psu", water.salinity_psu, "practical salinity")->capture_default_str();
    command->add_option("--depth", water.depth, "below the surface [m]")->capture_default_str();
    command->add_option("--ph", water.ph, "acidity")->capture_default_str();
    command->add_option("--latitude-deg", water.latitude_deg, "for pressure at depth [deg]")->capture_default_str();
    command->add_option("--frequency-khz", options->frequencies_khz, "of the absorption [kHz]; may be repeated")
        ->allow_extra_args(false);
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] { action = [options] { return showWater(*options); }; });
}

}  // namespace insonify::command
