// insonify explain DEPLOYMENT --ping N --beam B --bin K
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>

#include "components/command/CommandLine.hpp"
#include "components/command/RunCommand.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/deployer/Simulation.hpp"
#include "components/deployer/StopSignal.hpp"
#include "components/framework/Deployment.hpp"
#include "components/framework/Port.hpp"
#include "components/sonar/renderer/BinExplanation.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

struct ExplainOptions {
    RunOptions run;
    std::string task;
    uint64_t ping = 0, beam = 0, bin = 0;  ///< The ping from 1, beam and bin from 0.
    bool json = false;
};

/** A bin of a run, and what the tasks after the sonar made of it. */
struct ExplainedBin {
    std::string sonar;
    types::SonarPtr ping;
    sonar::BinExplanation explanation;
    std::vector<std::pair<std::string, types::SonarPtr>> later;  ///< By "task.port", in the order of the samples.
};

[[noreturn]] void refuse(const ExplainOptions& options, const std::string& option, const std::string& why) {
    throw types::ConfigError(options.run.deployment, option, why);
}

std::string chooseSonar(const framework::Deployment& deployment, const ExplainOptions& options) {
    std::vector<std::string> names;
    for (const auto& task : deployment.tasks())
        if (dynamic_cast<const sonar::PingTask*>(task.get())) names.push_back(task->name());
    const std::string known = fmt::format("{}", fmt::join(names, ", "));
    if (names.empty()) refuse(options, "tasks", "has no sonar: there is no ping to explain");
    if (options.task.empty() && names.size() > 1)
        refuse(options, "--task", "is absent, and there are several sonars; must be one of: " + known);
    if (!options.task.empty() && std::ranges::count(names, options.task) == 0)
        refuse(options, "--task",
               fmt::format("is {}, which is no sonar here; must be one of: {}", options.task, known));
    return options.task.empty() ? names.front() : options.task;
}

bool writesPings(const framework::TaskContext& task) {
    return std::ranges::any_of(task.outputs(), [](const framework::OutputPortBase* port) {
        return port->typeName() == types::Sonar::type_name;
    });
}

/** Returns the deployment with one sonar, what it needs, and the tasks that its pings pass. */
framework::DeploymentSpec findChain(const framework::DeploymentSpec& spec, const framework::Deployment& whole,
                                    const std::string& sonar) {
    std::set<std::string> kept{sonar};
    for (size_t before = 0; before != kept.size();) {
        before = kept.size();
        for (const framework::Connection& connection : whole.connections())
            if (kept.contains(connection.from->owner().name()) &&
                connection.from->typeName() == types::Sonar::type_name && writesPings(connection.to->owner()))
                kept.insert(connection.to->owner().name());
    }
    return restrictedTo(spec, upstream(kept, whole));
}

/** Runs, as `run --pings` does, until the sonar has written a ping. */
void runTo(framework::Deployment& deployment, const sonar::PingTask& sonar, const ExplainOptions& options) {
    deployment.configure();
    std::atomic<bool> stop = false;
    const std::atomic<bool>& signalled = stopOnSignals();
    const framework::RunResult result =
        deployment.run({.samples = std::numeric_limits<uint64_t>::max()}, stop,
                       [&](const framework::Progress&) { stop = signalled || sonar.ping.written() >= options.ping; });
    if (result.failed()) throw std::runtime_error(result.failures.front());
    const uint64_t pings = sonar.ping.written();
    if (pings < options.ping && signalled)
        throw std::runtime_error(fmt::format("stopped by a signal after {} pings", pings));
    if (pings < options.ping)
        refuse(options, "--ping", fmt::format("is {}; the run has {} pings", options.ping, pings));
}

ExplainedBin runExplain(const ExplainOptions& options) {
    framework::Registry registry = coreTasks();
    const framework::DeploymentSpec spec = loadSpec(options.run);
    const framework::Deployment whole(spec, registry);
    ExplainedBin bin;
    bin.sonar = chooseSonar(whole, options);
    std::vector<std::unique_ptr<PingReader>> readers;  // outlive the tasks that write to them
    framework::Deployment deployment(findChain(spec, whole, bin.sonar), registry);
    auto& sonar = dynamic_cast<sonar::PingTask&>(*deployment.task(bin.sonar));
    for (const auto& task : deployment.tasks())
        for (framework::OutputPortBase* port : task->outputs())
            if (port->typeName() == types::Sonar::type_name &&
                (task->name() == bin.sonar || !dynamic_cast<sonar::PingTask*>(task.get())))
                port->connectTo(readers.emplace_back(std::make_unique<PingReader>(port->path()))->ping,
                                framework::ConnPolicy::circularBuffer(1));
    runTo(deployment, sonar, options);
    for (const auto& reader : readers) {
        types::SonarPtr ping;
        if (!reader->ping.readNew(ping)) continue;
        if (reader->name() == sonar.ping.path())
            bin.ping = ping;
        else
            bin.later.emplace_back(reader->name(), ping);
    }
    for (const auto& [name, value, count] : {std::tuple("--beam", options.beam, bin.ping->beam_count),
                                             std::tuple("--bin", options.bin, bin.ping->bin_count)})
        if (value >= count) refuse(options, name, fmt::format("is {}; must be 0 to {}", value, count - 1));
    const sonar::PingTask::RenderedBeam beam = sonar.renderedBeam(options.beam);
    bin.explanation = sonar::explainBin(beam.config, beam.scene, beam.beam, options.bin);
    return bin;
}

Json numberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json partJson(const sonar::BinPart& part, double intensity) {
    Json json = {{"name", part.name}, {"intensity", part.intensity}, {"share", part.intensity / intensity}};
    if (!part.of_surface) return json;
    const sonar::SurfaceEcho& echo = *part.of_surface;
    Json triangles = Json::array();
    for (const auto& [number, share] : echo.triangles) triangles.push_back({{"triangle", number}, {"share", share}});
    json.update({{"path", echo.path},
                 {"material", echo.material},
                 {"law", echo.law},
                 {"strength_db", numberOrNull(echo.strength_db)},
                 {"grazing_deg", numberOrNull(types::degrees(echo.grazing))},
                 {"elevation_deg", numberOrNull(types::degrees(echo.elevation))},
                 {"strongest_bearing_deg", numberOrNull(types::degrees(echo.bearing))},
                 {"strongest_range_m", numberOrNull(echo.range)},
                 {"is_in_beam", echo.is_in_beam},
                 {"triangles", triangles}});
    return json;
}

/** Returns the bin of a later ping; none where it has another grid or is not of the same time. */
std::optional<double> laterBin(const ExplainedBin& bin, const types::Sonar& later, const ExplainOptions& options) {
    if (later.time != bin.ping->time || later.bins.size() != bin.ping->bins.size()) return {};
    return double{later.bins[options.beam * later.bin_count + options.bin]};
}

Json explainedJson(const ExplainedBin& bin, double intensity, const ExplainOptions& options) {
    const sonar::BinExplanation& all = bin.explanation;
    Json parts = Json::array(), later = Json::object();
    for (const sonar::BinPart& part : all.parts) parts.push_back(partJson(part, all.intensity));
    for (const auto& [port, ping] : bin.later) {
        const auto value = laterBin(bin, *ping, options);
        later[port] = value ? Json(*value) : Json();
    }
    return {{"sonar", bin.sonar},
            {"ping", options.ping},
            {"time_s", bin.ping->time.seconds()},
            {"beam", options.beam},
            {"bin", options.bin},
            {"bearing_deg", types::degrees(bin.ping->bearings[options.beam].rad)},
            {"near_m", all.near_edge},
            {"far_m", all.far_edge},
            {"intensity", intensity},
            {"explained", all.intensity},
            {"is_mean", all.is_mean},
            {"depends_on_past", all.depends_on_past},
            {"parts", parts},
            {"why_no_surface", all.why_no_surface},
            {"later", later}};
}

void printText(const ExplainedBin& bin, double intensity, const ExplainOptions& options) {
    const sonar::BinExplanation& all = bin.explanation;
    console::printResult("{}, ping {} at {:.3f} s, beam {} at {:.2f} deg, bin {} at {:.3f} to {:.3f} m: {}\n",
                         bin.sonar, options.ping, bin.ping->time.seconds(), options.beam,
                         types::degrees(bin.ping->bearings[options.beam].rad), options.bin, all.near_edge, all.far_edge,
                         sonar::intensityText(intensity));
    if (!all.is_mean && !all.depends_on_past &&
        std::abs(all.intensity - intensity) > 1e-4 * std::max(all.intensity, intensity))
        console::printResult("  the sonar has changed its quality after this ping; with that it is {}\n",
                             sonar::intensityText(all.intensity));
    console::addResult(sonar::text(all));
    for (const auto& [port, ping] : bin.later) {
        const auto value = laterBin(bin, *ping, options);
        console::printResult("  then {}: {}\n", port, value ? fmt::format("{:.6g}", *value) : "other beams or bins");
    }
}

int explain(const ExplainOptions& options) {
    if (options.ping == 0) refuse(options, "--ping", "is 0; pings count from 1");
    const ExplainedBin bin = runExplain(options);
    const double intensity{bin.ping->bins[options.beam * bin.ping->bin_count + options.bin]};
    options.json ? print(explainedJson(bin, intensity, options)) : printText(bin, intensity, options);
    return 0;
}

}  // namespace

void addExplainCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<ExplainOptions>();
    CLI::App* command = app.add_subcommand("explain", "Shows what made a bin of a ping: objects, laws, paths, effects");
    options->run.addDeploymentTo(*command);
    for (const auto& [name, value, what] : {std::tuple("--ping", &options->ping, "number of the ping, from 1"),
                                            std::tuple("--beam", &options->beam, "number of the beam, from 0"),
                                            std::tuple("--bin", &options->bin, "number of the bin, from 0")})
        command->add_option(name, *value, what)->required()->check(console::refuseUnlessWhole);
    command->add_option("--task", options->task, "the sonar, where there are several");
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] { action = [options] { return explain(*options); }; });
}

}  // namespace insonify::command
