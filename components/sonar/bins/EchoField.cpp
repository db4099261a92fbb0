#include "components/sonar/bins/EchoField.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <iterator>
#include <limits>

#include "components/sonar/base/RandomFields.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/bins/EchoGrid.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "types/Check.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** fields[j] += weight * from[j]. */
INSONIFY_VECTOR_CLONES void addScaled(const float* from, float weight, float* __restrict fields, size_t count) {
    for (size_t j = 0; j < count; ++j) fields[j] += weight * from[j];
}

using Lanes [[gnu::vector_size(64), gnu::aligned(4), gnu::may_alias]] = float;

/** Fills a block: fields[j] is the sum over taps, four at a time, of weight * values[offset + j]. */
INSONIFY_VECTOR_CLONES void sumTaps(const float* values, const FieldResponse::Tap* taps, size_t count, float* fields) {
    constexpr size_t width = sizeof(Lanes) / sizeof(float);
    Lanes sums[FieldResponse::block / width] = {};
    for (const FieldResponse::Tap* tap = taps; tap < taps + count; tap += 4)
        for (size_t i = 0; i < std::size(sums); ++i) {
            const float* const at = values + width * i;
            sums[i] += (tap[0].weight * *reinterpret_cast<const Lanes*>(at + tap[0].offset) +
                        tap[1].weight * *reinterpret_cast<const Lanes*>(at + tap[1].offset)) +
                       (tap[2].weight * *reinterpret_cast<const Lanes*>(at + tap[2].offset) +
                        tap[3].weight * *reinterpret_cast<const Lanes*>(at + tap[3].offset));
        }
    std::memcpy(fields, sums, sizeof sums);
}

/** Computes the fields of every `stride`-th range cell from their sums. */
INSONIFY_VECTOR_CLONES void scaleSums(const uint64_t* sums, const double* amplitudes, size_t stride, double quantum,
                                      float* __restrict fields, size_t count) {
    for (size_t j = 0; j < count; ++j) {
        const double unit = amplitudes[stride * j] * quantum;
        const auto in_phase = static_cast<int64_t>(sums[2 * stride * j]),
                   quadrature = static_cast<int64_t>(sums[2 * stride * j + 1]);
        fields[2 * j] = static_cast<float>(static_cast<double>(in_phase) * unit);
        fields[2 * j + 1] = static_cast<float>(static_cast<double>(quadrature) * unit);
    }
}

/** Returns range cells without which all sums are 0, in blocks; empty where all are. */
std::pair<size_t, size_t> findEchoes(const uint64_t* sums, size_t cells) {
    constexpr size_t block = 32;
    const auto is_silent = [sums](size_t from, size_t to) {
        uint64_t any = 0;
        for (size_t i = 2 * from; i < 2 * to; ++i) any |= sums[i];
        return any == 0;
    };
    size_t first = 0, end = cells;
    while (first < end && is_silent(first, std::min(first + block, end))) first = std::min(first + block, end);
    while (first < end && is_silent(std::max(first + block, end) - block, end))
        end = std::max(first + block, end) - block;
    return {first, end};
}

INSONIFY_VECTOR_CLONES void square(const float* fields, float* __restrict intensities, size_t count) {
    for (size_t j = 0; j < count; ++j)
        intensities[j] = fields[2 * j] * fields[2 * j] + fields[2 * j + 1] * fields[2 * j + 1];
}

constexpr size_t together = 8;  ///< Neighbouring beams that are formed together [1].

Beamformer fieldBeamformer(const RenderPlan& plan, size_t numbers) {
    const Directivity& directivity = *plan.directivity;
    const bool each = plan.config.elements || directivity.isComplex();
    const auto zoneRules = [&](size_t zone) {
        if (directivity.hasBoxes())
            return boxRules([&](double azimuth, double) { return directivity.sentAmplitude(azimuth); }, plan, true);
        const auto pattern = [&directivity, zone](double azimuth, double bearing) {
            return directivity.azimuthField(azimuth, bearing, zone);
        };
        return Beamformer::Rules{pattern, each ? 2 * std::numbers::pi : directivity.nearAzimuth(),
                                 std::sqrt(directivity.floor()), true};
    };
    Beamformer::Rules rules = rulesOfZones(plan, numbers / 2, zoneRules);
    for (Beamformer::Zone& zone : rules.nearer) zone.end *= 2;  // real, imaginary
    rules.is_complex = directivity.isComplex();
    return {plan.beams, plan.cells, numbers, rules};
}

/** fields[j] += i quadrature[j], complex numbers. */
INSONIFY_VECTOR_CLONES void addQuadrature(const float* quadrature, float* __restrict fields, size_t count) {
    for (size_t j = 0; j < count; ++j) {
        fields[2 * j] -= quadrature[2 * j + 1];
        fields[2 * j + 1] += quadrature[2 * j];
    }
}

/** Range cells with equally fine scatterers of the water, and the places of a beam's cells in their cubes. */
struct Cubes {
    size_t first, last;       ///< Range cells.
    float start[3], step[3];  ///< Place of the first range cell, and step to the next [cubes].
    uint32_t base[3];         ///< Cube that places are relative to.
    uint32_t seed;            ///< Distinguishes fields in the same cubes.
};

/** Fills a complex Gaussian field of given intensities, which belongs to the cubes of the middles of range cells. */
INSONIFY_VECTOR_CLONES void scatterInCubes(const Cubes& cubes, const float* intensities, float* __restrict in_phase,
                                           float* __restrict quadrature) {
    const Cubes c = cubes;
    for (size_t k = c.first; k < c.last; ++k) {
        const auto on = static_cast<float>(static_cast<int32_t>(k - c.first));
        uint32_t place = c.seed;
        for (int axis = 0; axis < 3; ++axis) {
            const float at = c.start[axis] + on * c.step[axis];
            const auto whole = static_cast<int32_t>(at);
            place =
                mixed(place + c.base[axis] + static_cast<uint32_t>(whole - (at < static_cast<float>(whole) ? 1 : 0)));
        }
        const float field = std::sqrt(-intensities[k] * logarithm(uniform(place)));
        const float phase = uniform(place >> 16), turns = phase - nearest(phase);
        in_phase[k] = field * computeCosine(turns);
        quadrature[k] = field * computeSine(turns);
    }
}

}  // namespace

FieldResponse::FieldResponse(const RenderPlan& plan) {
    const FieldSampling sampling = fieldSampling(plan);
    samples_ = static_cast<size_t>(plan.grid.bin_count * sampling.samples);
    stride_ = static_cast<size_t>(sampling.parts / sampling.samples);
    sample_width_ = plan.grid.bin_width / sampling.samples;
    if (!plan.has(Pass::Pulse)) return;
    pulse_.emplace(*plan.config.pulse, plan.grid.speed_of_sound);
    reach_ = pulse_->extent(RangeResponse::floor_db);
    const double width = sample_width_ / static_cast<double>(stride_);
    const auto maximum = static_cast<int>(std::min(std::ceil(reach_ / width), static_cast<double>(cells() - 1)));
    const auto stride = static_cast<int>(stride_);
    for (int t = -maximum; t <= maximum; ++t) {
        const double power = pulse_->mean((t - 0.5) * width, (t + 0.5) * width);
        const int from = (stride - 1) / 2 + t, phase = (from % stride + stride) % stride;
        const ptrdiff_t shift = (from - phase) / stride;
        taps_.push_back({static_cast<size_t>(phase), shift,
                         static_cast<float>(std::copysign(std::sqrt(power), pulse_->amplitude(t * width)))});
        margin_ = std::max(margin_, static_cast<size_t>(std::abs(shift)));
    }
    while (taps_.size() % 4 != 0) {  // those without a four are added one by one
        const auto at = taps_.end() - static_cast<ptrdiff_t>(taps_.size() % 4);
        taps_.insert(at + 1, 3, {at->phase, at->shift, 0});
    }
    for (Tap& tap : taps_) tap.offset = static_cast<ptrdiff_t>(tap.phase * phaseLength() + 2 * margin_) + 2 * tap.shift;
}

void FieldResponse::spread(std::span<const float> phases, Support support, std::span<float> fields) const {
    if (!pulse_) {
        std::copy_n(phases.begin(), fields.size(), fields.begin());
        return;
    }
    INSONIFY_CHECK(phases.size() == phasesSize(), phases.size(), phasesSize());
    const auto first = static_cast<ptrdiff_t>(support.first), end = static_cast<ptrdiff_t>(support.end);
    std::array<float, block> sums;
    for (size_t j = 0; j < fields.size(); j += block) {
        // Taps that read nothing but zeros change no bit.
        const auto sample = static_cast<ptrdiff_t>(j / 2), behind = sample + static_cast<ptrdiff_t>(block / 2);
        const auto reads = [&](ptrdiff_t shift) { return std::ranges::lower_bound(taps_, shift, {}, &Tap::shift); };
        const auto low = (reads(first - behind + 1) - taps_.begin()) / 4 * 4,
                   high = (reads(end - sample) - taps_.begin() + 3) / 4 * 4;
        sumTaps(phases.data() + j, taps_.data() + low, static_cast<size_t>(std::max<ptrdiff_t>(0, high - low)),
                sums.data());
        std::copy_n(sums.begin(), std::min(block, fields.size() - j), fields.begin() + static_cast<ptrdiff_t>(j));
    }
}

double FieldResponse::amplitude(size_t sample, double range) const {
    const auto number = static_cast<double>(sample);
    if (pulse_) return pulse_->amplitude((number + 0.5) * sample_width_ - range);
    return number == binAt(range, sample_width_) ? 1 : 0;
}

void FieldResponse::addEcho(double range, std::complex<double> field, std::span<float> fields) const {
    INSONIFY_CHECK(fields.size() == 2 * samples_, fields.size(), samples_);
    INSONIFY_CHECK(std::isfinite(range) && std::isfinite(std::abs(field)), range, field.real(), field.imag());
    const double first = std::max(0.0, binAt(range - reach_, sample_width_));
    const double last = binAt(range + reach_, sample_width_);
    for (auto sample = static_cast<size_t>(first); sample < samples_ && static_cast<double>(sample) <= last; ++sample) {
        const std::complex<double> received = amplitude(sample, range) * field;
        fields[2 * sample] += static_cast<float>(received.real());
        fields[2 * sample + 1] += static_cast<float>(received.imag());
    }
}

FieldBeams::FieldBeams(const RenderPlan& plan, size_t numbers)
    : numbers_(numbers), beam_count_(plan.beams.size()), cells_(plan.cells.size() * numbers) {
    if (!plan.has(Pass::Beamform)) return;
    beamformer_ = fieldBeamformer(plan, numbers);
    beams_.resize(beam_count_ * numbers);
    if (beamformer_->isComplex()) quadratures_.resize(beams_.size());
}

void FieldBeams::form(ThreadPool& threads) {
    if (!beamformer_) return;
    const auto visitEach = [&](size_t count, const auto& work) {
        std::atomic<size_t> next = 0;
        threads.share([&](int, int) {
            for (size_t i = next++; i < count; i = next++) work(i);
        });
    };
    visitEach(beamformer_->groupCount(), [&](size_t group) { beamformer_->sumGroup(group, cells_); });
    visitEach((beam_count_ + together - 1) / together, [&](size_t number) {
        const size_t first = number * together, count = std::min(together, beam_count_ - first);
        const std::span<float> formed(&beams_[first * numbers_], count * numbers_);
        beamformer_->form(first, count, cells_, formed);
        if (!beamformer_->isComplex()) return;
        const std::span<float> own(&quadratures_[first * numbers_], count * numbers_);
        beamformer_->formQuadrature(first, count, cells_, own);
        addQuadrature(own.data(), formed.data(), own.size() / 2);
    });
}

WaterField::WaterField(const RenderPlan& plan, size_t cells)
    : cells_(cells), width_(plan.grid.bin_width * plan.grid.bin_count / static_cast<double>(cells)) {}

void WaterField::fill(const types::Pose& sonar, const Beam& azimuth, std::span<const float> intensities, uint32_t seed,
                      std::span<float> real, std::span<float> imaginary) const {
    const glm::dvec3 ray = sonar.orientation * glm::dvec3(std::cos(azimuth.centre), std::sin(azimuth.centre), 0);
    const double spread = azimuth.high - azimuth.low;
    for (size_t first = 0; first < cells_;) {
        // Cubes as long as a range cell, or at short range as the azimuth cell's width; powers of 2 keep them fixed.
        const double near = (static_cast<double>(first) + 0.5) * width_;
        const double side = std::exp2(std::floor(std::log2(std::min(width_, near * spread))));
        const double finer_to = 2 * side <= width_ ? 2 * side / spread : std::numeric_limits<double>::infinity();
        const double last = std::min(std::ceil(finer_to / width_ - 0.5), static_cast<double>(cells_));
        Cubes cubes{first, std::max(static_cast<size_t>(last), first + 1), {}, {}, {}, seed};
        for (int axis = 0; axis < 3; ++axis) {
            const double start = (sonar.position[axis] + near * ray[axis]) / side, base = std::floor(start);
            cubes.start[axis] = static_cast<float>(start - base);
            cubes.step[axis] = static_cast<float>(width_ * ray[axis] / side);
            cubes.base[axis] = makeSquare(base);
        }
        scatterInCubes(cubes, intensities.data(), real.data(), imaginary.data());
        first = cubes.last;
    }
}

EchoField::EchoField(const RenderPlan& plan, int threads)
    : Accumulator(plan),
      plan_(plan),
      response_(plan),
      water_(plan, response_.cells()),
      beams_(plan, numbers()),
      scratch_(static_cast<size_t>(threads)) {
    for (int k = 0; k < plan.summed.bin_count; ++k)
        amplitudes_.push_back(std::sqrt(levels().factor(static_cast<size_t>(k))));
    for (Scratch& scratch : scratch_) {
        scratch.phases.resize(response_.phasesSize());
        for (std::vector<float>* each : {&scratch.energies, &scratch.real, &scratch.imaginary})
            each->resize(response_.cells());
        scratch.spread.resize(numbers());
    }
}

bool EchoField::fill(size_t cell, const EchoRules& rules, const uint64_t* sums, double solid_angle, size_t thread) {
    INSONIFY_CHECK(thread < scratch_.size(), thread, scratch_.size());
    INSONIFY_CHECK(cell < plan_.cells.size(), cell, plan_.cells.size());
    Scratch& scratch = scratch_[thread];
    const double quantum = std::sqrt(solid_angle / rules.strength_scale) / quanta_per_unit;
    const size_t cells = response_.cells(), samples = response_.samples(), stride = cells / samples;
    const auto [first_cell, end_cell] = findEchoes(sums, cells);
    FieldResponse::Support support{first_cell / stride, (end_cell + stride - 1) / stride};
    for (size_t phase = 0; phase < stride; ++phase) {
        float* const fields = &scratch.phases[response_.place(phase)];
        std::fill(fields, fields + 2 * support.first, 0.0f);
        std::fill(fields + 2 * support.end, fields + 2 * samples, 0.0f);
        const size_t first = stride * support.first + phase;
        scaleSums(sums + 2 * first, amplitudes_.data() + first, stride, quantum, fields + 2 * support.first,
                  support.end - support.first);
    }
    if (!rules.own.empty()) {
        addOwnSums(rules, sums, cell, solid_angle, energies(cell, thread));
        scatter(cell, 1, scratch);
        support = {0, samples};
    }
    response_.spread(scratch.phases, support, beams_.cell(cell));
    return first_cell < end_cell;
}

std::span<float> EchoField::energies(size_t /*cell*/, size_t thread) {
    INSONIFY_CHECK(thread < scratch_.size(), thread, scratch_.size());
    std::ranges::fill(scratch_[thread].energies, 0.0f);
    return scratch_[thread].energies;
}

void EchoField::add(size_t beam, double range, std::complex<double> field) {
    INSONIFY_CHECK(beam < plan_.beams.size(), beam, plan_.beams.size());
    response_.addEcho(range, field, beams_.beam(beam));
}

void EchoField::addEnergies(size_t cell, size_t thread) {
    INSONIFY_CHECK(cell < plan_.cells.size(), cell, plan_.cells.size());
    Scratch& scratch = scratch_[thread];
    for (size_t k = 0; k < response_.cells(); ++k)
        scratch.phases[response_.place(k)] = scratch.phases[response_.place(k) + 1] = 0;
    scatter(cell, 2, scratch);
    response_.spread(scratch.phases, {0, response_.samples()}, scratch.spread);
    addScaled(scratch.spread.data(), 1, beams_.cell(cell).data(), numbers());
}

void EchoField::scatter(size_t cell, uint32_t seed, Scratch& scratch) const {
    water_.fill(sonar_, plan_.cells[cell], scratch.energies, seed, scratch.real, scratch.imaginary);
    for (size_t k = 0; k < response_.cells(); ++k) {
        scratch.phases[response_.place(k)] += scratch.real[k];
        scratch.phases[response_.place(k) + 1] += scratch.imaginary[k];
    }
}

void EchoField::detect(types::Sonar& ping) const {
    const size_t per_bin = response_.samples() / ping.bin_count;
    if (per_bin == 1) return square(beams_.all().data(), ping.bins.data(), ping.bins.size());
    const float* field = beams_.all().data();
    for (float& bin : ping.bins) {
        float sum = 0;
        for (size_t i = 0; i < per_bin; ++i, field += 2) sum += field[0] * field[0] + field[1] * field[1];
        bin = sum / static_cast<float>(per_bin);
    }
}

}  // namespace insonify::sonar
