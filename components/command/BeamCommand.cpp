// insonify beam DEPLOYMENT
#include <fmt/core.h>

#include <cmath>
#include <memory>

#include "components/command/CommandLine.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/framework/Deployment.hpp"
#include "components/sonar/bins/EchoGrid.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "components/sonar/tasks/SideScanTask.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

using types::degrees, types::radians;

/** Two-way levels along one axis, and their data-sheet figures. */
struct Cut {
    std::vector<double> angle_deg, level_db;
    acoustics::CutShape shape;

    void add(double angle, double power) {
        if (!(power > 0)) return;
        angle_deg.push_back(degrees(angle));
        level_db.push_back(10 * std::log10(power));
    }
};

/** Returns the cut of a beam or an aperture with a box pattern. */
Cut makeBox(double low, double high) {
    Cut cut;
    cut.add(low, 1);
    cut.add(high, 1);
    cut.shape = {high - low, (high - low) / 2, {}};
    return cut;
}

/** Returns the azimuth cut of the beam nearest to straight ahead, at the azimuth cells, as the cells are weighted. */
Cut azimuthCut(const sonar::RenderPlan& plan) {
    const auto nearer = [](const sonar::Beam& a, const sonar::Beam& b) {
        return std::abs(a.centre) < std::abs(b.centre);
    };
    const auto ahead = std::min_element(plan.beams.begin(), plan.beams.end(), nearer);
    if (!plan.has(sonar::Pass::Beamform)) return makeBox(ahead->low - ahead->centre, ahead->high - ahead->centre);
    const std::vector<double> weights =
        sonar::beamformer(plan).weights(static_cast<size_t>(ahead - plan.beams.begin()));
    Cut cut;
    for (size_t c = 0; c < weights.size(); ++c) cut.add(plan.cells[c].centre - ahead->centre, weights[c]);
    const double axis = plan.directivity->azimuth(ahead->centre, ahead->centre);
    cut.shape = acoustics::getShape(
        [&](double angle) { return plan.directivity->azimuth(ahead->centre + angle, ahead->centre) / axis; });
    return cut;
}

/** Returns the weights of the rows of samples. */
Cut elevationCut(const sonar::RenderPlan& plan) {
    const double half = radians(plan.sampled.beam_height_deg) / 2;
    if (!plan.directivity || !plan.directivity->hasElevation()) return makeBox(-half, half);
    constexpr int steps = 2000;
    Cut cut;
    for (int i = 0; i <= steps; ++i) {
        const double angle = half * (2.0 * i / steps - 1);
        cut.add(angle, plan.directivity->elevation(angle));
    }
    const double axis = plan.directivity->elevation(0);
    cut.shape = acoustics::getShape([&](double angle) { return plan.directivity->elevation(angle) / axis; });
    return cut;
}

Json cutJson(const Cut& cut) {
    const auto orNull = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
    Json first_null = cut.shape.first_null ? Json(degrees(*cut.shape.first_null)) : Json();
    return {{"angle_deg", cut.angle_deg},
            {"level_db", cut.level_db},
            {"width_3db_deg", degrees(cut.shape.width_3db)},
            {"first_null_deg", first_null},
            {"peak_sidelobe_db", orNull(cut.shape.peak_sidelobe_db)}};
}

void printCut(const char* name, const Cut& cut) {
    const auto shown = [](const std::optional<double>& value, const char* unit) {
        return value ? fmt::format("{:.3f} {}", *value, unit) : std::string("none");
    };
    std::optional<double> first_null;
    if (cut.shape.first_null) first_null = degrees(*cut.shape.first_null);
    console::printResult("{}, two way: {:.3f} deg at -3 dB, first null {}, highest sidelobe {}\n", name,
                         degrees(cut.shape.width_3db), shown(first_null, "deg"),
                         shown(cut.shape.peak_sidelobe_db, "dB"));
}

struct BeamOptions {
    std::string deployment, task;
    std::vector<std::string> set;
    bool json = false;
};

const sonar::PingTask& getSonar(const framework::Deployment& deployment, const BeamOptions& options) {
    std::string names;
    for (const auto& task : deployment.tasks()) {
        const auto* sonar = dynamic_cast<const sonar::PingTask*>(task.get());
        if (sonar && (options.task.empty() || options.task == task->name())) return *sonar;
        if (sonar) names += (names.empty() ? "" : ", ") + task->name();
    }
    const std::string has = names.empty() ? "there is none" : "may be " + names;
    if (options.task.empty()) throw types::ConfigError(options.deployment, "", "has no sonar");
    throw types::ConfigError(options.deployment, "--task", fmt::format("is {}, no sonar; {}", options.task, has));
}

int showBeam(const BeamOptions& options) {
    framework::Registry registry = coreTasks();
    const std::string file = deploymentIn(options.deployment);
    framework::DeploymentSpec spec = framework::DeploymentSpec::load(file);
    for (const std::string& assignment : options.set) spec.set(assignment);
    const framework::Deployment deployment(std::move(spec), registry);
    const sonar::PingTask& sonar = getSonar(deployment, options);
    const sonar::RenderPlan plan = sonar::makeRenderPlan(sonar.locatedConfig(), types::Geometry{});
    Cut azimuth = azimuthCut(plan), elevation = elevationCut(plan);
    if (dynamic_cast<const sonar::SideScanTask*>(&sonar)) std::swap(azimuth, elevation);  // rendered as a turned fan
    if (options.json) {
        print(Json{{"azimuth", cutJson(azimuth)}, {"elevation", cutJson(elevation)}});
    } else {
        printCut("azimuth", azimuth);
        printCut("elevation", elevation);
    }
    return 0;
}

}  // namespace

void addBeamCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<BeamOptions>();
    CLI::App* command = app.add_subcommand("beam", "Shows a sonar's beam, two way, as its echoes are weighed");
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file, or a folder with one deployment")->required();
    command->add_option("--task", options->task, "the sonar; absent: the first");
    command
        ->add_option("--set", options->set,
                     "task.property.path=value: a property other than in the file; may be repeated")
        ->allow_extra_args(false);
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] { action = [options] { return showBeam(*options); }; });
}

}  // namespace insonify::command
