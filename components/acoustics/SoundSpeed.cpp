#include "components/acoustics/SoundSpeed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace insonify::acoustics {
namespace {

constexpr double kg_per_cm2_per_bar = 1.019716;

/** Returns c[0] + c[1] x + c[2] x^2 + ... */
template <size_t n>
double polynomial(const double (&c)[n], double x) {
    double sum = 0;
    for (size_t i = n; i > 0; --i) sum = sum * x + c[i - 1];
    return sum;
}

// Chen and Millero's coefficients in Fofonoff and Millard (1983), equations 34 to 37: c = C + A S + B S^(3/2) + D S^2,
// each a polynomial in the pressure [bar] whose coefficients are polynomials in the temperature [degC].
constexpr double c0[] = {1402.388, 5.03711, -5.80852e-2, 3.3420e-4, -1.47800e-6, 3.1464e-9};
constexpr double c1[] = {0.153563, 6.8982e-4, -8.1788e-6, 1.3621e-7, -6.1185e-10};
constexpr double c2[] = {3.1260e-5, -1.7107e-6, 2.5974e-8, -2.5335e-10, 1.0405e-12};
constexpr double c3[] = {-9.7729e-9, 3.8504e-10, -2.3643e-12};
constexpr double a0[] = {1.389, -1.262e-2, 7.164e-5, 2.006e-6, -3.21e-8};
constexpr double a1[] = {9.4742e-5, -1.2580e-5, -6.4885e-8, 1.0507e-8, -2.0122e-10};
constexpr double a2[] = {-3.9064e-7, 9.1041e-9, -1.6002e-10, 7.988e-12};
constexpr double a3[] = {1.100e-10, 6.649e-12, -3.389e-13};
constexpr double b0[] = {-1.922e-2, -4.42e-5};
constexpr double b1[] = {7.3637e-5, 1.7945e-7};
constexpr double d[] = {1.727e-3, -7.9836e-6};

/** A term of Del Grosso (1974): coefficient times T^t S^s P^p. */
struct Term {
    double coefficient;
    int t, s, p;
};
constexpr Term del_grosso[] = {
    {1402.392, 0, 0, 0},           {0.501109398873e1, 1, 0, 0},  {-0.550946843172e-1, 2, 0, 0},
    {0.221535969240e-3, 3, 0, 0},  {0.132952290781e1, 0, 1, 0},  {0.128955756844e-3, 0, 2, 0},
    {0.156059257041, 0, 0, 1},     {0.244998688441e-4, 0, 0, 2}, {-0.883392332513e-8, 0, 0, 3},
    {-0.127562783426e-1, 1, 1, 0}, {0.635191613389e-2, 1, 0, 1}, {0.265484716608e-7, 2, 0, 2},
    {-0.159349479045e-5, 1, 0, 2}, {0.522116437235e-9, 1, 0, 3}, {-0.438031096213e-6, 3, 0, 1},
    {-0.161674495909e-8, 0, 2, 2}, {0.968403156410e-4, 2, 1, 0}, {0.485639620015e-5, 1, 2, 1},
    {-0.340597039004e-3, 1, 1, 1},
};

double power(double x, int n) {
    double product = 1;
    for (; n > 0; --n) product *= x;
    return product;
}

/** The stated validity of a law; a max pressure is given as the depth that has it [m]. */
struct Range {
    SoundSpeedLaw law;
    double celsius_min, celsius_max, psu_min, psu_max, depth_max;
};
constexpr Range ranges[] = {
    {SoundSpeedLaw::Leroy, -1, 30, 0, 42, 12000},     {SoundSpeedLaw::Mackenzie, -2, 30, 25, 40, 8000},
    {SoundSpeedLaw::Medwin, 0, 35, 0, 45, 1000},      {SoundSpeedLaw::Coppens, 0, 35, 0, 45, 4000},
    {SoundSpeedLaw::ChenMillero, 0, 40, 0, 40, 9700},  // 1000 bar
    {SoundSpeedLaw::DelGrosso, 0, 30, 30, 40, 9500},   // 1000 kg/cm^2
};
static_assert(std::size(ranges) == std::size(types::EnumNames<SoundSpeedLaw>::names));

constexpr double infinity = std::numeric_limits<double>::infinity();

/** A ray that advances through the layers of a profile. In a layer of gradient g [1/s] its rapidity,
 *  asinh(tan(elevation)), grows by g per second. cos(elevation) / c is the same in all layers (Snell). */
class Ray {
public:
    Ray(const SoundProfile& profile, double depth, double elevation)
        : depths_(profile.curve().x), speeds_(profile.curve().y), depth_(depth) {
        rapidity_ = std::asinh(std::tan(elevation));
        slowness_ = std::cos(elevation) / profile.speed(depth);
        below_ = static_cast<size_t>(std::ranges::upper_bound(depths_, depth) - depths_.begin());
    }

    void advance(double seconds) {
        for (int crossings = 0; seconds > 0 && crossings < max_crossings; ++crossings) {
            const double boundary = timeToBoundary();
            move(std::min(seconds, boundary));
            seconds -= std::min(seconds, boundary);
            if (seconds > 0) cross();
        }
        across_ += seconds / slowness_ / (std::cosh(rapidity_) * std::cosh(rapidity_));
    }

    RayPoint point() const {
        const double elevation = std::atan(std::sinh(rapidity_));
        return {across_, depth_, elevation, 1 / (slowness_ * std::cosh(rapidity_))};
    }

private:
    /** Max crossings of boundaries in one step [1]. A ray that is trapped about the depth of minimal speed may cross it
     *  again and again; after this number of crossings it proceeds level. */
    static constexpr int max_crossings = 1000;

    bool inside() const { return below_ > 0 && below_ < depths_.size(); }
    double gradient() const {
        return inside() ? (speeds_[below_] - speeds_[below_ - 1]) / (depths_[below_] - depths_[below_ - 1]) : 0;
    }
    bool descends() const { return rapidity_ < 0 || (rapidity_ == 0 && gradient() < 0); }

    /** Returns the magnitude of the rapidity with which the ray passes a depth of a speed; -1 when it turns before. */
    double rapidityAt(double speed) const {
        const double cosh = 1 / (slowness_ * speed);
        return cosh >= 1 ? std::acosh(cosh) : -1;
    }

    double timeToBoundary() {
        leaves_down_ = descends();
        const double g = gradient();
        if (g == 0) return timeStraight();
        // In faster water the ray may turn before the boundary; then it leaves the layer by the other boundary.
        const size_t faster = g > 0 ? below_ : below_ - 1, slower = g > 0 ? below_ - 1 : below_;
        const bool into_faster = leaves_down_ == (g > 0);
        const double reached = into_faster ? rapidityAt(speeds_[faster]) : -1;
        if (reached < 0) leaves_down_ = g < 0;
        const double at = reached >= 0 ? reached : std::max(0.0, rapidityAt(speeds_[slower]));
        return std::max(0.0, ((leaves_down_ ? -at : at) - rapidity_) / g);
    }

    double timeStraight() const {
        const double climb = std::tanh(rapidity_) / (slowness_ * std::cosh(rapidity_));
        if (climb < 0 && below_ < depths_.size()) return std::max(0.0, (depth_ - depths_[below_]) / climb);
        if (climb > 0 && below_ > 0) return std::max(0.0, (depth_ - depths_[below_ - 1]) / climb);
        return infinity;
    }

    void move(double seconds) {
        const double g = gradient(), before = rapidity_, cosh = std::cosh(before);
        if (g == 0) {
            across_ += seconds / (slowness_ * cosh * cosh);
            depth_ -= seconds * std::tanh(before) / (slowness_ * cosh);
            return;
        }
        rapidity_ += g * seconds;
        const double per = 1 / (slowness_ * g * cosh * std::cosh(rapidity_));
        across_ += std::sinh(g * seconds) * per;
        depth_ -= 2 * std::sinh((rapidity_ + before) / 2) * std::sinh(g * seconds / 2) * per;
    }

    void cross() {
        depth_ = leaves_down_ ? depths_[below_] : depths_[below_ - 1];
        below_ += leaves_down_ ? 1 : size_t(-1);
    }

    const std::vector<double>&depths_, &speeds_;
    double across_ = 0, depth_, rapidity_ = 0, slowness_ = 0;
    size_t below_;              ///< Index of the first depth below the ray's layer; depths_.size() when there is none.
    bool leaves_down_ = false;  ///< Whether the ray leaves its layer by the lower boundary.
};

}  // namespace

double leroySpeed(const Water& water) {
    const double t = water.temperature_celsius, s = water.salinity_psu, z = water.depth;
    return 1402.5 + 5 * t - 5.44e-2 * t * t + 2.1e-4 * t * t * t + 1.33 * s - 1.23e-2 * s * t + 8.7e-5 * s * t * t +
           1.56e-2 * z + 2.55e-7 * z * z - 7.3e-12 * z * z * z + 1.2e-6 * z * (std::abs(water.latitude_deg) - 45) -
           9.5e-13 * t * z * z * z + 3e-7 * t * t * z + 1.43e-5 * s * z;
}

double mackenzieSpeed(const Water& water) {
    const double t = water.temperature_celsius, s = water.salinity_psu - 35, z = water.depth;
    return 1448.96 + 4.591 * t - 5.304e-2 * t * t + 2.374e-4 * t * t * t + 1.340 * s + 1.630e-2 * z + 1.675e-7 * z * z -
           1.025e-2 * t * s - 7.139e-13 * t * z * z * z;
}

double medwinSpeed(const Water& water) {
    const double t = water.temperature_celsius, s = water.salinity_psu - 35, z = water.depth;
    return 1449.2 + 4.6 * t - 5.5e-2 * t * t + 2.9e-4 * t * t * t + (1.34 - 1e-2 * t) * s + 1.6e-2 * z;
}

double coppensSpeed(const Water& water) {
    const double t = water.temperature_celsius / 10, s = water.salinity_psu - 35, z_km = water.depth / 1000;
    return 1449.05 + 45.7 * t - 5.21 * t * t + 0.23 * t * t * t + (1.333 - 0.126 * t + 0.009 * t * t) * s +
           (16.23 + 0.253 * t) * z_km + (0.213 - 0.1 * t) * z_km * z_km + (0.016 + 0.0002 * s) * s * t * z_km;
}

double chenMilleroSpeed(double t, double psu, double bar) {
    const double c[] = {polynomial(c0, t), polynomial(c1, t), polynomial(c2, t), polynomial(c3, t)};
    const double a[] = {polynomial(a0, t), polynomial(a1, t), polynomial(a2, t), polynomial(a3, t)};
    const double b[] = {polynomial(b0, t), polynomial(b1, t)};
    return polynomial(c, bar) + polynomial(a, bar) * psu + polynomial(b, bar) * psu * std::sqrt(psu) +
           polynomial(d, bar) * psu * psu;
}

double chenMilleroSpeed(const Water& water) {
    return chenMilleroSpeed(celsius68(water.temperature_celsius), water.salinity_psu,
                            gaugePressureBar(water.depth, water.latitude_deg));
}

double delGrossoSpeed(double celsius_68, double psu, double kg_per_cm2) {
    double sum = 0;
    for (const Term& term : del_grosso)
        sum += term.coefficient * power(celsius_68, term.t) * power(psu, term.s) * power(kg_per_cm2, term.p);
    return sum;
}

double delGrossoSpeed(const Water& water) {
    return delGrossoSpeed(celsius68(water.temperature_celsius), water.salinity_psu,
                          kg_per_cm2_per_bar * gaugePressureBar(water.depth, water.latitude_deg));
}

double soundSpeed(SoundSpeedLaw law, const Water& water) {
    switch (law) {
        case SoundSpeedLaw::Leroy: return leroySpeed(water);
        case SoundSpeedLaw::Mackenzie: return mackenzieSpeed(water);
        case SoundSpeedLaw::Medwin: return medwinSpeed(water);
        case SoundSpeedLaw::Coppens: return coppensSpeed(water);
        case SoundSpeedLaw::ChenMillero: return chenMilleroSpeed(water);
        case SoundSpeedLaw::DelGrosso: return delGrossoSpeed(water);
    }
    return leroySpeed(water);
}

double soundSpeed(const Water& water) { return soundSpeed(water.sound_speed_law, water); }

std::string outsideValidity(SoundSpeedLaw law, const Water& water) {
    const Range& range = ranges[static_cast<size_t>(law)];
    return outside({{"degC", water.temperature_celsius, range.celsius_min, range.celsius_max},
                    {"psu", water.salinity_psu, range.psu_min, range.psu_max},
                    {"m depth", water.depth, 0, range.depth_max}});
}

double gaugePressureBar(double z, double latitude_deg) {
    const double sine = std::sin(latitude_deg * std::numbers::pi / 180);
    const double gravity = 9.7803 * (1 + 5.3e-3 * sine * sine);
    const double of_latitude = (gravity - 2e-5 * z) / (9.80612 - 2e-5 * z);
    const double at_45 = 1.00818e-2 * z + 2.465e-8 * z * z - 1.25e-13 * z * z * z + 2.8e-19 * z * z * z * z;
    const double common_oceans = 1e-2 * z / (z + 100) + 6.2e-6 * z;
    return 10 * (at_45 * of_latitude - common_oceans);  // the formula is in MPa
}

double celsius68(double celsius_90) { return 1.00024 * celsius_90; }

SoundProfile SoundProfile::read(const std::string& file) {
    return SoundProfile(readCurve(file, {"depth_m", 0, 12000}, {"sound_speed_m_s", 100, 20000}));
}

double SoundProfile::slowest() const { return *std::ranges::min_element(speeds_.y); }
double SoundProfile::fastest() const { return *std::ranges::max_element(speeds_.y); }

double SoundProfile::steepest() const {
    double maximum = 0;
    for (size_t i = 1; i < speeds_.x.size(); ++i)
        maximum = std::max(maximum, std::abs((speeds_.y[i] - speeds_.y[i - 1]) / (speeds_.x[i] - speeds_.x[i - 1])));
    return maximum;
}

void traceRay(const SoundProfile& profile, double depth, double elevation, std::span<const double> times,
              std::span<RayPoint> points) {
    Ray ray(profile, depth, elevation);
    double now = 0;
    for (size_t i = 0; i < times.size(); ++i) {
        ray.advance(times[i] - now);
        now = times[i];
        points[i] = ray.point();
    }
}

std::string outside(std::initializer_list<Limit> limits) {
    std::string text;
    for (const Limit& limit : limits)
        if (!(limit.value >= limit.min && limit.value <= limit.max))
            text += fmt::format("{}{:.6g} {} ({:g} to {:g})", text.empty() ? "" : ", ", limit.value, limit.unit,
                                limit.min, limit.max);
    return text;
}

}  // namespace insonify::acoustics
