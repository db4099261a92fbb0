// insonify dataset DEPLOYMENT --sweep SWEEP --out DIR
#include "components/dataset/commands/DatasetCommand.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "components/console/Action.hpp"
#include "components/console/Console.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/console/ProgressLine.hpp"
#include "components/console/Shard.hpp"
#include "components/dataset/Collection.hpp"
#include "components/dataset/commands/DatasetRun.hpp"
#include "components/deployer/StopSignal.hpp"

namespace insonify::dataset {
namespace {

namespace fs = std::filesystem;

struct DatasetOptions {
    std::string deployment, sweep, out, format = "coco", shard = "0/1";
    Changes changes;
    bool quiet = false;
};

Format formatOf(const std::string& name) {
    const auto& names = types::EnumNames<Format>::names;
    return static_cast<Format>(std::ranges::find(names, name) - std::begin(names));
}

struct Made {
    uint64_t made = 0, found = 0;
    bool stopped = false;
};

/** Makes the missing samples of a shard. */
Made makeMissing(DatasetRun& run, Store& store, const DatasetOptions& options) {
    const console::Shard shard = console::Shard::read(options.shard);
    const std::atomic<bool>& stop = deployer::stopOnSignals();
    const uint64_t count = run.samples().count();
    SampleFiles files(run.sweep(), run.format(), run.classes(), store);
    console::ProgressLine line(!options.quiet);
    const auto start = std::chrono::steady_clock::now();
    Made done;
    for (uint64_t index = shard.index; index < count && !done.stopped; index += shard.count) {
        if (store.has(index)) {
            ++done.found;
        } else {
            run.make(index, files);
            ++done.made;
        }
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
        const double share = static_cast<double>(index + 1) / static_cast<double>(count);
        line.show(wall.count(), fmt::format("sample {} of {}{}", index, count, console::timeLeft(share, wall.count())));
        done.stopped = stop;
    }
    return done;
}

int makeDataset(const DatasetOptions& options) {
    DatasetRun run(options.deployment, options.sweep, formatOf(options.format), options.changes);
    console::OutputFolder folder(options.out, options.deployment);
    folder.keep();
    Store store(folder.path(), run.digest());
    const Made done = makeMissing(run, store, options);
    if (!options.quiet)
        console::printResult("{} of {} samples in {}, {} of them new{}\n", done.made + done.found,
                             run.samples().count(), folder.path().string(), done.made,
                             done.stopped ? "; the same command makes the others" : "");
    if (done.stopped) return 1;
    const Title title{fs::path(run.deployment()).filename(), fs::path(options.sweep).filename(), INSONIFY_VERSION,
                      run.format(), run.sweep().trajectory.has_value() && !run.sweep().lines};
    Collection collection(title, run.samples().count(), run.classes(), store);
    if (!collection.isWhole(false)) {
        if (!options.quiet)
            console::printResult("others are missing; the run that makes the last one writes manifest.json\n");
        return 0;
    }
    if (!collection.isWhole(true))
        throw std::runtime_error("a sample of another shard is damaged; run that shard again");
    collection.write();
    if (!options.quiet) console::printResult("all are there: manifest.json, statistics.html\n");
    return 0;
}

}  // namespace

void addCommand(CLI::App& app, console::Action& action) {
    const auto options = std::make_shared<DatasetOptions>();
    CLI::App* command =
        app.add_subcommand("dataset", "Makes a training data set: pictures with their objects and places");
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file, or a folder with one deployment")->required();
    command->add_option("--sweep", options->sweep, "a YAML file with scenes, poses, settings")->required();
    command->add_option("--out", options->out, "folder of the data set; existing samples are kept")->required();
    const auto& names = types::EnumNames<Format>::names;
    command->add_option("--format", options->format, "file format of samples")
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(names), std::end(names))))
        ->capture_default_str();
    command->add_option("--shard", options->shard, "i/N: makes each sample whose number leaves i when divided by N")
        ->check([](const std::string& text) { return console::Shard::refuse(text); });
    command
        ->add_option("--set", options->changes.set,
                     "task.property.path=value: a property other than in the deployment; may be repeated")
        ->allow_extra_args(false);
    command->add_option("--seed", options->changes.seed, "the sweep's seed (0: the seed in the sweep)")
        ->type_name("N")
        ->check(console::refuseUnlessWhole);
    command->add_flag("--quiet", options->quiet, "no progress and no summary");
    command->callback([options, &action] { action = [options] { return makeDataset(*options); }; });
}

}  // namespace insonify::dataset
