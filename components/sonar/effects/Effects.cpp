#include "components/sonar/effects/Effects.hpp"

#include "components/sonar/EchoRules.hpp"

namespace insonify::sonar {

// Each stands in the file of its name.
const Effect& absorption();
const Effect& backscatter();
const Effect& publishedMeans();
const Effect& beamPatterns();
const Effect& pulse();
const Effect& ringDown();
const Effect& volume();
const Effect& speckle();
const Effect& multipath();
const Effect& slabs();
const Effect& refraction();
const Effect& motionInPing();
const Effect& normalMaps();
const Effect& pointTargets();

namespace {

struct List {
    std::vector<std::unique_ptr<const Effect>> added;
    std::vector<const Effect*> all{&absorption(), &backscatter(), &publishedMeans(), &beamPatterns(),  &pulse(),
                                   &ringDown(),   &volume(),      &speckle(),        &multipath(),    &slabs(),
                                   &refraction(), &motionInPing(), &normalMaps(),    &pointTargets()};
};

List& list() {
    static List list;
    return list;
}

}  // namespace

std::span<const Effect* const> effects() { return list().all; }

void addEffect(std::unique_ptr<const Effect> effect) {
    list().all.push_back(effect.get());
    list().added.push_back(std::move(effect));
}

PingEffects::PingEffects(const RenderPlan& plan, const types::Geometry& geometry) {
    for (const Effect* effect : plan.effects)
        if (auto made = effect->make(plan, geometry)) all_.push_back(std::move(made));
}

void PingEffects::takeQuality() {
    for (const auto& effect : all_) effect->takeQuality();
}

void PingEffects::takeScene(const types::Geometry& geometry) {
    for (const auto& effect : all_) effect->takeScene(geometry);
}

void PingEffects::begin(const types::Snapshot& snapshot) {
    for (const auto& effect : all_) effect->begin(snapshot);
}

void PingEffects::giveRules(EchoRules& rules) const {
    for (const auto& effect : all_) {
        effect->giveRules(rules);
        if (effect->hasSums()) rules.own.push_back(effect.get());
    }
}

bool PingEffects::areOnDevice() const {
    size_t with_sums = 0;
    for (const auto& effect : all_) {
        if (!effect->hasSums()) continue;
        if (!effect->isOnDevice() || ++with_sums > 1) return false;
    }
    return true;
}

void PingEffects::addEchoes(PingInMaking& ping) {
    for (const auto& effect : all_) effect->addEchoes(ping);
}

void PingEffects::addToBins(types::Sonar& ping) {
    for (const auto& effect : all_) effect->addToBins(ping);
}

size_t PingEffects::heard() const {
    size_t heard = 0;
    for (const auto& effect : all_) heard += effect->heard();
    return heard;
}

std::vector<LeftOut> PingEffects::leftOut() const {
    std::vector<LeftOut> all;
    for (const auto& effect : all_)
        if (const auto what = effect->leftOut()) all.push_back(*what);
    return all;
}

void addOwnSums(const EchoRules& rules, const uint64_t* sums, size_t cell, double unit, std::span<float> bins) {
    for (size_t i = 0; i < rules.own.size(); ++i) rules.own[i]->addToCell(sums + rules.ownOffset(i), cell, unit, bins);
}

}  // namespace insonify::sonar
