#include "components/acoustics/Backscatter.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/acoustics/Seabed.hpp"
#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string noMaterial(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "no material has one"; }
std::string noLobe(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no material has a reflection and a roughness_slope";
}
std::string noMatter(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "no material names its matter alone"; }
std::string noFrequencyOfMatter(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no frequency_khz; matter follows Lambert's law by its lambert_db";
}
std::string noFrequency(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no frequency_khz; sediments follow Lambert's law by their lambert_db";
}

constexpr double highest_of_law_khz = 100;       // TR 9407
constexpr double highest_of_imaging_khz = 3000;  // an ARIS 3000

std::string aboveLaw(const Omitted& what, const BinGrid& /*grid*/) {
    return fmt::format(
        "no law was measured at {:g} kHz; that of TR 9407, for 10 to {:g} kHz, is extrapolated: levels of the floor "
        "are "
        "then a guess",
        what.value, what.bound);
}

/** Whether nothing but the frequency is outside of the seabeds' law, and that because the sonar is an imaging sonar:
 *  there is nothing better, so this is an omission, and no mistake to warn of. */
bool isAboveLaw(const RenderPlan& plan) {
    const double khz = plan.config.frequency_khz.value_or(0);
    return plan.laws.has_seabeds && khz > highest_of_law_khz && khz <= highest_of_imaging_khz &&
           acoustics::outsideSeabedModel(highest_of_law_khz, plan.config.speedOfSound()).empty();
}

/** Names in quotes, at most five of them. */
std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (size_t i = 0; i < names.size() && i < 5; ++i) text += fmt::format("{}'{}'", i ? ", " : "", names[i]);
    return names.size() > 5 ? text + ", ..." : text;
}

/** Backscatter of materials that do not follow Lambert's law: lobes, seabeds, tables (ACOUSTICS.md 3). */
class Backscatter final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        const MaterialLaws& laws = plan.laws;
        if (!laws.tables.empty() || laws.hasLobes()) plan.features.add(Feature::BackscatterLaws);
        if (plan.config.model != Model::Physical) return plan.features.has(Feature::BackscatterLaws);
        const auto omitUnless = [&](bool has, const char* effect, Omitted::Words words) {
            if (!has) plan.omitted.push_back({.effect = effect, .reason = Reason::NoneInScene, .words = words});
        };
        omitUnless(laws.hasLobes(), "specular lobe", noLobe);
        omitUnless(laws.has_seabeds, "seabeds by TR 9407", laws.lacks_frequency ? noFrequency : noMaterial);
        if (isAboveLaw(plan))
            plan.omitted.push_back({.effect = "measured levels of seabeds",
                                    .reason = Reason::Approximated,
                                    .value = *plan.config.frequency_khz,
                                    .bound = highest_of_law_khz,
                                    .words = aboveLaw});
        const bool names_matter =
            std::ranges::any_of(geometry.materials, [](const auto& material) { return !material.matter.empty(); });
        omitUnless(laws.has_matter, "rough solids", names_matter ? noFrequencyOfMatter : noMatter);
        omitUnless(laws.has_measured, "measured backscatter", noMaterial);
        return plan.features.has(Feature::BackscatterLaws);
    }
    void note(const RenderPlan& plan, const types::Geometry& geometry, types::Notices& notices) const override {
        if (plan.config.model != Model::Physical) return;
        const auto max_law = static_cast<float>(1.0001 * acoustics::lambertSection(acoustics::max_lambert_db, 1));
        std::vector<std::string> plain, loud;
        for (size_t i = 0; i < geometry.materials.size(); ++i) {
            const types::Material& material = geometry.materials[i];
            if (!material.has_acoustics) plain.push_back(material.name);
            const MaterialRecord& record = plan.laws.records[i];
            const float of_map = material.max_map_strength > 0 ? material.max_map_strength : 1;
            if (record.law.x < 0 && record.values.x * of_map > max_law) loud.push_back(material.name);
        }
        if (!plain.empty())
            notices.push_back(
                fmt::format("{} of {} materials have no acoustic values and are medium sand, -16.7 dB: {}",
                            plain.size(), geometry.materials.size(), listed(plain)));
        if (!loud.empty())
            notices.push_back(types::warning(
                fmt::format("a lambert_db above {} dB, with its map, returns more energy than it receives: {}",
                            acoustics::max_lambert_db, listed(loud))));
        if (!plan.laws.outside_validity.empty() && !isAboveLaw(plan))
            notices.push_back(types::warning(fmt::format(
                "backscatter of seabeds is extrapolated outside its law's validity: {}", plan.laws.outside_validity)));
    }
};

}  // namespace

const Effect& backscatter() { return only<Backscatter>(); }

}  // namespace insonify::sonar
