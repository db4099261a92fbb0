// insonify study omission DEPLOYMENT
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "components/console/Console.hpp"
#include "components/console/Json.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/console/ProgressLine.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/renderer/Metrics.hpp"
#include "components/sonar/renderer/PlanReport.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/commands/StudyCommand.hpp"
#include "components/study/stability/StabilityStudy.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::study {

/** The comparison of two ways to render one ping. */
struct Ablation {
    double change = 0;                   ///< Max difference of a bin, relative to the strongest bin [1].
    double rel_l2_tvg = 0;               ///< M2 between the two (Metrics.hpp) [1].
    double without_ms = 0, with_ms = 0;  ///< Medians of a ping [ms].
};

/** An effect that a plan omits, or keeps, and its influence on bins and time. */
struct OmissionRow {
    std::string name, reason;
    std::optional<Ablation> measured;  ///< None: the effect is not built; `reason` explains it.
    std::optional<double> bound;       ///< Max change that the omission may cause [1].
    std::string bound_of;              ///< The quantity of the bound, and its origin.
    bool kept = false;                 ///< Configured: shown for its influence and cost.

    /** Returns whether the omission changes at most its bound; true without a bound. */
    bool holds() const;
};

/** Renders a sonar's ping as planned, and again with each omission put back (with neutral values for some), and with
 *  each kept effect removed. Both are timed alternately over `pings` pings. */
std::vector<OmissionRow> studyOmissions(const sonar::SonarConfig& config, const types::Snapshot& snapshot, int pings,
                                        const std::function<void(const std::string&)>& progress);

using sonar::compare, sonar::Layout;
namespace {

using sonar::SonarConfig;

/** A setup to render the ping. */
struct Setup {
    SonarConfig config;
    types::Snapshot snapshot;
    sonar::RenderOptions options = {};
    int bins_in_one = 1;  ///< Number of bins that are summed before the comparison [1].
};

struct Rendered {
    std::vector<float> bins;
    std::vector<double> ms;
};

double now() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/** Sums groups of neighbouring bins; the number of bins of a beam is a multiple of `in_one`. */
std::vector<float> joined(const std::vector<float>& bins, int in_one) {
    std::vector<float> sums(bins.size() / static_cast<size_t>(in_one));
    for (size_t i = 0; i < bins.size(); ++i) sums[i / static_cast<size_t>(in_one)] += bins[i];
    return sums;
}

void render(const Setup& setup, int pings, Rendered& to) {
    sonar::SonarRenderer renderer(setup.config, setup.snapshot.geometry, setup.options);
    types::Sonar ping;
    renderer.render(setup.snapshot, ping);
    for (int i = 0; i < pings; ++i) {
        const double start = now();
        renderer.render(setup.snapshot, ping);
        to.ms.push_back(now() - start);
    }
    to.bins = joined(ping.bins, setup.bins_in_one);
}

double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

/** Renders both ways alternately, so that a slowing machine affects both equally. */
Ablation compared(const Setup& without, const Setup& with, int pings) {
    constexpr int turns = 3;
    Rendered a, b;
    for (int turn = 0; turn < turns; ++turn) {
        render(without, std::max(1, pings / turns), a);
        render(with, std::max(1, pings / turns), b);
    }
    double difference = 0, loudest = 0;
    for (size_t i = 0; i < a.bins.size(); ++i) {
        difference = std::max(difference, std::abs(static_cast<double>(a.bins[i]) - b.bins[i]));
        loudest = std::max(loudest, std::abs(static_cast<double>(b.bins[i])));
    }
    const std::vector<double> reference(b.bins.begin(), b.bins.end());
    const sonar::BinGrid grid = sonar::makeBinGrid(without.config);
    const Layout layout{without.config.beams(), grid.bin_count, grid.bin_width, 0};
    const double rel_l2_tvg = loudest > 0 ? compare(a.bins, reference, layout).rel_l2_tvg : 0;
    return {loudest > 0 ? difference / loudest : difference, rel_l2_tvg, median(a.ms), median(b.ms)};
}

/** Returns a scene in which no material has a normal map with an additional map that no object uses: all surfaces are
 *  rendered flat. */
types::GeometryPtr withFlatMap(const types::Geometry& geometry) {
    auto mapped = std::make_shared<types::Geometry>(geometry);
    mapped->materials.emplace_back().normal_map = static_cast<int>(mapped->normal_maps.size());
    mapped->normal_maps.push_back({1, 1, {128, 128, 255}, true, true});
    return mapped;
}

types::GeometryPtr changed(const types::Geometry& geometry, void (*change)(types::Material&)) {
    auto copy = std::make_shared<types::Geometry>(geometry);
    std::ranges::for_each(copy->materials, change);
    return copy;
}

/** The study of one sonar's ping. */
class Study {
public:
    Study(const SonarConfig& config, const types::Snapshot& snapshot, int pings,
          const std::function<void(const std::string&)>& progress)
        : planned_{config, snapshot}, pings_(pings), progress_(progress) {
        sonar::SonarRenderer renderer(planned_.config, snapshot.geometry);
        types::Sonar ping;
        renderer.render(snapshot, ping);
        omitted_ = renderer.renderPlan().omitted;
        std::ranges::copy(renderer.omissions(), std::back_inserter(omitted_));
    }

    std::vector<OmissionRow> run() {
        measureQuality();
        for (const sonar::Omitted& what : omitted_) rows_.push_back(measured(what));
        measureKept();
        return std::move(rows_);
    }

private:
    /** Measures the change by twice the rows and columns: the bound for effects that depend on the pixels' size. */
    void measureQuality() {
        progress_("quality");
        Setup finer = planned_;
        finer.config.quality.rows = 2 * planned_.config.rows();
        finer.config.quality.columns_per_beam = 2 * planned_.config.columnsPerBeam();
        const Ablation ablation = compared(planned_, finer, pings_);
        quality_ = ablation.rel_l2_tvg;
        rows_.push_back({"twice the rows and columns", "quality", ablation, {}, "", true});
    }

    OmissionRow measured(const sonar::Omitted& what) {
        const types::Omission words = sonar::describe(what, sonar::makeBinGrid(planned_.config));
        progress_(words.name);
        OmissionRow row{words.name, words.reason, {}, {}, "", false};
        Setup without = planned_;
        const bool splits_bins = what.effect == "absorption inside a bin";
        if (splits_bins) {  // other effects change with the bins
            without.config.pulse.reset();
            without.config.imperfections.reset();
            without.config.speckle.reset();
            without.snapshot.targets.clear();
        }
        Setup with = without;
        if (!putBack(what, with, row)) return row;
        row.measured = compared(without, with, pings_);
        if (splits_bins) {  // sampling changes with the bins as well
            without.config.absorption.reset();
            with.config.absorption.reset();
            *row.bound += compared(without, with, 1).rel_l2_tvg;
        }
        return row;
    }

    /** Puts back an omission; returns false if that is impossible. */
    bool putBack(const sonar::Omitted& what, Setup& with, OmissionRow& row) const {
        const auto bound = [&](double value, const char* of) {
            row.bound = value;
            row.bound_of = of;
            return true;
        };
        using Put = std::function<bool()>;
        const Put draw_all = [&] {
            with.config.draw_all = true;
            return bound(1e-5, "change: pixels beyond the range that reach back into it");
        };
        const std::map<std::string_view, Put> ways{
            {"absorption",
             [&] {
                 with.config.absorption.emplace().db_per_m = 0;
                 return bound(0, "change: 0 dB/m");
             }},
            {"range point-spread",
             [&] {
                 return planned_.config.model == sonar::Model::Physical && !hasPoints() && neutralPulse(with, row);
             }},
            {"transmit ring-down", [&] { return !hasPoints() && weakRingDown(with, row); }},
            {"point targets",
             [&] {
                 if (what.reason != sonar::Reason::NoneInScene) return false;
                 with.snapshot.targets = {{with.snapshot.sonar.worldFromBody() * glm::dvec4(1, 0, 0, 1), -3000}};
                 return bound(0, "change: a target of -3000 dB");
             }},
            {"multipath",
             [&] {
                 if (what.reason != sonar::Reason::NotConfigured) return false;
                 with.config.multipath.emplace().bounces = 0;
                 return bound(0, "change: no bounces");
             }},
            {"normal maps",
             [&] {
                 with.snapshot.geometry = withFlatMap(*planned_.snapshot.geometry);
                 return bound(1e-6, "change: a map that bends nothing, in float");
             }},
            {"motion within a ping",
             [&] {
                 with.config.motion_in_ping = true;
                 return planned_.config.tracesRays() && omits("thin walls") && bound(0, "change: a sonar at rest");
             }},
            {"absorption inside a bin", [&] { return splitBins(with, row); }},
            {"further slabs",
             [&] {
                 with.options.min_frusta = 2;
                 return bound(quality_, "rel_l2_tvg: what twice the rows and columns change");
             }},
            {"objects", draw_all},
            {"triangles", draw_all},
            {"slabs", draw_all}};
        const auto setup = ways.find(what.effect);
        return setup != ways.end() && setup->second();
    }

    bool omits(std::string_view effect) const {
        return std::ranges::any_of(omitted_, [&](const sonar::Omitted& what) { return what.effect == effect; });
    }
    /** Whether there are echoes of points or scatterers, which a tone as long as a bin puts into two bins. */
    bool hasPoints() const {
        const bool interferes = planned_.config.speckle && planned_.config.speckle->coherent;
        return interferes || !planned_.snapshot.targets.empty() || planned_.config.multipath.has_value();
    }

    /** Adds a tone as long as a bin, which changes nothing. */
    bool neutralPulse(Setup& with, OmissionRow& row) const {
        const sonar::BinGrid grid = sonar::makeBinGrid(planned_.config);
        with.config.pulse.emplace().duration_us = 2e6 * grid.bin_width / grid.speed_of_sound;
        row.bound = 0;
        row.bound_of = "change: a tone as long as a bin";
        return true;
    }

    /** Adds a ring-down that is zero in float. */
    bool weakRingDown(Setup& with, OmissionRow& row) const {
        if (planned_.config.model != sonar::Model::Physical) return false;
        if (!with.config.pulse) neutralPulse(with, row);
        with.config.pulse->ring_down = acoustics::RingDownConfig{-3000, 1};
        row.bound = 0;
        row.bound_of = "change: a ring-down of -3000 dB";
        return true;
    }

    /** Renders eight bins for each and sums them: absorption changes from one to the next. */
    bool splitBins(Setup& with, OmissionRow& row) const {
        constexpr int parts = 8;
        const SonarConfig& config = planned_.config;
        const sonar::BinGrid grid = sonar::makeBinGrid(config);
        if (config.model != sonar::Model::Physical || parts * grid.bin_count > 65536) return false;
        with.config.bin_count = parts * grid.bin_count;
        with.config.range = grid.range_max;
        with.config.range_rounding = sonar::RangeRounding::Exact;
        with.bins_in_one = parts;
        row.bound = std::expm1(sonar::makeAbsorption(config).intensityPerMetre() * grid.bin_width / 2);
        row.bound_of = "rel_l2_tvg: an echo at the edge of its bin, and what finer bins change without absorption";
        return true;
    }

    void measureKept() {
        const SonarConfig& config = planned_.config;
        for (const sonar::Effect* effect : sonar::effects()) {
            Setup without = planned_;
            const std::string name = effect->removeFrom(without.config);
            if (!name.empty() && !omits(name == "pulse" ? "range point-spread" : name)) keep(name, without);
        }
        Setup without = planned_;
        if (config.model == sonar::Model::Physical && !planned_.snapshot.targets.empty()) {
            without.snapshot.targets.clear();
            keep("point targets", without);
        }
        without = planned_;
        without.snapshot.geometry = changed(*planned_.snapshot.geometry, [](types::Material& material) {
            material.roughness_slope.reset();
            material.matter.clear();
        });
        if (sonar::makeMaterialLaws(config, *planned_.snapshot.geometry).hasLobes()) keep("specular lobe", without);
        without.snapshot.geometry = changed(*planned_.snapshot.geometry, [](types::Material& material) {
            material.seabed.clear();
            material.matter.clear();
            material.measured.clear();
        });
        if (!sonar::makeMaterialLaws(config, *planned_.snapshot.geometry).tables.empty())
            keep("backscatter by table", without);
        without.snapshot.geometry =
            changed(*planned_.snapshot.geometry, [](types::Material& material) { material.normal_map = -1; });
        if (std::ranges::any_of(planned_.snapshot.geometry->materials, [](const auto& m) { return m.normal_map >= 0; }))
            keep("normal maps", without);
    }

    void keep(const std::string& name, const Setup& without) {
        progress_(name);
        rows_.push_back({name, "configured", compared(without, planned_, pings_), {}, "", true});
    }

    Setup planned_;
    int pings_;
    const std::function<void(const std::string&)>& progress_;
    std::vector<sonar::Omitted> omitted_;
    double quality_ = 0;
    std::vector<OmissionRow> rows_;
};

}  // namespace

bool OmissionRow::holds() const {
    if (kept || !measured || !bound) return true;
    return (bound_of.starts_with("rel_l2_tvg") ? measured->rel_l2_tvg : measured->change) <= *bound;
}

std::vector<OmissionRow> studyOmissions(const SonarConfig& config, const types::Snapshot& snapshot, int pings,
                                        const std::function<void(const std::string&)>& progress) {
    return Study(config, snapshot, pings, progress).run();
}

namespace {

using console::Json;

struct OmissionOptions {
    std::string deployment, out;
    uint64_t ping = 1;
    int pings = 30;
    bool quiet = false;
};

const char* verdict(const OmissionRow& row) {
    if (row.kept) return "kept";
    if (!row.measured) return "not measured";
    return row.holds() ? "pass" : "FAIL";
}

Json toJson(const OmissionRow& row) {
    Json json{{"name", row.name}, {"reason", row.reason}, {"verdict", verdict(row)}};
    if (row.measured)
        json.update({{"change", row.measured->change},
                     {"rel_l2_tvg", row.measured->rel_l2_tvg},
                     {"without_ms", row.measured->without_ms},
                     {"with_ms", row.measured->with_ms}});
    if (row.bound) json.update({{"bound", *row.bound}, {"bound_of", row.bound_of}});
    return json;
}

std::string line(const OmissionRow& row) {
    if (!row.measured) return fmt::format("| {} | {} | | | | | | {} |\n", row.name, row.reason, verdict(row));
    const Ablation& a = *row.measured;
    return fmt::format("| {} | {} | {:.2g} | {:.2g} | {} | {:.3f} | {:.3f} | {} |\n", row.name, row.reason, a.change,
                       a.rel_l2_tvg, row.bound ? fmt::format("{:.2g} of {}", *row.bound, row.bound_of) : "",
                       a.without_ms, a.with_ms, verdict(row));
}

std::string sheet(const std::string& deployment, const std::vector<OmissionRow>& rows) {
    std::string text = fmt::format(
        "# Omissions of {}\n\nEach line renders one ping without and with an effect. Change: max difference of "
        "a bin over the loudest bin; rel_l2_tvg: relative L2 of all bins after a gain of 50 log10(r); times are "
        "medians of a ping. `kept` is configured, and shown for its influence and cost; `not measured` is not built, "
        "or "
        "follows from its reason alone.\n\n"
        "| what | reason | change | rel_l2_tvg | bound | without [ms] | with [ms] | verdict |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        deployment);
    for (const OmissionRow& row : rows) text += line(row);
    return text;
}

int runStudy(const OmissionOptions& options) {
    const deployer::SonarAt sonar = deployer::sonarAt(options.deployment, options.ping);
    console::OutputFolder folder(options.out, "study_omission");
    console::StudyProgress progress(!options.quiet);
    const std::vector<OmissionRow> rows =
        studyOmissions(sonar.config, sonar.snapshot, options.pings, std::ref(progress));
    progress.end();
    folder.keep();
    const std::string text = sheet(options.deployment, rows);
    std::ofstream file(folder.path() / "omission.md");
    if (!(file << text).flush())
        throw std::runtime_error((folder.path() / "omission.md").string() + " cannot be written");
    Json json = Json::array();
    for (const OmissionRow& row : rows) json.push_back(toJson(row));
    console::write(json, (folder.path() / "omission.json").string());
    console::printResult("{}", text);
    return std::ranges::all_of(rows, &OmissionRow::holds) ? 0 : 1;
}

}  // namespace

void addOmissionStudy(CLI::App& study, console::Action& action) {
    const auto options = std::make_shared<OmissionOptions>();
    CLI::App* command = study.add_subcommand("omission", "Bins and time with and without each omission of the plan");
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file whose sonar and scene are studied")->required();
    command->add_option("--out", options->out, "folder of omission.md and omission.json");
    command->add_option("--ping", options->ping, "which ping of the deployment")->check(CLI::PositiveNumber);
    command->add_option("--pings", options->pings, "pings timed for each")->check(CLI::Range(1, 1000));
    command->add_flag("--quiet", options->quiet, "no progress");
    command->callback([options, &action] { action = [options] { return runStudy(*options); }; });
}

}  // namespace insonify::study
