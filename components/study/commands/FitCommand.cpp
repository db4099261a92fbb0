// insonify fit DEPLOYMENT --real FILES --out FITTED.yml
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "components/console/Console.hpp"
#include "components/console/ProgressLine.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/FittedDeployment.hpp"
#include "components/study/PictureFile.hpp"
#include "components/study/commands/StudyCommand.hpp"
#include "components/study/fit/FitReport.hpp"
#include "components/study/fit/RecordingFit.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::study {
namespace {

namespace fs = std::filesystem;

struct FitOptions {
    std::string deployment, out, scene_is = "known";
    std::vector<std::string> real;
    uint64_t ping = 1;
    bool quiet = false;
    std::string shape;
    PictureConfig pictures;
};

/** Refuses recordings that do not exist and a result that cannot be written, before anything is computed. */
void refuseFiles(const FitOptions& options) {
    types::Diagnostics wrong;
    for (const std::string& real : options.real)
        if (std::error_code none; !fs::exists(real, none))
            wrong.push_back({"--real", "does not exist; may be a file or a folder of them", real});
    const fs::path path(options.out), folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const std::string end = path.extension().string();
    std::error_code none;
    if (fs::is_directory(path, none))
        wrong.push_back({"--out", "is a folder; give the name of a file, FITTED.yml", options.out});
    else if (!fs::is_directory(folder, none))
        wrong.push_back({"--out", "is in a folder that does not exist: " + folder.string(), options.out});
    else if (fs::equivalent(path, deployer::deploymentIn(options.deployment), none))
        wrong.push_back({"--out", "is the deployment that is fitted; give another file", options.out});
    else if (end != ".yml" && end != ".yaml")
        wrong.push_back({"--out", "must end in .yml or .yaml", options.out});
    if (!wrong.empty()) throw types::ConfigError(std::move(wrong));
}

void printFindings(const RecordingFit& fit) {
    for (const Finding& finding : fit.findings) console::printResult("{:<20} {}\n", finding.name, finding.text());
    console::printResult("{:<20} {:.1f} dB rms\n", "levels unexplained", fit.levels.rms_db);
}

int runFit(const FitOptions& options) {
    refuseFiles(options);
    ChainAt at = chainAt(options.deployment, options.ping, {});
    const receiver::CodeConfig law = at.chain.code();
    PictureConfig pictures = options.pictures;
    if (!options.shape.empty()) pictures.is_fan = options.shape == "fan";
    if (pictures.range <= 0) pictures.range = at.chain.sonar.range;
    if (pictures.beams == 0) pictures.beams = static_cast<size_t>(at.chain.sonar.beams());
    const std::vector<CodedPing> recorded = recordedPings(options.real, &law, readLog, &pictures);
    console::StudyProgress progress(!options.quiet);
    const RecordingFit fit = fitRecording(recorded, std::move(at.chain), options.scene_is == "rough",
                                          [&](const std::string& doing) { progress(doing); });
    progress.end();
    const std::vector<std::string> head{
        "Fitted by insonify fit to " + fs::path(recorded.front().file).filename().string() +
            (recorded.front().is_waterfall ? fmt::format(": {} lines.", recorded.front().beam_count)
                                           : fmt::format(": {} pings.", recorded.size())),
        "Intervals are of 95 %. Properties that the recording does not determine have "
        "values consistent with the others."};
    std::vector<deployer::CommentedSetting> settings;
    for (const FitSetting& each : getSettings(fit, at.tasks)) settings.push_back({each.path, each.value, each.comment});
    std::ofstream file(options.out, std::ios::binary);
    if (!(file << deployer::deploymentWith(options.deployment, settings, fs::absolute(options.out).parent_path(), head))
             .flush())
        throw types::ConfigError(options.out, "--out", "cannot be written");
    const fs::path page = writePage(fit, recorded, options.out);
    printFindings(fit);
    console::printResult("deployment in {}, page in {}\n", options.out, page.string());
    return 0;
}

}  // namespace

void addFit(CLI::App& app, console::Action& action) {
    const auto options = std::make_shared<FitOptions>();
    CLI::App* command = app.add_subcommand("fit", "Finds the properties of a real sonar from its recordings");
    command
        ->add_option("DEPLOYMENT", options->deployment,
                     "a YAML file with scene, sonar, noise and a receiver that outputs codes")
        ->required();
    command->add_option("--real", options->real, "recordings, or .png pictures of pings: files, or folders of them")
        ->required();
    const auto picture = [&](const char* name, double& value, double max, const char* meaning) {
        command->add_option(name, value, std::string("of a picture: ") + meaning)->check(CLI::Range(1e-3, max));
    };
    command->add_option("--shape", options->shape, "of a picture: fan, or polar with a column for each beam")
        ->check(CLI::IsMember({"fan", "polar"}));
    picture("--range", options->pictures.range, 1e5, "slant range of its far edge; absent: the deployment's [m]");
    picture("--range-min", options->pictures.range_min, 1e5,
            "slant range of its near edge; absent: 0, a fan shows it [m]");
    picture("--field-of-view-deg", options->pictures.field_of_view_deg, 360, "angle between its sides; a fan shows it");
    command
        ->add_option(
            "--scene-is", options->scene_is,
            "known: levels follow from the scene; rough: the scene is a floor or a tank of about the right kind")
        ->check(CLI::IsMember({"known", "rough"}));
    command->add_option("--out", options->out, "the fitted deployment, FITTED.yml; a page and a picture are next to it")
        ->required();
    command->add_option("--ping", options->ping, "ping of the deployment at the place of the recording")
        ->check(CLI::PositiveNumber);
    command->add_flag("--quiet", options->quiet, "no progress");
    command->callback([options, &action] { action = [options] { return runFit(*options); }; });
}

}  // namespace insonify::study
