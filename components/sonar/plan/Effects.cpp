#include "components/sonar/plan/Effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "components/sonar/plan/EchoRules.hpp"
#include "types/Check.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::sonar {

// Defined in the folder effects.
const Effect& absorption();
const Effect& backscatter();
const Effect& publishedMeans();
const Effect& beamPatterns();
const Effect& pulse();
const Effect& ringDown();
const Effect& volume();
const Effect& speckle();
const Effect& multipath();
const Effect& thinWalls();
const Effect& furtherFrusta();
const Effect& refraction();
const Effect& motionInPing();
const Effect& normalMaps();
const Effect& surfaceMaps();
const Effect& deformingMeshes();
const Effect& pointTargets();
const Effect& edgeDiffraction();
const Effect& imperfections();
const Effect& crosstalk();
const Effect& truth();

namespace {

/** All effects. Libraries add some while sonars of other threads use the list: an effect never moves, and counts once
 *  it is in its place. */
class List {
public:
    std::span<const Effect* const> all() const { return {all_.data(), count_.load(std::memory_order_acquire)}; }
    void add(std::unique_ptr<const Effect> effect) {
        const std::lock_guard alone(mutex_);
        const auto same = [&](const Effect* other) { return !effect->key().empty() && other->key() == effect->key(); };
        if (std::ranges::any_of(all(), same)) return;
        if (count_ == all_.size()) throw std::length_error(fmt::format("there are more than {} effects", all_.size()));
        all_[count_] = effect.get();
        added_.push_back(std::move(effect));
        count_.store(count_ + 1, std::memory_order_release);
    }

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<const Effect>> added_;
    std::array<const Effect*, 256> all_{
        &absorption(),    &backscatter(), &publishedMeans(), &beamPatterns(),    &pulse(),         &ringDown(),
        &volume(),        &speckle(),     &multipath(),      &thinWalls(),       &furtherFrusta(), &refraction(),
        &motionInPing(),  &normalMaps(),  &surfaceMaps(),    &deformingMeshes(), &pointTargets(),  &edgeDiffraction(),
        &imperfections(), &crosstalk(),   &truth()};
    std::atomic<size_t> count_{static_cast<size_t>(std::ranges::find(all_, nullptr) - all_.begin())};
};

List& list() {
    static List list;
    return list;
}

std::vector<std::string> keys() {
    std::vector<std::string> keys;
    for (const Effect* effect : effects())
        if (!effect->key().empty()) keys.push_back(effect->key());
    return keys;
}

std::string whyUnknown(const std::string& name, const std::vector<std::string>& known, const char* is,
                       const char* they) {
    if (known.empty()) return fmt::format("{}: no library has added any", is);
    return fmt::format("{}; {}{} are: {}", is, types::didYouMean(name, known), they, fmt::join(known, ", "));
}

void checkNumbers(const std::string& path, const std::vector<types::Field>& fields,
                  const std::map<std::string, double>& numbers, types::Diagnostics& diagnostics) {
    std::vector<std::string> names;
    for (const types::Field& field : fields) names.emplace_back(field.name);
    for (const auto& [name, value] : numbers) {
        const auto field = std::ranges::find(fields, name, &types::Field::name);
        if (field == fields.end())
            diagnostics.push_back({path + name, whyUnknown(name, names, "is no number of this effect", "they")});
        else if (!(value >= field->min && value <= field->max))
            diagnostics.push_back(
                {path + name,
                 fmt::format("is {:g}; must be {:g} to {:g}{}", value, field->min, field->max,
                             std::string_view(field->unit) == "1" ? "" : fmt::format(" {}", field->unit))});
    }
}

}  // namespace

std::span<const Effect* const> effects() { return list().all(); }

void addEffect(std::unique_ptr<const Effect> effect) { list().add(std::move(effect)); }

void failIn(const Effect& effect) {
    std::string why;
    try {
        throw;
    } catch (const types::CheckFailure&) {  // names its place
        throw;
    } catch (const std::exception& failure) {
        if (effect.key().empty()) throw;
        why = types::getReason(failure);
    } catch (...) {
        why = "an exception without a reason";
    }
    throw std::runtime_error(fmt::format("effects.{}: {}", effect.key(), why));
}

void checkEffects(const SonarConfig& config, types::Diagnostics& diagnostics) {
    for (const auto& [key, numbers] : config.effects) {
        const auto all = effects();
        const auto found = std::ranges::find(all, key, &Effect::key);
        if (found == all.end())
            diagnostics.push_back({"effects." + key, whyUnknown(key, keys(), "is no effect", "effects")});
        else
            checkNumbers("effects." + key + ".", (*found)->numbers(), numbers, diagnostics);
    }
    for (const Effect* effect : effects()) calling(*effect, [&] { effect->check(config, diagnostics); });
}

void PingInMaking::report(size_t bin, bool passes_walls) const {
    INSONIFY_CHECK(bin < ping.bins.size(), bin, ping.bins.size());
    if (!truth || truth->object[bin] != types::SonarTruth::no_object) return;
    truth->path[bin] = passes_walls ? types::SonarTruth::through_wall : uint8_t{0};
    truth->share[bin] = 0;
}

void checkPlaces(const char* path, const std::vector<uint32_t>& list, size_t count, const char* things,
                 types::Diagnostics& diagnostics) {
    for (size_t i = 0; i < list.size(); ++i)
        if (list[i] >= count)
            diagnostics.push_back({fmt::format("{}[{}]", path, i),
                                   fmt::format("is {}; there are {} {}, 0 to {}", list[i], count, things, count - 1)});
}

PingEffects::PingEffects(const RenderPlan& plan, const types::Geometry& geometry) : selection_(plan.options.selection) {
    for (const Effect* effect : plan.effects)
        calling(*effect, [&] {
            if (auto made = effect->make(plan, geometry)) {
                all_.push_back(std::move(made));
                kinds_.push_back(effect);
            }
        });
}

void PingEffects::updateQuality() {
    for (const auto& effect : all_) effect->updateQuality();
}

void PingEffects::setScene(const types::Geometry& geometry) {
    for (const auto& effect : all_) effect->setScene(geometry);
}

void PingEffects::updateShapes(const types::Snapshot& snapshot) {
    for (const auto& effect : all_) effect->updateShapes(snapshot);
}

void PingEffects::begin(const PingStart& start) {
    for (size_t i = 0; selection_ && i < all_.size(); ++i) all_[i]->is_silent = !selection_->adds(*kinds_[i]);
    for (size_t i = 0; i < all_.size(); ++i) calling(*kinds_[i], [&] { all_[i]->begin(start); });
}

void PingEffects::giveRules(EchoRules& rules) const {
    for (size_t i = 0; i < all_.size(); ++i)
        calling(*kinds_[i], [&] {
            all_[i]->giveRules(rules);
            if (all_[i]->hasSums()) rules.own.push_back(all_[i].get());
        });
}

std::string PingEffects::whyNotOnDevice() const {
    size_t with_sums = 0;
    for (size_t i = 0; i < all_.size(); ++i) {
        if (!all_[i]->hasSums()) continue;
        if (!all_[i]->isOnDevice())
            return fmt::format("the compute shader does not sum what the effect '{}' sums", kinds_[i]->key());
        if (++with_sums > 1) return "the compute shader has sums for one effect, and this sonar has several";
    }
    return {};
}

bool PingEffects::followsRays() const { return std::ranges::any_of(all_, &PingEffect::followsRays); }

void PingEffects::followRays(const TracedPing& ping, std::span<const TracedTile> tiles) {
    for (const auto& effect : all_)
        if (effect->followsRays()) effect->followRays(ping, tiles);
}

bool PingEffects::addEnergies(const TracedPing& ping, size_t cell, std::span<float> bins) {
    bool any = false;
    for (const auto& effect : all_)
        if (effect->followsRays()) any |= effect->addEnergies(ping, cell, bins);
    return any;
}

void PingEffects::addToTruth(const TracedPing& ping, types::SonarTruth& truth) {
    for (const auto& effect : all_)
        if (effect->followsRays()) effect->addToTruth(ping, truth);
}

void PingEffects::addEchoes(PingInMaking& ping) {
    for (size_t i = 0; i < all_.size(); ++i)
        if (!all_[i]->is_silent) calling(*kinds_[i], [&] { all_[i]->addEchoes(ping); });
}

void PingEffects::addToBins(types::Sonar& ping) {
    for (size_t i = 0; i < all_.size(); ++i)
        calling(*kinds_[i], [&] {
            all_[i]->addToBins(ping);
            if (kinds_[i]->key().empty()) return;
            const auto wrong =
                std::ranges::find_if_not(ping.bins, [](float bin) { return bin >= 0 && std::isfinite(bin); });
            if (wrong != ping.bins.end())
                throw std::runtime_error(fmt::format("leaves a bin of {}; must be finite and not negative", *wrong));
        });
}

void PingEffects::addAlike(types::Sonar& bins) {
    for (const auto& effect : all_) effect->addAlike(bins);
}

size_t PingEffects::received() const {
    size_t received = 0;
    for (const auto& effect : all_) received += effect->received();
    return received;
}

std::vector<Omitted> PingEffects::omissions() const {
    std::vector<Omitted> all;
    for (size_t i = 0; i < all_.size(); ++i)
        calling(*kinds_[i], [&] {
            if (const auto what = all_[i]->omissions()) all.push_back(*what);
        });
    return all;
}

void addOwnSums(const EchoRules& rules, const uint64_t* sums, size_t cell, double unit, std::span<float> bins) {
    for (size_t i = 0; i < rules.own.size(); ++i)
        if (!rules.own[i]->is_silent) rules.own[i]->addToCell(sums + rules.ownOffset(i), cell, unit, bins);
}

}  // namespace insonify::sonar
