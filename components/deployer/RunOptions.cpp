#include "components/deployer/RunOptions.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <charconv>
#include <cmath>

#include "components/deployer/DeploymentFile.hpp"

namespace insonify::deployer {
namespace {

std::string refuseUnlessWhole(const std::string& text) {
    uint64_t number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && stop == end ? "" : text + " is no whole number from 0 to 2^64 - 1";
}

}  // namespace

std::string refuseUnlessPositive(const std::string& text) {
    double number = 0;
    if (CLI::detail::lexical_cast(text, number) && std::isfinite(number) && number > 0) return "";
    return text + " is no number above 0";
}

void RunOptions::addTo(CLI::App& command) {
    auto* pings = command.add_option("--pings", limits.samples, "end when every sonar has sent N pings")
                      ->type_name("N")
                      ->check(refuseUnlessPositive);
    command.add_option("--duration", limits.duration_s, "end after S seconds on the deployment's clock")
        ->type_name("S")
        ->check(refuseUnlessPositive)
        ->excludes(pings);
    command.add_option("--out", out, "folder for the files (default: out/<deployment>-<UTC time>)")->type_name("DIR");
    command.add_option("--set", set, "task.property.path=value: a property other than in the file; may be repeated")
        ->allow_extra_args(false);
    command.add_option("--seed", seed, "seeds every task anew (0: as the file says)")
        ->type_name("N")
        ->check(refuseUnlessWhole);
    command.add_option("--summary", summary, "writes the summary as JSON")->type_name("FILE");
    command.add_flag("--quiet", quiet, "no progress, no notices, no summary");
}

framework::DeploymentSpec loadSpec(const RunOptions& options) {
    framework::DeploymentSpec spec = framework::DeploymentSpec::load(deploymentIn(options.deployment));
    for (const std::string& assignment : options.set) spec.set(assignment);
    return spec;
}

}  // namespace insonify::deployer
