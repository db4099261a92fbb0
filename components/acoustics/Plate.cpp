#include "components/acoustics/Plate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insonify::acoustics {
namespace {

using Complex = std::complex<double>;

constexpr double grazing_cosine = 1e-6;  ///< Min cosine of incidence; waves nearer to grazing are computed at it [1].
constexpr double min_loss = 1e-9;        ///< Keeps resonances finite [1].
constexpr double max_decay = 300;        ///< Max attenuation across the plate; exp(-300) is as good as 0 [Np].
constexpr double min_phase = 1e-7;       ///< A plate of a smaller phase is none: its fluids touch [rad].

/** One kind of wave in the plate. */
struct Wave {
    Complex impedance;     ///< Density times phase speed along the normal [Pa s/m].
    Complex cot, inverse;  ///< Cotangent and 1 / sine of the phase across the plate [1].
};

/** Returns the wave of a speed [m/s] at a frequency [Hz]. `slowness` is along the plate [s/m]. */
Wave waveIn(const Plate& plate, double speed, double frequency, double slowness) {
    const Complex number = Complex(1, std::max(plate.loss, min_loss)) / speed;  // over the angular frequency [s/m]
    Complex normal = std::sqrt(number * number - slowness * slowness);
    if (normal.imag() < 0) normal = -normal;
    Complex phase = 2 * std::numbers::pi * frequency * plate.thickness * normal;
    phase.imag(std::min(phase.imag(), max_decay));
    const Complex sine = std::sin(phase);
    return {plate.density / normal, std::cos(phase) / sine, 1.0 / sine};
}

/** Returns the impedance of a wave in a fluid along the normal [Pa s/m]. */
Complex computeImpedance(const Fluid& fluid, double slowness) {
    const Complex normal = std::sqrt(Complex(1 / (fluid.sound_speed * fluid.sound_speed) - slowness * slowness, 0));
    return fluid.density /
           (std::abs(normal) > grazing_cosine / fluid.sound_speed ? normal : grazing_cosine / fluid.sound_speed);
}

constexpr double min_rest = 1e-3;  ///< Below this share of all returns, the rest is added to the last return [1].

/** Returns the terms of a series of the given sum; `term(k)` is the k-th term. */
std::vector<double> computeTerms(double sum, size_t max_count, const auto& term) {
    std::vector<double> terms;
    double rest = sum;
    while (terms.empty() || (rest > min_rest * sum && terms.size() < max_count)) {
        terms.push_back(term(terms.size()));
        rest -= terms.back();
    }
    terms.back() += std::max(rest, 0.0);
    return terms;
}

}  // namespace

PlateShares computeShares(const Plate& plate, const Fluid& before, const Fluid& behind, double frequency,
                          double cos_incidence) {
    const PlateResponse response = plateResponse(plate, before, behind, frequency, cos_incidence);
    const double slowness = std::sqrt(std::max(1 - cos_incidence * cos_incidence, 0.0)) / before.sound_speed;
    const double admittance = (1.0 / computeImpedance(behind, slowness)).real();  // 0 beyond the critical angle
    return {std::norm(response.reflected),
            std::norm(response.transmitted) * admittance * computeImpedance(before, slowness).real()};
}

bool isNearResonance(const Plate& plate, double frequency) {
    constexpr double near = 0.1;
    const double halves = countHalfWaves(plate, frequency);
    return halves > 1 - near && std::abs(halves - std::round(halves)) <= near;
}

Plate makePlate(const types::Shell& shell) {
    return {shell.thickness, shell.density, shell.sound_speed, shell.shear_speed, shell.loss};
}

Fluid getFluidBehind(const types::Shell& shell, const Fluid& water) {
    constexpr Fluid air{1.23, 340};  // compressed air is denser, which has no effect on a wall
    if (shell.has_air) return air;
    return shell.fill_density > 0 ? Fluid{shell.fill_density, shell.fill_speed} : water;
}

PlateReturns plateReturns(const Plate& plate, const Fluid& before, const Fluid& behind, double frequency,
                          size_t max_count) {
    const Complex number = Complex(1, plate.loss) / plate.sound_speed;  // over the angular frequency [s/m]
    const Complex own = plate.density / number;
    const double one = before.density * before.sound_speed, other = behind.density * behind.sound_speed;
    const Complex front = (own - one) / (own + one), back = (other - own) / (other + own);
    const double crossing = std::exp(-4 * std::numbers::pi * frequency * plate.thickness * number.imag());
    const double again =  // share of the energy that is left after each time across and back
        std::min(std::norm(front * back) * crossing * crossing, 1 - 1e-9);
    const double first = std::norm(front), in_and_out = std::norm(1.0 - front * front);
    const double second = in_and_out * std::norm(back) * crossing * crossing;
    const double straight = in_and_out * std::norm(1.0 - back * back) * crossing * crossing;
    return {computeTerms(first + second / (1 - again), max_count,
                         [&](size_t k) { return k == 0 ? first : second * std::pow(again, k - 1); }),
            computeTerms(straight * (1 + again) / std::pow(1 - again, 3), max_count,
                         [&](size_t k) { return straight * std::pow(k + 1, 2) * std::pow(again, k); }),
            computeTerms(std::sqrt(straight) / (1 - again), max_count,
                         [&](size_t k) { return std::sqrt(straight) * std::pow(again, k); })};
}

PlateResponse plateResponse(const Plate& plate, const Fluid& before, const Fluid& behind, double frequency,
                            double cos_incidence) {
    const double cosine = std::clamp(cos_incidence, grazing_cosine, 1.0);
    const double slowness = std::sqrt(1 - cosine * cosine) / before.sound_speed;
    const Complex one = before.density * before.sound_speed / cosine, other = computeImpedance(behind, slowness);
    if (!(2 * std::numbers::pi * frequency * plate.thickness > min_phase * plate.sound_speed))
        return {(other - one) / (other + one), 2.0 * other / (other + one)};
    const Wave pressure = waveIn(plate, plate.sound_speed, frequency, slowness);
    Complex along = pressure.impedance * pressure.cot, across = pressure.impedance * pressure.inverse;
    if (plate.shear_speed > 0) {
        const Wave shear = waveIn(plate, plate.shear_speed, frequency, slowness);
        const Complex sine = slowness * plate.shear_speed / Complex(1, std::max(plate.loss, min_loss));
        const Complex square = 1.0 - 2.0 * sine * sine;  // cosine of twice the shear waves' angle
        const Complex of_pressure = square * square, of_shear = 1.0 - of_pressure;
        along = of_pressure * along + of_shear * shear.impedance * shear.cot;
        across = of_pressure * across + of_shear * shear.impedance * shear.inverse;
    }
    const Complex i(0, 1), behind_plate = other + i * along;  // pressures vary as exp(-i omega t)
    const Complex at_face = i * along + across * across / behind_plate;
    return {(at_face - one) / (at_face + one), 2.0 * i * across * other / (behind_plate * (at_face + one))};
}

}  // namespace insonify::acoustics
