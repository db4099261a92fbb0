// insonify study error [DEPLOYMENT]
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <memory>

#include "components/deployer/OutputFolder.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/deployer/StudyCommand.hpp"
#include "components/sonar/BinGrid.hpp"
#include "components/study/ErrorReport.hpp"

namespace insonify::deployer {
namespace {

struct Options {
    std::string deployment, out;
    std::vector<std::string> scenes;
    uint64_t ping = 1;
    study::ErrorOptions study;
    bool quiet = false;
};

/** What a study can take away without changing where echoes come from: absorption, model, shading maps. */
sonar::SonarConfig plain(sonar::SonarConfig config, const std::string& file) {
    if (!config.bearings_deg.empty() || config.beam_geometry != sonar::BeamGeometry::Planar)
        throw types::ConfigError(
            file, "tasks",
            "has a sonar with bearings_deg or conical beams; a study of the error takes a regular planar fan");
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    config.range = grid.bin_width * grid.bin_count;
    config.speed_of_sound = grid.speed_of_sound;
    config.range_rounding = sonar::RangeRounding::Exact;
    config.model = sonar::Model::Physical;
    config.published = false;
    config.absorption.reset();
    return config;
}

types::GeometryPtr withoutNormalMaps(const types::GeometryPtr& geometry) {
    auto result = std::make_shared<types::Geometry>(*geometry);
    for (types::Material& material : result->materials) material.normal_map = -1;
    return result;
}

/** Of the scene: the file's, in letters that every report can show; never that of a scene with a closed form. */
std::string nameOf(const std::string& file) {
    std::string name = std::filesystem::path(file).stem().string();
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
    const auto scenes = study::closedFormScenes();
    return std::ranges::find(scenes, name, &study::StudyScene::name) == scenes.end() ? name : "deployment_" + name;
}

study::StudyScene sceneOf(const std::string& file, uint64_t ping) {
    const SonarAt sonar = sonarAt(file, ping);
    study::StudyScene scene{nameOf(file), file, plain(sonar.config, file), sonar.snapshot, {}};
    scene.snapshot.geometry = withoutNormalMaps(sonar.snapshot.geometry);
    return scene;
}

std::vector<study::StudyScene> scenesOf(const Options& options) {
    std::vector<study::StudyScene> scenes = study::closedFormScenes();
    std::string known;
    for (const auto& scene : scenes) known += (known.empty() ? "" : ", ") + scene.name;
    for (const std::string& name : options.scenes)
        if (std::ranges::find(scenes, name, &study::StudyScene::name) == scenes.end())
            throw types::ConfigError("", "--scene", name + " is not a scene with a closed form; those are " + known);
    const bool chosen = !options.scenes.empty() || !options.deployment.empty();
    if (chosen)
        std::erase_if(scenes, [&](const auto& scene) { return std::ranges::count(options.scenes, scene.name) == 0; });
    if (!options.deployment.empty()) scenes.push_back(sceneOf(options.deployment, options.ping));
    return scenes;
}

int studyError(Options options) {
    const std::vector<study::StudyScene> scenes = scenesOf(options);
    OutputFolder folder(options.out, "study_error");
    if (!options.quiet && isatty(STDERR_FILENO))
        options.study.progress = [](const std::string& at) { fmt::print(stderr, "\r\033[K{}", at); };
    const study::ErrorResult result = study::studyError(scenes, options.study);
    folder.keep();
    study::writeReport(result, folder.path());
    if (!options.quiet && isatty(STDERR_FILENO)) fmt::print(stderr, "\r\033[K");

    bool all = true;
    for (const study::Claim& claim : study::claims(result)) {
        all = all && claim.holds();
        fmt::print("{}  {}: {:.4g}, {} {:.4g}\n", claim.holds() ? "pass" : "FAIL", claim.text, claim.measured,
                   claim.at_most ? "at most" : "at least", claim.bound);
    }
    fmt::print("{} points; report in {}\n", result.measurements.size(), (folder.path() / "index.html").string());
    return all ? 0 : 1;
}

}  // namespace

void addErrorStudy(CLI::App& study, Action& action) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = study.add_subcommand("error", "Error against run time, for each way to estimate an echo");
    command->add_option("DEPLOYMENT", options->deployment,
                        "a YAML file whose sonar and scene are studied; absent: all scenes with a closed form");
    command->add_option("--out", options->out, "folder of the report");
    command->add_option("--scene", options->scenes, "only this scene with a closed form (more than one: say it again)");
    command->add_option("--ping", options->ping, "which ping of the deployment")->check(CLI::PositiveNumber);
    command->add_option("--pings", options->study.pings, "timed for each point")->check(CLI::Range(1, 1000));
    command->add_option("--levels", options->study.levels, "how often rows and columns are doubled, less one")
        ->check(CLI::Range(1, 6));
    command->add_flag("--quiet", options->quiet, "no progress");
    command->callback([options, &action] { action = [options] { return studyError(*options); }; });
}

}  // namespace insonify::deployer
