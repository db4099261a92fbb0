#include "components/acoustics/Seabed.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <numbers>

#include "components/acoustics/SoundSpeed.hpp"

namespace insonify::acoustics {
namespace {

constexpr double finest_phi = 9, coarsest_phi = -1;
constexpr double water_speed_km_s = 1.528;  // speed of sound that the report's loss parameters are for

/** A name of table 2 with its mean grain size. */
struct GrainRow {
    std::string_view name;
    double phi;
};
constexpr GrainRow grains[] = {
    {"sandy_gravel", -1},      {"very_coarse_sand", -0.5},
    {"muddy_sandy_gravel", 0}, {"coarse_sand", 0.5},
    {"gravelly_sand", 0.5},    {"gravelly_muddy_sand", 1},
    {"medium_sand", 1.5},      {"muddy_gravel", 2},
    {"fine_sand", 2.5},        {"silty_sand", 2.5},
    {"muddy_sand", 3},         {"very_fine_sand", 3.5},
    {"clayey_sand", 4},        {"coarse_silt", 4.5},
    {"sandy_silt", 5},         {"gravelly_mud", 5},
    {"medium_silt", 5.5},      {"sand_silt_clay", 5.5},
    {"sandy_mud", 6},          {"silt", 6},  // as in table 3
    {"fine_silt", 6.5},        {"clayey_silt", 6.5},
    {"sandy_clay", 7},         {"very_fine_silt", 7.5},
    {"silty_clay", 8},         {"clay", 9},
};

/** A name of table 2 that has its own parameters. */
struct RockRow {
    std::string_view name;
    double speed_ratio, roughness;
};
constexpr RockRow rocks[] = {
    {"rough_rock", 2.5, 0.20693},
    {"rock", 2.5, 0.01862},
    // The report's cobble is printed illegibly: 0.0156 gives its table 3 to 0.3 dB, 0.0186 misses it by 1.7 dB.
    {"cobble", 1.8, 0.0156},
    {"gravel", 1.8, 0.0156},
};

/** Equation 2. */
double densityRatio(double m) {
    if (m < 1) return 0.007797 * m * m - 0.17057 * m + 2.3139;
    if (m < 5.3) return -0.0165406 * m * m * m + 0.2290201 * m * m - 1.1069031 * m + 3.0455;
    return -0.0012973 * m + 1.1565;
}

/** Equation 3. */
double speedRatio(double m) {
    if (m < 1) return 0.002709 * m * m - 0.056452 * m + 1.2778;
    if (m < 5.3) return -0.0014881 * m * m * m + 0.0213937 * m * m - 0.1382798 * m + 1.3425;
    return -0.0024324 * m + 1.0019;
}

/** Equation 5, after Hamilton 1972 [dB/(m kHz)]. */
double attenuation(double m) {
    if (m < 0) return 0.4556;
    if (m < 2.6) return 0.4556 + 0.0245 * m;
    if (m < 4.5) return 0.1978 + 0.1245 * m;
    if (m < 6) return 8.0399 - 2.5228 * m + 0.20098 * m * m;
    return 0.9431 - 0.2041 * m + 0.0117 * m * m;
}

/** Equations 9 and 10: from the rms relief of a track of a metre [cm^4]. */
double roughness(double m) {
    const double relief_cm = m < 5 ? (2.03846 - 0.26923 * m) / (1 + 0.076923 * m) : 0.5;
    return 0.00207 * relief_cm * relief_cm;
}

template <class Row>
const Row* find(const Row* begin, const Row* end, std::string_view name) {
    const Row* found = std::find_if(begin, end, [&](const Row& row) { return row.name == name; });
    return found == end ? nullptr : found;
}

using std::numbers::pi;

constexpr double degree = pi / 180;
constexpr double min_grazing = 0.001 * degree;
constexpr double min_kirchhoff = 40 * degree;

/** 1 far below 0, 0 far above: equation 57. */
double blend(double x) { return 1 / (1 + std::exp(x)); }

/** q_c of Kirchhoff's approximation: equations 36 and 39 [1]. */
double structure(double alpha, double roughness, double wave_number) {
    const double c_h2 = 2 * pi * roughness * std::tgamma(2 - alpha) * std::pow(2, -2 * alpha) /
                        (alpha * (1 - alpha) * std::tgamma(1 + alpha));
    return c_h2 * std::pow(2, 1 - 2 * alpha) * std::pow(wave_number, 2 * (1 - alpha));
}

/** Equation 40. */
double closedFormA(double alpha) {
    const double ratio = 8 * alpha * alpha * std::tgamma(1 / (2 * alpha) + 0.5) /
                         (std::tgamma(0.5) * std::tgamma(1 / alpha) * std::tgamma(1 / (2 * alpha)));
    return std::pow(ratio, 2 * alpha);
}

double closedFormB(double alpha, double a) {
    return std::pow(a, 0.5 - 1 / (2 * alpha)) * std::tgamma(1 / alpha) / (2 * alpha);
}

/** Returns s, the rms slope of the relief that the wave finds smooth: equation 42 [1]. */
double slope(double alpha, double roughness, double wave_number) {
    const double square = std::pow(2 * pi * roughness, 1 / alpha) / (2 * (1 - alpha)) *
                          std::pow(wave_number * wave_number / alpha, (1 - alpha) / alpha);
    return std::sqrt(square);
}

/** Returns the factor that the printed equations 36 to 40 lack compared with the report's own table 3, 3.6 dB:
 *  ACOUSTICS.md 3.5. */
double kirchhoffLevel(double alpha) { return std::pow(2, 2 * (1 - alpha) / alpha); }

}  // namespace

HalfSpace halfSpace(const Seabed& seabed) { return {seabed.density_ratio, seabed.speed_ratio, seabed.loss}; }

std::complex<double> waveNumberRatio(const HalfSpace& half_space) {
    return std::complex<double>(1, half_space.loss) / half_space.speed_ratio;
}

std::complex<double> halfSpaceReflection(const HalfSpace& half_space, double grazing) {
    const std::complex<double> kappa = waveNumberRatio(half_space);
    const double cosine = std::cos(grazing);
    const std::complex<double> below =
        std::sqrt(kappa * kappa - cosine * cosine);  // sine in the half-space, times kappa
    const std::complex<double> above = half_space.density_ratio * std::sin(grazing);
    return (above - below) / (above + below);
}

/** Equations 50 to 52. */
std::complex<double> roughnessAmplitude(const HalfSpace& half_space, double grazing) {
    const double rho = half_space.density_ratio, sine = std::sin(grazing), cosine = std::cos(grazing);
    const std::complex<double> kappa = waveNumberRatio(half_space);
    const std::complex<double> p = std::sqrt(kappa * kappa - cosine * cosine);
    return ((rho - 1) * (rho - 1) * cosine * cosine + rho * rho - kappa * kappa) /
           ((rho * sine + p) * (rho * sine + p));
}

Seabed seabedOfGrainSize(double phi) {
    const double m = std::clamp(phi, coarsest_phi, finest_phi);
    Seabed seabed;
    seabed.density_ratio = densityRatio(m);
    seabed.speed_ratio = speedRatio(m);
    seabed.loss = attenuation(m) * seabed.speed_ratio * water_speed_km_s * std::numbers::ln10 / (40 * std::numbers::pi);
    seabed.volume = m < 5.5 ? 0.002 : 0.001;
    seabed.roughness = roughness(m);
    return seabed;
}

std::string outsideGrainSizes(double phi) { return outside({{"phi", phi, coarsest_phi, finest_phi}}); }

std::optional<Seabed> seabedNamed(std::string_view name) {
    if (const GrainRow* grain = find(std::begin(grains), std::end(grains), name)) return seabedOfGrainSize(grain->phi);
    if (const RockRow* rock = find(std::begin(rocks), std::end(rocks), name))
        return Seabed{2.5, rock->speed_ratio, 0.01374, 0.002, rock->roughness, 3.25};
    return {};
}

std::optional<double> grainSizeNamed(std::string_view name) {
    const GrainRow* grain = find(std::begin(grains), std::end(grains), name);
    return grain ? std::optional(grain->phi) : std::nullopt;
}

std::vector<std::string> seabedNames() {
    std::vector<std::string> names;
    for (const RockRow& rock : rocks) names.emplace_back(rock.name);
    for (const GrainRow& grain : grains) names.emplace_back(grain.name);
    return names;
}

SeabedBackscatter::SeabedBackscatter(const Seabed& seabed, double frequency_khz, double speed_of_sound)
    : seabed_(seabed),
      wave_number_(2 * pi * 1e3 * frequency_khz / (100 * speed_of_sound)),
      alpha_(seabed.roughness_slope / 2 - 1),
      slope_(slope(alpha_, seabed.roughness, wave_number_)),
      structure_(structure(alpha_, seabed.roughness, wave_number_)),
      a_(closedFormA(alpha_)),
      b_(closedFormB(alpha_, a_)),
      normal_reflection_(std::norm(halfSpaceReflection(halfSpace(seabed), pi / 2))) {}

double SeabedBackscatter::crossSection(double grazing) const {
    const double angle = std::max(grazing, min_grazing);
    return roughInterface(angle) + volume(angle);
}

/** Equations 57 to 64. */
double SeabedBackscatter::roughInterface(double grazing) const {
    constexpr double steepest = 7 * degree, over = 0.5 * degree;
    const double c4 = std::pow(1000, 1 / (1 + alpha_)) * std::pow(a_ * structure_ * structure_, 1 / alpha_);
    const double near_vertical = blend((std::cos(grazing) - std::pow(1 / c4 + 4, -0.25)) / 0.0125);
    const double gentle = blend((std::atan(slope_) - steepest) / over);
    const double moderate = near_vertical * kirchhoff(grazing) + (1 - near_vertical) * compositeRoughness(grazing);
    return gentle * moderate + (1 - gentle) * largeRoughness(grazing);
}

/** Equations 35 to 40. */
double SeabedBackscatter::kirchhoff(double grazing) const {
    if (grazing < min_kirchhoff) return 0;
    const double spread = std::pow(std::abs(std::cos(grazing)), 4 * alpha_) +
                          a_ * structure_ * structure_ * std::pow(std::sin(grazing), 4);
    return kirchhoffLevel(alpha_) * b_ * structure_ * normal_reflection_ /
           (8 * pi * std::pow(spread, (1 + alpha_) / (2 * alpha_)));
}

double SeabedBackscatter::compositeRoughness(double grazing) const {
    return shadowing(grazing) * overSlopes([&](double angle) { return perturbation(angle); }, grazing);
}

/** First order of small perturbations: equations 7 and 50 to 52. */
double SeabedBackscatter::perturbation(double grazing) const {
    const double k = wave_number_, sine = std::sin(grazing), cosine = std::cos(grazing);
    const std::complex<double> y = roughnessAmplitude(halfSpace(seabed_), grazing);
    const double scatterers = std::sqrt(4 * k * k * cosine * cosine + k * k / 100);
    const double spectrum = seabed_.roughness * std::pow(scatterers, -seabed_.roughness_slope);
    return 4 * std::pow(k * sine, 4) * std::norm(y) * spectrum;
}

/** Returns the share of the seabed that is visible at low grazing angles: equations 43 to 45. */
double SeabedBackscatter::shadowing(double grazing) const {
    const double t = std::tan(grazing) / slope_;
    if (t > 2) return 1;
    const double q = (std::exp(-t * t) / std::sqrt(pi) - t * std::erfc(t)) / (4 * t);
    return -std::expm1(-2 * q) / (2 * q);
}

/** Returns the mean over slopes of the seabed, by three points: equations 46 to 49. */
double SeabedBackscatter::overSlopes(const std::function<double(double)>& section, double grazing) const {
    constexpr double outer = 0.295410, middle = 1.181636, node = 1.224745;
    const auto at = [&](double angle) { return section(std::clamp(angle, 0.0, pi / 2)); };
    return (outer * (at(grazing - node * slope_) + at(grazing + node * slope_)) + middle * at(grazing)) / std::sqrt(pi);
}

/** Empirical, for gravel and rock: equations 53 to 56, whose angles are in degrees. */
double SeabedBackscatter::largeRoughness(double grazing) const {
    constexpr double slow_bottom_deg = 2.5613;
    const double nu = seabed_.speed_ratio, rho = seabed_.density_ratio, s = slope_;
    const double critical = nu >= 1.001 ? std::acos(1 / nu) / degree : slow_bottom_deg;
    const double angle = grazing / degree, slope_deg = s / degree;
    const double impedance = (1 - 2 / rho) / (nu * nu) + 1;
    const double level =
        0.04682 * std::pow(s, 1.25) * std::pow(nu, 3.25) * impedance * impedance / (1 + 3.54 * slope_deg / critical);
    const double divisor = 1 + 0.81 * critical * critical / (angle * angle);
    const double from_vertical = (angle - 90) * (angle - 90) / (2.6 * slope_deg * slope_deg);
    return level * std::pow(std::sin(pi / divisor), 0.7263 * std::pow(s, -1.0 / 3)) +
           0.0260 * normal_reflection_ / (s * s * std::pow(1 + from_vertical, 1.9) * divisor);
}

double SeabedBackscatter::volume(double grazing) const {
    return shadowing(grazing) * overSlopes([&](double angle) { return volumeOfAPlane(angle); }, grazing);
}

/** Equations 65 and 66. */
double SeabedBackscatter::volumeOfAPlane(double grazing) const {
    const HalfSpace half_space = halfSpace(seabed_);
    const std::complex<double> kappa = waveNumberRatio(half_space), r = halfSpaceReflection(half_space, grazing);
    const std::complex<double> p = std::sqrt(kappa * kappa - std::pow(std::cos(grazing), 2));
    return 5 * seabed_.loss * seabed_.volume * std::norm(1.0 - r * r) * std::pow(std::sin(grazing), 2) /
           (seabed_.speed_ratio * std::numbers::ln10 * std::norm(p) * p.imag());
}

std::string outsideSeabedModel(double frequency_khz, double speed_of_sound) {
    return outside({{"kHz", frequency_khz, 10, 100}, {"m/s", speed_of_sound, 1400, 1600}});
}

}  // namespace insonify::acoustics
