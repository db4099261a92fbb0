#include "components/sonar/bins/TruthTable.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "types/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Converts sines into angles, within 3e-7 rad: Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.46. */
INSONIFY_VECTOR_CLONES void toAngles(float* sines, size_t count) {
    constexpr float quarter = std::numbers::pi_v<float> / 2;
    for (size_t i = 0; i < count; ++i) {
        const float x = std::abs(sines[i]);
        float sum = -0.0012624911f;
        sum = sum * x + 0.0066700901f;
        sum = sum * x - 0.0170881256f;
        sum = sum * x + 0.0308918810f;
        sum = sum * x - 0.0501743046f;
        sum = sum * x + 0.0889789874f;
        sum = sum * x - 0.2145988016f;
        sum = sum * x + 1.5707963050f;
        sines[i] = std::copysign(quarter - std::sqrt(1 - x) * sum, sines[i]);
    }
}

/** Reports a bin in which no object is strongest, with the share of the water; 0: no water. */
void reportNoObject(size_t to, double share, types::SonarTruth& truth) {
    truth.object[to] = types::SonarTruth::no_object;
    truth.path[to] = share > 0 ? types::SonarTruth::water : uint8_t{0};
    truth.share[to] = static_cast<float>(share);
    truth.elevation[to] = truth.grazing[to] = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

TruthTable::TruthTable(size_t beams, size_t bins)
    : bins_(bins),
      used_(beams * bins),
      first_(beams * bins),
      others_(beams * bins * (kept_apart - 1)),
      rest_(beams * bins) {}

void TruthTable::clear() { std::ranges::fill(used_, uint8_t{0}); }

void TruthTable::addToOthers(size_t at, const ObjectEcho& added) {
    const size_t count = objectsAt(at);
    size_t highest = 0;
    for (size_t i = 0; i < count; ++i) {
        if (echo(at, i).object == added.object) return echo(at, i).add(added);
        if (echo(at, i).object > echo(at, highest).object) highest = i;
    }
    if (count < kept_apart) {
        echo(at, count) = added;
        ++used_[at];
    } else if (added.object > echo(at, highest).object) {
        addRest(at, added);
    } else {
        addRest(at, echo(at, highest));
        echo(at, highest) = added;
    }
}

void TruthTable::addRest(size_t at, const ObjectEcho& added) {
    if (used_[at] != more) rest_[at] = {};
    used_[at] = more;
    rest_[at].add(added);
}

void TruthTable::merge(size_t beam, const TruthTable& other, size_t of) {
    for (size_t bin = 0; bin < bins_; ++bin) {
        const size_t from = of * bins_ + bin;
        for (size_t i = 0; i < other.objectsAt(from); ++i) add(beam, bin, other.echo(from, i));
        if (other.used_[from] == more) addRest(beam * bins_ + bin, other.rest_[from]);
    }
}

void TruthTable::reportBin(size_t at, size_t to, uint64_t water, types::SonarTruth& truth) const {
    const ObjectEcho* strongest = &first_[at];
    ObjectEcho all = *strongest;
    for (size_t i = 1; i < objectsAt(at); ++i) {
        const ObjectEcho& other = echo(at, i);
        all.add(other);
        if (std::pair(other.energy, strongest->object) > std::pair(strongest->energy, other.object)) strongest = &other;
    }
    if (used_[at] == more) all.add(rest_[at]);
    truth.hits[to] = all.hits;
    const double total = static_cast<double>(all.energy) + static_cast<double>(water);
    if (water > strongest->energy) return reportNoObject(to, static_cast<double>(water) / total, truth);
    const auto energy = static_cast<double>(static_cast<int64_t>(strongest->energy));
    const double per_energy = 2 / energy;
    const auto sine = [&](int64_t sines) {
        return std::clamp(static_cast<float>(static_cast<double>(sines) * per_energy), -1.0f, 1.0f);
    };
    const bool alone = used_[at] == 1 && water == 0;
    truth.object[to] = static_cast<int32_t>(strongest->object & ~(behind_walls | rung_in_wall));
    truth.path[to] = strongest->object & behind_walls   ? types::SonarTruth::through_wall
                     : strongest->object & rung_in_wall ? types::SonarTruth::rung
                                                        : 0;
    truth.elevation[to] = sine(strongest->elevation);
    truth.grazing[to] = sine(strongest->grazing);
    truth.share[to] = alone ? 1 : static_cast<float>(energy / total);
}

void TruthTable::report(size_t beam, size_t to, types::SonarTruth& truth, std::span<const uint64_t> water) const {
    bool echo_beyond = false;
    for (size_t bin = bins_; bin-- > 0;) {
        const size_t from = beam * bins_ + bin, at = to * bins_ + bin;
        const bool received = used_[from] > 0;
        const uint64_t of_water = water.empty() ? 0 : water[bin];
        truth.shadow[at] = !received && echo_beyond;
        echo_beyond = echo_beyond || received;
        if (received) {
            reportBin(from, at, of_water, truth);
        } else {
            truth.hits[at] = 0;
            reportNoObject(at, of_water > 0 ? 1 : 0, truth);
        }
    }
    toAngles(truth.elevation.data() + to * bins_, bins_);
    toAngles(truth.grazing.data() + to * bins_, bins_);
}

}  // namespace insonify::sonar
