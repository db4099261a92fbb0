#include "components/sonar/bins/TruthGrid.hpp"

#include <algorithm>
#include <atomic>
#include <numbers>

#include "components/sonar/plan/Effects.hpp"

namespace insonify::sonar {
namespace {

constexpr double whole_turn = 2 * std::numbers::pi;

/** Returns the azimuth, or the azimuth plus or minus a whole turn where only that is between two others [rad]. */
double turnedBetween(double low, double high, double azimuth) {
    if (azimuth < low && azimuth + whole_turn < high) return azimuth + whole_turn;
    return azimuth >= high && azimuth - whole_turn >= low ? azimuth - whole_turn : azimuth;
}

}  // namespace

std::vector<int32_t> beamsOfCells(const RenderPlan& plan) {
    if (!plan.has(Pass::Beamform)) return {};
    const std::vector<double> edges = plan.beams.halfways();
    std::vector<int32_t> beams;
    for (const Beam& cell : plan.cells) {
        const auto above = std::ranges::upper_bound(edges, turnedBetween(edges.front(), edges.back(), cell.centre));
        const bool outside = above == edges.begin() || above == edges.end();
        beams.push_back(outside ? -1 : static_cast<int32_t>(above - edges.begin()) - 1);
    }
    return beams;
}

WaterTruth::WaterTruth(const RenderPlan& plan, size_t sum_count, int threads)
    : beams_of_cells_(beamsOfCells(plan)),
      bin_count_(static_cast<size_t>(plan.grid.bin_count)),
      per_bin_(sum_count / bin_count_),
      levels_(plan.config, plan.grid),
      energies_(plan.beams.size() * bin_count_),
      intensities_(static_cast<size_t>(threads), std::vector<float>(sum_count)) {}

void WaterTruth::begin() { std::ranges::fill(energies_, uint64_t{0}); }

void WaterTruth::take(const EchoRules& rules, const uint64_t* sums, size_t cell, double solid_angle, size_t thread) {
    constexpr double maximum = 0x1p54;  // limit of a cell, so that a beam's sum does not overflow
    const int32_t beam = beams_of_cells_.empty() ? static_cast<int32_t>(cell) : beams_of_cells_[cell];
    if (beam < 0) return;
    std::vector<float>& intensities = intensities_[thread];
    std::ranges::fill(intensities, 0.0f);
    addOwnSums(rules, sums, cell, solid_angle, intensities);
    const double quanta = quanta_per_unit * rules.strength_scale / solid_angle;
    for (size_t bin = 0; bin < bin_count_; ++bin) {
        double intensity = 0;
        for (size_t i = bin * per_bin_; i < (bin + 1) * per_bin_; ++i) intensity += double{intensities[i]};
        if (!(intensity > 0)) continue;
        const double energy = std::clamp(intensity / levels_.factor(bin) * quanta, 1.0, maximum);
        std::atomic_ref(energies_[static_cast<size_t>(beam) * bin_count_ + bin])
            .fetch_add(static_cast<uint64_t>(energy + 0.5), std::memory_order_relaxed);
    }
}

TruthGrid::TruthGrid(const RenderPlan& plan, const EchoRules& rules, bool whole, int threads)
    : beams_of_cells_(beamsOfCells(plan)), beam_count_(plan.beams.size()) {
    if (!rules.own.empty()) water_.emplace(plan, static_cast<size_t>(rules.bins.bin_count), threads);
    if (whole && beams_of_cells_.empty()) return;
    gathered_.emplace(beam_count_, static_cast<size_t>(plan.grid.bin_count));
    alone_.resize(beam_count_);
}

void TruthGrid::begin() {
    if (gathered_) gathered_->clear();
    if (water_) water_->begin();
}

void TruthGrid::take(size_t cell, const TruthTable& echoes, size_t of, types::SonarTruth& truth) {
    const int32_t row = beams_of_cells_.empty() ? static_cast<int32_t>(cell) : beams_of_cells_[cell];
    if (row < 0) return;
    const auto beam = static_cast<size_t>(row);
    if (!gathered_) return echoes.report(of, beam, truth, waterOf(beam));
    const std::lock_guard one_at_a_time(alone_[beam]);
    gathered_->merge(beam, echoes, of);
}

void TruthGrid::finish(types::SonarTruth& truth, ThreadPool& threads) const {
    if (!gathered_) return;
    threads.run([&](int part, int parts) {
        for (auto beam = static_cast<size_t>(part); beam < beam_count_; beam += static_cast<size_t>(parts))
            gathered_->report(beam, beam, truth, waterOf(beam));
    });
}

PathTruth::PathTruth(const RenderPlan& plan, size_t bin_count)
    : beams_of_cells_(beamsOfCells(plan)),
      sum_count_(bin_count),
      bin_count_(static_cast<size_t>(plan.grid.bin_count)),
      shown_(plan.beams.size(), bin_count_),
      alone_(plan.beams.size()) {
    for (std::vector<uint64_t>& sums : sums_) sums.resize(plan.cells.size() * sum_count_);
    for (std::vector<double>& energies : energies_) energies.resize(plan.beams.size() * bin_count_);
}

void PathTruth::begin() {
    for (std::vector<uint64_t>& sums : sums_) std::ranges::fill(sums, 0);
    for (std::vector<double>& energies : energies_) std::ranges::fill(energies, 0.0);
    shown_.clear();
}

void PathTruth::show(size_t cell, size_t bin, const ObjectEcho& echo) {
    const int32_t beam = beams_of_cells_.empty() ? static_cast<int32_t>(cell) : beams_of_cells_[cell];
    if (beam < 0 || echo.energy == 0) return;
    const std::lock_guard one_at_a_time(alone_[static_cast<size_t>(beam)]);
    shown_.add(static_cast<size_t>(beam), bin / (sum_count_ / bin_count_), echo);
}

void PathTruth::take(size_t cell, std::span<const float> direct, const BinLevels& levels, double quantum) {
    const int32_t beam = beams_of_cells_.empty() ? static_cast<int32_t>(cell) : beams_of_cells_[cell];
    if (beam < 0) return;
    const size_t first = static_cast<size_t>(beam) * bin_count_, per_bin = sum_count_ / bin_count_;
    knows_direct_ = !direct.empty();
    for (size_t j = 0; j < direct.size(); ++j) energies_[0][first + j] += double{direct[j]};
    for (size_t path = 0; path < sums_.size(); ++path)
        for (size_t j = 0; j < sum_count_; ++j) {
            const uint64_t sum = sums_[path][cell * sum_count_ + j];
            if (sum > 0)
                energies_[path + 1][first + j / per_bin] +=
                    double{levels.intensity(j, static_cast<double>(sum) * quantum)};
        }
}

uint8_t PathTruth::loudest(const types::SonarTruth& truth, size_t at, double water) const {
    const bool of_surface = truth.hits[at] > 0 && truth.path[at] != types::SonarTruth::water;
    if (!knows_direct_ && of_surface) return 0;
    double energy = std::max(energies_[0][at] - water, water);
    uint8_t loudest = 0;
    for (uint8_t path = 1; path < energies_.size(); ++path)
        if (energies_[path][at] > energy) loudest = path, energy = energies_[path][at];
    return loudest;
}

void PathTruth::completeBin(types::SonarTruth& truth, size_t at, double water) const {
    const bool is_shown = truth.isByMirror(at) && shown_truth_.object[at] >= 0;
    const bool of_water = truth.object[at] < 0 && truth.share[at] > 0;
    const double direct = knows_direct_ ? energies_[0][at] : of_water ? water / double{truth.share[at]} : 0;
    const double ways = energyOfWays(at), all = ways + direct;
    if (!is_shown) {
        if (direct > 0) truth.share[at] = static_cast<float>(double{truth.share[at]} * direct / all);
        return;
    }
    truth.object[at] = shown_truth_.object[at];
    truth.share[at] = static_cast<float>(double{shown_truth_.share[at]} * ways / all);
    truth.elevation[at] = shown_truth_.elevation[at];
    truth.grazing[at] = shown_truth_.grazing[at];
    truth.hits[at] += shown_truth_.hits[at];
}

void PathTruth::report(types::SonarTruth& truth, const WaterTruth* water, double quantum) {
    types::SonarTruth::forEachArray(shown_truth_,
                                    [&](const char*, auto& numbers, auto) { numbers.resize(truth.object.size()); });
    for (size_t beam = 0; beam < truth.beam_count; ++beam) {
        shown_.report(beam, beam, shown_truth_);
        bool echo_beyond = false;
        for (size_t j = bin_count_; j-- > 0;) {
            const size_t at = beam * bin_count_ + j;
            const double of_water = water ? water->intensity(beam, j, quantum) : 0;
            const uint8_t loudest = this->loudest(truth, at, of_water);
            const bool received = truth.hits[at] > 0 || energyOfWays(at) > 0;
            if (loudest > 0) truth.path[at] = loudest;
            truth.shadow[at] = echo_beyond && !received;
            echo_beyond = echo_beyond || received;
            completeBin(truth, at, of_water);
        }
    }
}

}  // namespace insonify::sonar
