#include "components/sonar/bins/EchoGrid.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "components/sonar/plan/Effects.hpp"
#include "types/Check.hpp"

namespace insonify::sonar {

Beamformer::Rules boxRules(Beamformer::Pattern sent, const RenderPlan& plan, bool of_fields) {
    const double half = plan.directivity->boxWidth() / 2, floor = plan.directivity->floor();
    return {std::move(sent), half, of_fields ? std::sqrt(floor) : floor, of_fields, half};
}

Beamformer beamformer(const RenderPlan& plan) {
    const Directivity& directivity = *plan.directivity;
    const auto zoneRules = [&](size_t zone) {
        if (directivity.hasBoxes()) return boxRules([&](double a, double) { return directivity.sentAzimuth(a); }, plan);
        return Beamformer::Rules{
            [&, zone](double azimuth, double bearing) { return directivity.azimuth(azimuth, bearing, zone); },
            directivity.nearAzimuth(zone), directivity.floor()};
    };
    return {plan.beams, plan.cells, static_cast<size_t>(plan.grid.bin_count),
            rulesOfZones(plan, static_cast<size_t>(plan.grid.bin_count), zoneRules)};
}

Beamformer::Rules rulesOfZones(const RenderPlan& plan, size_t samples,
                               const std::function<Beamformer::Rules(size_t zone)>& zoneRules) {
    const Directivity& directivity = *plan.directivity;
    Beamformer::Rules rules = zoneRules(directivity.lastZone());
    const double width = plan.grid.bin_width * plan.grid.bin_count / static_cast<double>(samples);
    size_t from = 0;
    for (size_t zone = 0; zone < directivity.lastZone(); ++zone) {  // a sample is in the zone of its middle
        const double end = std::clamp(std::round(directivity.zoneEnd(zone) / width), 0.0, static_cast<double>(samples));
        if (static_cast<size_t>(end) <= from) continue;
        from = static_cast<size_t>(end);
        Beamformer::Rules own = zoneRules(zone);
        rules.nearer.push_back({from, std::move(own.pattern), own.near});
    }
    return rules;
}

EchoGrid::EchoGrid(const RenderPlan& plan, int threads)
    : Accumulator(plan), bin_count_(static_cast<size_t>(plan.grid.bin_count)), beam_count_(plan.beams.size()) {
    if (plan.has(Pass::Pulse))
        response_.emplace(acoustics::Pulse(*plan.config.pulse, plan.grid.speed_of_sound), plan.grid);
    if (response_)
        padded_.assign(static_cast<size_t>(threads), std::vector<float>(bin_count_ + 2 * response_->margin()));
    EchoGrid::setQuality(plan);
}

void EchoGrid::setQuality(const RenderPlan& plan) {
    if (plan.has(Pass::Beamform)) beamformer_ = beamformer(plan);
    if (!passes()) echoes_.resize(plan.cells.size() * bin_count_);
}

void EchoGrid::begin(const types::Snapshot& /*snapshot*/, types::Sonar& ping) {
    INSONIFY_CHECK(ping.bins.size() == beam_count_ * bin_count_, ping.bins.size(), beam_count_, bin_count_);
    bins_ = ping.bins.data();
}

bool EchoGrid::fill(size_t cell, const EchoRules& rules, const uint64_t* sums, double solid_angle, size_t thread) {
    const std::span<float> bins = energies(cell, thread);
    const bool received = levels().fill(rules, sums, solid_angle, bins);
    addOwnSums(rules, sums, cell, solid_angle, bins);
    return received;
}

void EchoGrid::finishBeam(size_t beam, std::span<float> padded) const {
    const std::span<float> bins(bins_ + beam * bin_count_, bin_count_);
    const std::span<float> formed = response_ ? padded.subspan(response_->margin(), bin_count_) : bins;
    if (beamformer_)
        beamformer_->form(beam, echoes_, formed);
    else
        std::copy_n(echoes_.data() + beam * bin_count_, bin_count_, formed.data());
    if (response_) response_->spread(padded, bins);
}

void EchoGrid::finish(ThreadPool& threads) {
    INSONIFY_CHECK(!response_ || padded_.size() >= static_cast<size_t>(threads.size()), padded_.size());
    if (passes()) return;
    const auto visitEach = [&](size_t count, const auto& work) {
        std::atomic<size_t> next = 0;
        threads.share([&](int part, int) {
            for (size_t i = next++; i < count; i = next++) work(i, static_cast<size_t>(part));
        });
    };
    if (beamformer_)
        visitEach(beamformer_->groupCount(), [&](size_t group, size_t) { beamformer_->sumGroup(group, echoes_); });
    visitEach(beam_count_, [&](size_t beam, size_t part) {
        finishBeam(beam, response_ ? std::span<float>(padded_[part]) : std::span<float>());
    });
}

}  // namespace insonify::sonar
