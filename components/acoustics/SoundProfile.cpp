#include "components/acoustics/SoundProfile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace insonify::acoustics {
namespace {

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

SoundProfile SoundProfile::read(const std::string& file) {
    return SoundProfile(readCurve(file, {"depth_m", 0, 12000}, {"sound_speed_m_s", 1, 20000}));
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

}  // namespace insonify::acoustics
