// insonify study error [DEPLOYMENT]
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <thread>

#include "components/console/Console.hpp"
#include "components/console/Json.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/console/ProgressLine.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/study/commands/StudyCommand.hpp"
#include "components/study/error/ErrorAnalysis.hpp"
#include "components/study/error/ErrorStudy.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::study {
namespace {

struct ErrorCommandOptions {
    std::string deployment, out;
    std::vector<std::string> scenes;
    uint64_t ping = 1;
    ErrorOptions study;
    bool effects = false, quiet = false;
};

/** Removes all but echoes of surfaces by Lambert's law, in boxes of beams and bins. */
sonar::SonarConfig plain(sonar::SonarConfig config, const std::string& file) {
    if (!config.bearings_deg.empty() || config.beam_geometry != sonar::BeamGeometry::Planar)
        throw types::ConfigError(
            file, "tasks",
            "has a sonar with bearings_deg, with a beam_width_deg other than their spacing or with conical beams; a "
            "study of the error takes a regular planar fan");
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    config.range = grid.bin_width * grid.bin_count;
    config.speed_of_sound = grid.speed_of_sound;
    config.range_rounding = sonar::RangeRounding::Exact;
    config.model = sonar::Model::Physical;
    config.published = false;
    config.absorption.reset();
    config.beam_pattern.reset();
    config.pulse.reset();
    config.multipath.reset();
    config.volume.clear();
    config.speckle.reset();
    config.elements.reset();
    config.frequency_khz.reset();
    return config;
}

std::vector<std::string> sceneNames() {
    std::vector<std::string> names;
    for (const auto& makers : {closedFormScenes(), computedScenes()})
        for (const SceneMaker& scene : makers) names.emplace_back(scene.name);
    return names;
}

/** Returns the scene's name: the file's, in letters that every report can show; never that of a scene of the study. */
std::string getName(const std::string& file) {
    std::string name = std::filesystem::path(file).stem().string();
    for (char& c : name)
        if (!types::isLetter(c) && !types::isDigit(c) && c != '-' && c != '.') c = '_';
    return std::ranges::count(sceneNames(), name) == 0 ? name : "deployment_" + name;
}

StudyScene studied(const std::string& file, const deployer::SonarAt& sonar) {
    return {getName(file), file, plain(sonar.config, file), sonar.snapshot, {}};
}

std::vector<StudyScene> makeScenes(const ErrorCommandOptions& options) {
    const std::vector<std::string> names = sceneNames();
    for (const std::string& name : options.scenes)
        if (std::ranges::count(names, name) == 0)
            throw types::ConfigError(
                "", "--scene",
                fmt::format("{} is not a scene of the study; those are {}", name, fmt::join(names, ", ")));
    const bool all = options.scenes.empty() && options.deployment.empty();
    const auto wanted = [&](const std::string& name) { return all || std::ranges::count(options.scenes, name) > 0; };
    std::vector<StudyScene> scenes;
    for (const auto& makers : {closedFormScenes(), computedScenes()})
        for (const SceneMaker& scene : makers)
            if (wanted(scene.name)) scenes.push_back(scene.make());
    if (!options.deployment.empty())
        scenes.push_back(studied(options.deployment, deployer::sonarAt(options.deployment, options.ping)));
    for (size_t i = 0, plain = scenes.size(); options.effects && i < plain; ++i)
        for (const Effect effect : effects) scenes.push_back(withEffect(scenes[i], effect));
    return scenes;
}

using console::Json;

Json toJson(const Measurement& m, const ErrorResult& result) {
    return {{"scene", m.scene},
            {"method", getName(m.method)},
            {"rows", m.rows},
            {"columns_per_beam", m.columns_per_beam},
            {"rel_l2", m.metrics.rel_l2},
            {"rel_l2_tvg", m.metrics.rel_l2_tvg},
            {"energy_bias", m.metrics.energy_bias},
            {"kappa_max", m.kappa_max},
            {"median_ms", m.median_ms},
            {"p99_ms", m.p99_ms},
            {"cpu_ms", m.cpu_ms},
            {"pareto", onParetoFront(m, result)}};
}

/** Returns each method's results on each scene: slope, times to the goals and how they were found. */
Json getMethods(const ErrorResult& result) {
    Json all = Json::array();
    for (const Reference& reference : result.references)
        for (const Method method : methods) {
            const auto points = ladder(result, reference.scene, method);
            if (points.empty()) continue;
            const auto fitted = slope(points, reference.error);
            Json each{{"scene", reference.scene},
                      {"method", getName(method)},
                      {"slope", fitted ? Json(*fitted) : Json()},
                      {"points", Json::array()}};
            for (const double goal : goals)
                for (const auto& [measure, ending] :
                     {std::pair(with_gain, ""), std::pair(without_gain, "_without_gain")}) {
                    const auto time = timeTo(goal, points, measure);
                    const std::string key = fmt::format("ms_to_{:g}_percent{}", 100 * goal, ending);
                    each[key] = time ? Json(time->ms) : Json();
                    each[key + "_is"] = time ? Json(getName(time->kind)) : Json();
                    each[key + "_open"] = goal < blurred * referenceError(result, reference.scene, measure);
                }
            for (const Measurement& m : points) each["points"].push_back(toJson(m, result));
            all.push_back(std::move(each));
        }
    return all;
}

Json toJson(const ErrorResult& result) {
    Json json{{"device", result.device},      {"cores", std::thread::hardware_concurrency()},
              {"references", Json::array()},  {"methods", getMethods(result)},
              {"predictions", Json::array()}, {"verdicts", getVerdicts(claims(result))},
              {"points", Json::array()}};
    for (const Reference& r : result.references)
        json["references"].push_back({{"scene", r.scene},
                                      {"source", r.source},
                                      {"rays", r.rays},
                                      {"error", r.error},
                                      {"error_tvg", r.error_tvg}});
    for (const Prediction& p : result.predictions)
        json["predictions"].push_back({{"scene", p.scene},
                                       {"target_error", p.target_error},
                                       {"rows", p.rows},
                                       {"columns_per_beam", p.columns_per_beam},
                                       {"predicted_error", p.predicted_error},
                                       {"rel_l2_tvg", p.error}});
    for (const Measurement& m : result.measurements) json["points"].push_back(toJson(m, result));
    return json;
}

int runStudy(ErrorCommandOptions options) {
    const std::vector<StudyScene> scenes = makeScenes(options);
    console::OutputFolder folder(options.out, "study_error");
    console::StudyProgress progress(!options.quiet, scenes.size());
    size_t scene = 0;
    options.study.progress = [&](const std::string& at) {
        for (; !at.starts_with(scenes[scene].name + " ") && scene + 1 < scenes.size(); ++scene) progress.advance();
        progress(at + ", scenes");
    };
    const ErrorResult result = studyError(scenes, options.study);
    folder.keep();
    console::write(toJson(result), (folder.path() / "error_time.json").string());
    const std::filesystem::path sheet = folder.path() / "error_time.md";
    if (std::ofstream file(sheet, std::ios::binary); !(file << makeSheet(result)).flush())
        throw std::runtime_error(sheet.string() + " cannot be written");
    progress.end();

    bool all = true, open = false;
    for (const Claim& claim : claims(result)) {
        all = all && !claim.fails();
        open = open || (!claim.fails() && !claim.holds());
        console::printResult("{}  {}: {:.4g}, {} {:.4g}\n", claim.verdict(), claim.text, claim.measured,
                             claim.at_most ? "at most" : "at least", claim.bound);
    }
    if (open)
        console::printResult(
            "open: --levels or --reference-rays are too few to decide; nothing is wrong with the scene\n");
    console::printResult("{} points; report in {}\n", result.measurements.size(), sheet.string());
    return all ? 0 : 1;
}

}  // namespace

void addErrorStudy(CLI::App& study, console::Action& action) {
    const auto options = std::make_shared<ErrorCommandOptions>();
    CLI::App* command = study.add_subcommand("error", "Error against run time, for each way to estimate an echo");
    command->add_option(
        "DEPLOYMENT", options->deployment,
        "a YAML file whose sonar and scene are studied, normal maps as rendered; absent: all scenes of the study");
    command->add_option("--out", options->out, "folder of the report");
    command->add_option("--scene", options->scenes, "only this scene of the study (repeat for more scenes)");
    command->add_flag(
        "--effects", options->effects,
        "each scene again with beam pattern and pulse, with seabeds by TR 9407, with water that scatters, "
        "under a flat surface, and with coherent speckle");
    command->add_option("--ping", options->ping, "which ping of the deployment")->check(CLI::PositiveNumber);
    command->add_option("--pings", options->study.pings, "pings timed for each point")->check(CLI::Range(1, 1000));
    command
        ->add_option("--levels", options->study.levels,
                     "number of doublings of rows and columns, plus one (5; 4 without a closed form)")
        ->check(CLI::Range(1, 6));
    command
        ->add_option("--reference-rays", options->study.reference_rays,
                     "max number of rays and points of a reference without a closed form")
        ->check(CLI::Range(1e3, 1e12));
    command
        ->add_option("--poses", options->study.coherent_poses,
                     "number of poses over which pings with coherent speckle are averaged")
        ->check(CLI::Range(2, 100000));
    command->add_flag("--quiet", options->quiet, "no progress");
    command->callback([options, &action] { action = [options] { return runStudy(*options); }; });
}

}  // namespace insonify::study
