#include "components/sonar/TruthTable.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "types/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Turns sines into angles, within 3e-7 rad: Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.46. */
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

}  // namespace

ObjectEcho ObjectEcho::of(uint64_t energy, double sine_elevation, double sine_grazing, uint32_t object, uint32_t hits) {
    const double half = 0.5 * static_cast<double>(energy);  // of quanta, so that a sum holds what the bin's own holds
    return {energy, static_cast<int64_t>(half * sine_elevation), static_cast<int64_t>(half * sine_grazing), object,
            hits};
}

void ObjectEcho::add(const ObjectEcho& other) {
    energy += other.energy;
    elevation += other.elevation;
    grazing += other.grazing;
    hits += other.hits;
}

TruthTable::TruthTable(size_t beams, size_t bins)
    : bins_(bins), used_(beams * bins), places_(beams * bins * told_apart), rest_(beams * bins) {}

void TruthTable::clear() { std::ranges::fill(used_, uint8_t{0}); }

void TruthTable::clearBeam(size_t beam) {
    std::fill_n(used_.begin() + static_cast<ptrdiff_t>(beam * bins_), bins_, uint8_t{0});
}

std::span<const ObjectEcho> TruthTable::echoes(size_t at) const {
    return {&places_[at * told_apart], std::min<size_t>(used_[at], told_apart)};
}

void TruthTable::addAt(size_t at, const ObjectEcho& echo) {
    ObjectEcho* const first = &places_[at * told_apart];
    const size_t count = std::min<size_t>(used_[at], told_apart);
    for (size_t i = 0; i < count; ++i)
        if (first[i].object == echo.object) return first[i].add(echo);
    insert(at, echo);
}

void TruthTable::insert(size_t at, const ObjectEcho& echo) {
    ObjectEcho* const first = &places_[at * told_apart];
    size_t count = std::min<size_t>(used_[at], told_apart);
    if (count == told_apart) {
        if (echo.object > first[count - 1].object) return addRest(at, echo);
        addRest(at, first[--count]);
    } else {
        ++used_[at];
    }
    for (; count > 0 && first[count - 1].object > echo.object; --count) first[count] = first[count - 1];
    first[count] = echo;
}

void TruthTable::addRest(size_t at, const ObjectEcho& echo) {
    if (used_[at] != more) rest_[at] = {};
    used_[at] = more;
    rest_[at].add(echo);
}

void TruthTable::merge(size_t beam, const TruthTable& other, size_t of) {
    for (size_t bin = 0; bin < bins_; ++bin) {
        const size_t from = of * bins_ + bin, to = beam * bins_ + bin;
        for (const ObjectEcho& echo : other.echoes(from)) addAt(to, echo);
        if (other.used_[from] == more) addRest(to, other.rest_[from]);
    }
}

void TruthTable::tellBin(size_t at, size_t to, types::SonarTruth& truth) const {
    ObjectEcho all = used_[at] == more ? rest_[at] : ObjectEcho{}, strongest;
    for (const ObjectEcho& echo : echoes(at)) {
        all.add(echo);
        if (echo.energy > strongest.energy) strongest = echo;
    }
    const double energy = static_cast<double>(strongest.energy), per_energy = 2 / energy;
    const auto sine = [&](int64_t sines) {
        return std::clamp(static_cast<float>(static_cast<double>(sines) * per_energy), -1.0f, 1.0f);
    };
    truth.object[to] = static_cast<int32_t>(strongest.object);
    truth.elevation[to] = sine(strongest.elevation);
    truth.grazing[to] = sine(strongest.grazing);
    truth.share[to] = static_cast<float>(energy / static_cast<double>(all.energy));
    truth.hits[to] = all.hits;
}

void TruthTable::tell(size_t beam, size_t to, types::SonarTruth& truth) const {
    constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
    bool echo_beyond = false;
    for (size_t bin = bins_; bin-- > 0;) {
        const size_t from = beam * bins_ + bin, at = to * bins_ + bin;
        const bool heard = used_[from] > 0;
        truth.path[at] = 0;
        truth.shadow[at] = !heard && echo_beyond;
        echo_beyond = echo_beyond || heard;
        if (heard) {
            tellBin(from, at, truth);
        } else {
            truth.object[at] = types::SonarTruth::no_object;
            truth.share[at] = 0;
            truth.hits[at] = 0;
            truth.elevation[at] = truth.grazing[at] = unknown;
        }
    }
    toAngles(truth.elevation.data() + to * bins_, bins_);
    toAngles(truth.grazing.data() + to * bins_, bins_);
}

}  // namespace insonify::sonar
