#include "components/sonar/bins/LineArray.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "components/acoustics/BeamPattern.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr size_t oversampling = 16;

/** Returns the mean of exp(2 pi i place sine) over the sines of a cell. */
Complex meanTurn(double place, const Cone& cell) {
    const double half = pi * place * (cell.high - cell.low);
    const double size = std::abs(half) < 1e-6 ? 1 : std::sin(half) / half;
    return std::polar(1.0, 2 * pi * place * cell.middle()) * size;
}

/** Replaces values[q] by the sum over m of values[m] exp(-2 pi i m q / size); their number is a power of two. */
void transform(std::vector<Complex>& values) {
    const size_t size = values.size();
    for (size_t i = 1, j = 0; i < size; ++i) {
        size_t bit = size >> 1;
        for (; j & bit; bit >>= 1) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(values[i], values[j]);
    }
    for (size_t length = 2; length <= size; length <<= 1)
        for (size_t k = 0; k < length / 2; ++k) {
            const Complex turn = std::polar(1.0, -2 * pi * static_cast<double>(k) / static_cast<double>(length));
            for (size_t from = k; from < size; from += length) {
                const Complex odd = values[from + length / 2] * turn;
                values[from + length / 2] = values[from] - odd;
                values[from] += odd;
            }
        }
}

/** Place of a direction on the circle of a transform: between two of its values, and the phases that refer it to the
 *  array's middle. */
struct Direction {
    size_t low, high;
    float share;  ///< Weight of `high` [1].
    Complex turn_low, turn_high;
};

/** Returns the fields of the azimuth cells, times their transmit amplitudes. */
ComplexRows sentField(const RenderPlan& plan, const EchoField& field) {
    ComplexRows rows(plan.cells.size(), field.response().samples());
    for (size_t cell = 0; cell < plan.cells.size(); ++cell) {
        const double azimuth = plan.cells[cell].centre;
        const auto sent = static_cast<float>(plan.directivity->sentAmplitude(azimuth));
        const std::span<const float> numbers = field.cell(cell);
        const auto row = rows.row(cell);
        for (size_t i = 0; i < row.size(); ++i) row[i] = {sent * numbers[2 * i], sent * numbers[2 * i + 1]};
    }
    return rows;
}

void multiplyRows(ComplexRows& rows, std::span<const Complex> factors) {
    for (size_t m = 0; m < factors.size(); ++m)
        for (auto& value : rows.row(m)) value *= std::complex<float>(factors[m]);
}

}  // namespace

LineArray::LineArray(size_t count, double spacing, double wavelength, const acoustics::Taper& taper)
    : spacing_(spacing),
      wavelength_(wavelength),
      weights_(acoustics::elementWeights(count, static_cast<double>(count) * spacing / wavelength, taper)) {}

double LineArray::position(size_t element) const {
    return (static_cast<double>(element) - 0.5 * static_cast<double>(count() - 1)) * spacing_;
}

ComplexRows LineArray::elementSignals(const ComplexRows& field, std::span<const Cone> cells) const {
    if (field.rowCount() != cells.size()) throw std::invalid_argument("a field has one row for each cell");
    ComplexRows element_rows(count(), field.sample_count);
    for (size_t m = 0; m < count(); ++m) {
        const auto sum = element_rows.row(m);
        for (size_t cell = 0; cell < cells.size(); ++cell) {
            const std::complex<float> turn(meanTurn(position(m) / wavelength_, cells[cell]));
            const auto echoes = field.row(cell);
            for (size_t i = 0; i < sum.size(); ++i) {  // by parts: the product of std::complex checks for infinities
                const float re = echoes[i].real(), im = echoes[i].imag();
                sum[i] += std::complex<float>(re * turn.real() - im * turn.imag(), re * turn.imag() + im * turn.real());
            }
        }
    }
    return element_rows;
}

ComplexRows LineArray::form(const ComplexRows& element_rows, std::span<const double> sines) const {
    if (element_rows.rowCount() != count()) throw std::invalid_argument("there is one row for each element");
    const size_t size = std::bit_ceil(oversampling * count());
    std::vector<Direction> directions;
    for (const double sine : sines) {
        const double place = sine * spacing_ / wavelength_ * static_cast<double>(size), low = std::floor(place);
        const auto wrapped = [&](double q) { return static_cast<size_t>(static_cast<long>(q)) & (size - 1); };
        const auto turn = [&](double q) {  // element 0 is not in the middle
            return std::polar(1.0, -2 * pi * q / static_cast<double>(size) * position(0) / spacing_);
        };
        directions.push_back(
            {wrapped(low), wrapped(low + 1), static_cast<float>(place - low), turn(low), turn(low + 1)});
    }
    ComplexRows beams(sines.size(), element_rows.sample_count);
    std::vector<Complex> spectrum;
    for (size_t i = 0; i < element_rows.sample_count; ++i) {
        spectrum.assign(size, 0.0);
        for (size_t m = 0; m < count(); ++m) spectrum[m] = weights_[m] * Complex(element_rows.row(m)[i]);
        transform(spectrum);
        for (size_t k = 0; k < sines.size(); ++k) {
            const Direction& direction = directions[k];
            const Complex low = spectrum[direction.low] * direction.turn_low,
                          high = spectrum[direction.high] * direction.turn_high;
            beams.row(k)[i] = std::complex<float>(low + static_cast<double>(direction.share) * (high - low));
        }
    }
    return beams;
}

std::vector<Cone> makeCones(const Fan& beams) {
    std::vector<Cone> cones;
    for (const Beam& beam : beams) cones.push_back({std::sin(beam.low), std::sin(beam.high)});
    return cones;
}

LineArray lineArray(const SonarConfig& config) {
    const double wavelength = config.speedOfSound() / (1e3 * *config.frequency_khz);
    const acoustics::BeamPattern pattern(*config.beam_pattern->receive.azimuth, wavelength);
    const ElementsConfig::Array array = config.elements->makeArray(pattern.aperture() * wavelength, wavelength);
    return {array.count, array.spacing, wavelength, pattern.taper()};
}

void computeSignals(const RenderPlan& plan, const EchoField& field, const LineArray& array,
                    types::SonarElements& signals) {
    ComplexRows element_rows = array.elementSignals(sentField(plan, field), makeCones(plan.cells));
    if (plan.config.imperfections) multiplyRows(element_rows, plan.config.imperfections->elementFactors(array.count()));
    signals.speed_of_sound = plan.grid.speed_of_sound;
    signals.wavelength = array.wavelength();
    signals.sample_spacing = field.response().sampleWidth();
    signals.first_range = 0.5 * signals.sample_spacing;
    signals.sample_count = static_cast<uint32_t>(element_rows.sample_count);
    signals.positions.clear();
    for (size_t m = 0; m < array.count(); ++m) signals.positions.push_back(array.position(m));
    signals.weights = array.weights();
    signals.in_phase.resize(element_rows.values.size());
    signals.quadrature.resize(element_rows.values.size());
    std::ranges::transform(element_rows.values, signals.in_phase.begin(),
                           [](const auto& value) { return value.real(); });
    std::ranges::transform(element_rows.values, signals.quadrature.begin(),
                           [](const auto& value) { return value.imag(); });
}

}  // namespace insonify::sonar
