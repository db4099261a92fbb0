#include "components/sonar/renderer/BinExplanation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <stdexcept>

#include "components/sonar/bins/EchoGrid.hpp"
#include "components/sonar/bins/Truth.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr double negligible = 1e-3;  ///< Share of the bin below which parts are not told apart [1].
constexpr double rounding = 1e-6;    ///< Share of the bin that is a rounding error of two pings [1].
constexpr size_t shown_triangles = 5;

using Kind = std::pair<uint32_t, uint8_t>;  ///< Object, and path as in types::SonarTruth.

/** Whose echoes a ping receives. */
struct Item {
    std::optional<Kind> kind;
    const Effect* effect = nullptr;
};

/** What the ping of all echoes recorded of an object and a path. */
struct KindRecord {
    double in_bin = 0;                     ///< Energy in the bin, weighted by the beam [quanta].
    double grazing = 0, elevation = 0;     ///< Sines in the bin, weighted by energy.
    std::map<uint32_t, double> triangles;  ///< Energy in the bin [quanta].
    double loudest = 0;                    ///< Weighted energy of the strongest echo in the bin, else in any [quanta].
    uint32_t loudest_cell = 0, loudest_bin = 0;

    void add(const EchoPart& echo, double weight, bool is_in_bin) {
        const double energy = static_cast<double>(echo.energy) * weight;
        const bool is_first_in_bin = is_in_bin && in_bin == 0 && energy > 0;
        if (is_first_in_bin || (energy > loudest && is_in_bin == (in_bin > 0)))
            loudest = energy, loudest_cell = echo.cell, loudest_bin = echo.bin;
        if (!is_in_bin) return;
        in_bin += energy;
        grazing += energy * echo.grazing;
        elevation += energy * echo.elevation;
        if (echo.triangle != EchoPart::no_triangle) triangles[echo.triangle] += energy;
    }
};

/** Receives all echoes and records them; later only those of some items. */
class Selection final : public EchoSelection {
public:
    bool keeps(const EchoPart& echo) override {
        if (on_echo) on_echo(echo);
        return on_echo || kinds_.contains(Kind(echo.object, echo.path));
    }
    bool adds(const Effect& effect) override { return on_echo || effects_.contains(&effect); }
    void choose(std::span<const Item> items) {
        kinds_.clear();
        effects_.clear();
        for (const Item& item : items)
            if (item.kind)
                kinds_.insert(*item.kind);
            else
                effects_.insert(item.effect);
    }

    std::function<void(const EchoPart&)> on_echo;  ///< Called for all echoes of a ping that receives all; or null.

private:
    std::set<Kind> kinds_;
    std::set<const Effect*> effects_;
};

const char* pathText(uint8_t path) {
    static constexpr const char* texts[] = {"direct",
                                            "one way by the water surface",
                                            "both ways by the water surface",
                                            "by a mirror",
                                            "through a wall",
                                            "rung in a wall"};
    return texts[path];
}

std::string effectName(const Effect& effect, SonarConfig config) {
    if (const std::string name = effect.removeFrom(config); !name.empty()) return name;
    return effect.key().empty() ? "point targets" : effect.key();
}

/** Fills what the laws say of an echo: its material, law and strength. */
void addLaw(const RenderPlan& plan, const types::Geometry& scene, uint32_t object, SurfaceEcho& echo) {
    const types::Mesh& mesh = scene.meshes[static_cast<size_t>(scene.objects[object].mesh)];
    const uint32_t index = echo.triangles.empty() ? 0 : 3 * echo.triangles.front().first;
    const auto found = std::ranges::find_if(mesh.clusters, [&](const types::Cluster& cluster) {
        return index >= cluster.first_index && index - cluster.first_index < cluster.index_count;
    });
    const auto number =
        static_cast<size_t>(found == mesh.clusters.end() ? mesh.clusters.front().material : found->material);
    const types::Material& material = scene.materials[number];
    echo.material = material.name;
    if (plan.config.model != Model::Physical) {
        echo.law = fmt::format("reflectivity {:.3g}", material.reflectivity);
        return;
    }
    if (plan.laws.records[number].law.x < 0)  // no table
        echo.law = fmt::format("Lambert's law, {:.1f} dB", material.lambert_db);
    else if (!material.measured.empty())
        echo.law = fmt::format("measured table of {} angles", material.measured.size());
    else
        echo.law = material.seabed.empty() ? "rough solid " + material.matter : "APL-UW TR 9407, " + material.seabed;
    const double sine = std::sin(echo.grazing);
    if (plan.laws.hasLobe(number))
        echo.law += fmt::format(", and a lobe: reflection {:.3g}, roughness slope {:.3g}", material.reflection,
                                material.roughness_slope.value_or(0));
    else if (sine > 0)
        echo.strength_db = 10 * std::log10(plan.laws.overCosine(number, sine) * sine);
}

class Explainer {
public:
    Explainer(SonarConfig config, const types::Snapshot& scene, std::optional<size_t> beam, size_t bin)
        : scene_(scene), beam_(beam), bin_(bin) {
        explained_.is_mean = config.isCoherent();
        if (config.isCoherent()) config.speckle.reset(), config.elements.reset();
        if (!config.tracesRays()) config.deposit = Deposit::Cpu;
        RenderOptions options;
        options.threads = 1;
        options.selection = &selection_;
        renderer_ = std::make_unique<SonarRenderer>(config, scene.geometry, options);
        renderer_->setTruth(ping_, &truth_);
        const BinGrid& grid = plan().grid;
        if (bin >= static_cast<size_t>(grid.bin_count) || (beam && *beam >= plan().beams.size()))
            throw std::out_of_range("the sonar has no such beam or bin");
        explained_.near_edge = grid.edge(static_cast<int>(bin));
        explained_.far_edge = grid.edge(static_cast<int>(bin) + 1);
        findCells();
    }

    BinExplanation explain() {
        selection_.on_echo = [this](const EchoPart& echo) { record(echo); };
        explained_.intensity = render();
        selection_.on_echo = [](const EchoPart&) {};  // all echoes, once more
        explained_.depends_on_past = isMore(render() - explained_.intensity);
        selection_.on_echo = nullptr;
        if (explained_.depends_on_past) return std::move(explained_);
        std::vector<Item> effects, surfaces;
        for (const Effect* effect : plan().effects) effects.push_back({{}, effect});
        for (const auto& [kind, record] : records_) surfaces.push_back({kind, nullptr});
        std::ranges::stable_sort(surfaces, std::greater(), [this](const Item& item) {
            const KindRecord& record = records_.at(*item.kind);
            return std::pair(record.in_bin, record.loudest);
        });
        selection_.choose({});
        rest_ = render();
        split(effects);
        split(surfaces);
        std::ranges::stable_sort(explained_.parts, std::greater(), &BinPart::intensity);
        if (weak_ != 0)
            explained_.parts.push_back({weak_count_ == 1
                                            ? "one weaker object, path or effect"
                                            : fmt::format("{} weaker objects, paths or effects", weak_count_),
                                        weak_,
                                        {}});
        if (isMore(rest_)) explained_.parts.push_back({"what effects do to all bins", rest_, {}});
        const bool any = std::ranges::any_of(
            explained_.parts, [](const BinPart& part) { return part.of_surface && part.of_surface->is_in_beam; });
        if (!any) explained_.why_no_surface = whyNoSurface();
        return std::move(explained_);
    }

private:
    const RenderPlan& plan() const { return renderer_->renderPlan(); }
    /** Finds which azimuth cells the beam shows, and the weight that it gives to each. */
    void findCells() {
        const size_t cells = plan().cells.size();
        weights_.assign(cells, beam_ ? 0 : 1);
        shown_.assign(cells, !beam_);
        if (!beam_) return;
        for (size_t k = 0; k < plan().beams.size(); ++k)
            if (plan().beams.row(k) == *beam_) sorted_beam_ = k;
        const std::vector<int32_t> beams_of_cells = beamsOfCells(plan());
        if (!beams_of_cells.empty()) weights_ = beamformer(plan()).weights(sorted_beam_);
        // Beams may be wider than their spacing: the beam shows the cells of its main lobe.
        const double main_lobe = 0.1 * *std::ranges::max_element(weights_);
        for (size_t cell = 0; cell < cells; ++cell)
            shown_[cell] = beams_of_cells.empty() ? cell == sorted_beam_
                                                  : beams_of_cells[cell] == static_cast<int32_t>(sorted_beam_) ||
                                                        weights_[cell] >= main_lobe;
        if (beams_of_cells.empty()) weights_[sorted_beam_] = 1;
    }
    void record(const EchoPart& echo) {
        records_[{echo.object, echo.path}].add(echo, weights_[echo.cell], echo.bin == bin_);
        if (!shown_[echo.cell]) return;
        if (echo.bin < bin_ && (!before_ || echo.bin >= before_->bin)) before_ = echo;
        if (echo.bin > bin_ && (!behind_ || echo.bin < behind_->bin)) behind_ = echo;
        in_beam_ |= echo.bin == bin_;
    }
    /** Renders the ping, and returns the bin; of the sum over all beams, in which the sonar rings once. */
    double render() {
        renderer_->render(scene_, ping_);
        if (beam_) return double{ping_.bins[*beam_ * ping_.bin_count + bin_]};
        double sum = 0, ringing = 0;
        for (size_t i = bin_; i < ping_.bins.size(); i += ping_.bin_count) sum += double{ping_.bins[i]};
        if (ping_.beam_count < 2 || !renderer_->computeAlike(ping_, alike_)) return sum;
        for (size_t i = bin_; i < alike_.bins.size(); i += ping_.bin_count) ringing += double{alike_.bins[i]};
        return std::max(0.0, sum - (1 - 1.0 / ping_.beam_count) * ringing);
    }
    bool isMore(double more) const { return std::abs(more) > rounding * explained_.intensity; }
    /** Adds the parts of some items. */
    void split(std::span<const Item> items) {
        if (items.empty()) return;
        selection_.choose(items);
        const double more = render() - rest_;
        if (!isMore(more)) return;
        if (std::abs(more) < negligible * explained_.intensity) {
            weak_ += more;
            weak_count_ += items.size();
        } else if (items.size() > 1) {
            split(items.first(items.size() / 2));
            split(items.subspan(items.size() / 2));
        } else if (items[0].effect) {
            explained_.parts.push_back({effectName(*items[0].effect, plan().config), more, {}});
        } else {
            addSurface(*items[0].kind, more);
        }
    }
    void addSurface(const Kind& kind, double intensity) {
        const KindRecord& record = records_.at(kind);
        SurfaceEcho echo;
        echo.path = pathText(kind.second);
        if (record.in_bin > 0) {
            echo.grazing = std::asin(std::min(record.grazing / record.in_bin, 1.0));
            if (beam_) echo.elevation = std::asin(std::clamp(record.elevation / record.in_bin, -1.0, 1.0));
            for (const auto& [triangle, energy] : record.triangles)
                echo.triangles.emplace_back(triangle, energy / record.in_bin);
            std::ranges::stable_sort(echo.triangles, std::greater(), &std::pair<uint32_t, double>::second);
        }
        echo.is_in_beam = record.in_bin > 0 && shown_[record.loudest_cell];
        if (beam_ && record.loudest > 0) {
            echo.bearing = types::Angle::fromRad(plan().cells[record.loudest_cell].centre).rad;
            echo.range = plan().grid.centre(static_cast<int>(record.loudest_bin));
        }
        addLaw(plan(), *scene_.geometry, kind.first, echo);
        explained_.parts.push_back({scene_.geometry->objects[kind.first].name, intensity, std::move(echo)});
    }
    std::string whyNoSurface() const {
        const BinGrid& grid = plan().grid;
        const auto& imperfections = plan().config.imperfections;
        if (imperfections && beam_ && imperfections->beamFactors(plan().beams.size())[*beam_] == 0)
            return "the beam is dead";
        if (explained_.far_edge <= grid.range_min)
            return fmt::format("it is nearer than range_min, {:.3f} m", grid.range_min);
        if (explained_.near_edge >= grid.range_max)
            return fmt::format("it is beyond the range, {:.3f} m", grid.range_max);
        const auto place = [&](const EchoPart& echo) {
            return fmt::format("{} at {:.2f} m", scene_.geometry->objects[echo.object].name,
                               grid.centre(static_cast<int>(echo.bin)));
        };
        if (in_beam_ &&
            std::ranges::any_of(explained_.parts, [](const BinPart& part) { return part.of_surface.has_value(); }))
            return "echoes of surfaces in the beam are weaker than those from elsewhere";
        if (in_beam_) return "echoes of surfaces are there, too weak for a number in single precision";
        if (!before_ && !behind_) return "no surface in the beam has an echo within the range";
        if (!before_) return "it is before the first surface of the beam, " + place(*behind_);
        if (!behind_)
            return "it is behind the last echo of the beam, " + place(*before_) + ": in its shadow, or in open water";
        return fmt::format("it is between the echoes of {} and of {}: in a shadow, or in open water", place(*before_),
                           place(*behind_));
    }

    const types::Snapshot& scene_;
    std::optional<size_t> beam_;
    size_t bin_, sorted_beam_ = 0;  ///< The beam along the arc, as in Fan.
    BinExplanation explained_;
    Selection selection_;
    std::unique_ptr<SonarRenderer> renderer_;
    types::Sonar ping_, alike_;
    types::SonarTruth truth_;
    std::vector<double> weights_;  ///< Of each azimuth cell in the beam [1].
    std::vector<bool> shown_;      ///< Whether the beam shows the cell.
    std::map<Kind, KindRecord> records_;
    std::optional<EchoPart> before_, behind_;  ///< The nearest echoes of the beam before and behind the bin.
    bool in_beam_ = false;                     ///< Whether the beam has an echo in the bin.
    double rest_ = 0, weak_ = 0;               ///< Intensity without items, and of items that are not told apart.
    size_t weak_count_ = 0;
};

std::string surfaceText(const SurfaceEcho& echo) {
    std::string lines = fmt::format("            {}: {}", echo.material, echo.law);
    if (!echo.is_in_beam)
        lines += std::isnan(echo.grazing)
                     ? "\n            spread from other bins by the pulse, or from other beams by errors of the device"
                     : "\n            through a sidelobe";
    if (!echo.is_in_beam && !std::isnan(echo.bearing))
        lines +=
            fmt::format("; its strongest echo is at {:.2f} deg, {:.2f} m", types::degrees(echo.bearing), echo.range);
    if (std::isnan(echo.grazing)) return lines + "\n";
    lines += fmt::format("\n            grazing {:.1f} deg", types::degrees(echo.grazing));
    if (!std::isnan(echo.strength_db)) lines += fmt::format(", {:.1f} dB there", echo.strength_db);
    if (!std::isnan(echo.elevation)) lines += fmt::format(", elevation {:.1f} deg", types::degrees(echo.elevation));
    size_t count = 0;
    for (; count < std::min(echo.triangles.size(), shown_triangles) && echo.triangles[count].second > 5e-4; ++count)
        lines += fmt::format("{} {} ({:.1f} %)", count == 0 ? "; triangles" : ",", echo.triangles[count].first,
                             100 * echo.triangles[count].second);
    if (echo.triangles.size() > count) lines += fmt::format(" and {} more", echo.triangles.size() - count);
    return lines + "\n";
}

}  // namespace

BinExplanation explainBin(const SonarConfig& config, const types::Snapshot& scene, std::optional<size_t> beam,
                          size_t bin) {
    return Explainer(config, scene, beam, bin).explain();
}

std::string intensityText(double intensity) {
    return intensity > 0 ? fmt::format("{:.4g}, {:.2f} dB", intensity, 10 * std::log10(intensity)) : "no echo";
}

std::string text(const BinExplanation& explanation) {
    std::string lines;
    if (explanation.is_mean)
        lines += fmt::format("  its echoes interfere; these are the parts of their mean: {}\n",
                             intensityText(explanation.intensity));
    for (const BinPart& part : explanation.parts) {
        lines += fmt::format("  {:6.2f} %  {}{}\n", 100 * part.intensity / explanation.intensity, part.name,
                             part.of_surface ? ", " + part.of_surface->path : "");
        if (part.of_surface) lines += surfaceText(*part.of_surface);
    }
    if (explanation.depends_on_past)
        lines += "  an effect remembers earlier pings, so the parts of the bin are unknown\n";
    if (!explanation.why_no_surface.empty()) lines += "  no surface: " + explanation.why_no_surface + "\n";
    return lines;
}

}  // namespace insonify::sonar
