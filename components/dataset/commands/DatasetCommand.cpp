#include "components/dataset/commands/DatasetRun.hpp"

// insonify dataset DEPLOYMENT --sweep SWEEP --out DIR; insonify dataset join PART... --out DIR

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <set>
#include <utility>

#include "components/console/Action.hpp"
#include "components/console/Console.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/console/ProgressLine.hpp"
#include "components/console/Shard.hpp"
#include "components/dataset/Collection.hpp"
#include "components/deployer/StopSignal.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::dataset {
namespace {

namespace fs = std::filesystem;

struct DatasetOptions {
    std::string deployment, sweep, out, format = "coco", shard = "0/1";
    Changes changes;
    bool quiet = false;
};

Format getFormat(const std::string& name) {
    const auto& names = types::EnumNames<Format>::names;
    return static_cast<Format>(std::ranges::find(names, name) - std::begin(names));
}

struct Made {
    uint64_t made = 0, found = 0;
    std::set<uint64_t> complete;  ///< Their numbers: they need not be verified again.
    bool stopped = false;
};

void printWarnings(DatasetRun& run, const DatasetOptions& options) {
    for (const std::string& warning : run.consumeWarnings())
        if (!options.quiet) console::printDiagnostic("warning: {}\n", warning);
}

/** Makes the missing samples of a shard. */
Made makeMissing(DatasetRun& run, Store& store, const DatasetOptions& options) {
    const console::Shard shard = console::Shard::read(options.shard);
    const std::atomic<bool>& stop = deployer::stopOnSignals();
    const Selection& selection = run.selection();
    SampleFiles files(run.sweep(), run.format(), run.classes(), store);
    printWarnings(run, options);
    console::ProgressLine line(!options.quiet);
    const auto start = std::chrono::steady_clock::now();
    Made done;
    for (uint64_t i = shard.index; i < selection.size() && !done.stopped; i += shard.count) {
        const uint64_t index = selection[i];
        if (store.has(index)) {
            ++done.found;
        } else {
            run.make(index, files);
            printWarnings(run, options);
            ++done.made;
        }
        done.complete.insert(index);
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
        const double share = static_cast<double>(i + 1) / static_cast<double>(selection.size());
        line.show(wall.count(),
                  fmt::format("sample {} of {}{}", i, selection.size(), console::timeLeft(share, wall.count())));
        done.stopped = stop;
    }
    return done;
}

int makeDataset(const DatasetOptions& options) {
    DatasetRun run(options.deployment, options.sweep, getFormat(options.format), options.changes);
    console::OutputFolder folder(options.out, options.deployment);
    folder.keep();
    Collection collection(run.title(options.sweep), folder.path());
    collection.describe();
    const Made done = makeMissing(run, collection.store(0), options);
    const uint64_t all = run.selection().size();
    const console::Shard shard = console::Shard::read(options.shard);
    const uint64_t own = all / shard.count + (shard.index < all % shard.count ? 1 : 0);
    if (!options.quiet)
        console::printResult("{}{} of {} samples in {}, {} of them new{}\n",
                             shard.count > 1 ? fmt::format("shard {}: ", options.shard) : "", done.made + done.found,
                             own, folder.path().string(), done.made,
                             done.stopped ? "; the same command makes the others" : "");
    if (done.stopped) return 1;
    if (!collection.isWhole(false)) {
        if (!options.quiet)
            console::printResult(
                "of the {} samples of all shards some are missing; the run that makes the last one "
                "writes manifest.json\n",
                all);
        return 0;
    }
    if (!collection.isWhole(true, done.complete))
        throw std::runtime_error("a sample of another shard is damaged; run that shard again");
    collection.write();
    if (!options.quiet)
        console::printResult("all{} are there: manifest.json, statistics.html\n",
                             shard.count > 1 ? fmt::format(" {} samples of all shards", all) : "");
    return 0;
}

struct JoinOptions {
    std::vector<std::string> parts;
    std::string out;
    bool quiet = false;
};

/** Joins the folders of parts to one data set in another folder. */
int joinParts(const JoinOptions& options) {
    const Parts parts({options.parts.begin(), options.parts.end()}, INSONIFY_VERSION);
    for (const std::string& part : options.parts)
        if (std::error_code none; fs::equivalent(part, options.out, none))
            throw types::ConfigError("", "--out", fmt::format("is {}, one of the parts; give another folder", part));
    console::OutputFolder folder(options.out, "");
    Collection collection(parts.title(), folder.path());
    folder.keep();
    collection.describe();
    parts.copyTo(collection);
    collection.write();
    if (options.quiet) return 0;
    uint64_t samples = 0;
    for (size_t member = 0; member < parts.title().members.size(); ++member)
        samples += collection.selection(member).size();
    console::printResult("{} samples of {} parts in {}: manifest.json, statistics.html\n", samples,
                         options.parts.size(), folder.path().string());
    return 0;
}

void addJoinCommand(CLI::App& dataset, console::Action& action) {
    const auto options = std::make_shared<JoinOptions>();
    CLI::App* command = dataset.add_subcommand("join", "Joins shards, or sets with other seeds, to one data set");
    command->add_option("PART", options->parts, "folders of data sets that `insonify dataset` has made")->required();
    command->add_option("--out", options->out, "folder of the joined data set")->required();
    command->add_flag("--quiet", options->quiet, "no summary");
    command->callback([options, &action] { action = [options] { return joinParts(*options); }; });
}

}  // namespace

void addCommand(CLI::App& app, console::Action& action) {
    const auto options = std::make_shared<DatasetOptions>();
    CLI::App* command =
        app.add_subcommand("dataset", "Makes a training data set: pictures with their objects and places");
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file, or a folder with one deployment");
    command->add_option("--sweep", options->sweep, "a YAML file with scenes, poses, settings");
    command->add_option("--out", options->out, "folder of the data set; existing samples are kept");
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
    command
        ->add_option("--count", options->changes.count,
                     "draws this number of samples from those of the sweep, by its seed")
        ->type_name("N")
        ->check(console::refuseUnlessWhole);
    command->add_option("--seed", options->changes.seed, "the sweep's seed (0: the seed in the sweep)")
        ->type_name("N")
        ->check(console::refuseUnlessWhole);
    command->add_flag("--quiet", options->quiet, "no progress and no summary");
    addJoinCommand(*command, action);
    command->callback([options, command, &action] {
        if (!command->get_subcommands().empty()) return;
        for (const auto& [name, value] :
             {std::pair("DEPLOYMENT", &options->deployment), {"--sweep", &options->sweep}, {"--out", &options->out}})
            if (value->empty()) throw CLI::RequiredError(name);
        action = [options] { return makeDataset(*options); };
    });
}

}  // namespace insonify::dataset
