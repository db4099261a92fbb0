#include "components/study/fit/FitLooks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace insonify::study {
namespace {

constexpr double one_look = -0.15;    ///< T of one look is at least 0; rounding of codes lowers it by less than this.
constexpr double min_texture = 0.01;  ///< Min 1 / shape of the K law.
constexpr double min_width = 0.3, max_width = 16;  ///< Bounds of a filter's width [bins].

/** Returns the sum of the first three lags of a filter's correlation of intensities, exp(-(lag / width)^2). */
double correlationOf(double width) {
    double sum = 0;
    for (int lag = 1; lag <= 3; ++lag) sum += std::exp(-std::pow(lag / width, 2));
    return sum;
}

}  // namespace

bool AveragedSpeckle::isIn(const SpeckleMoments& recorded) {
    return recorded.texture.isKnown() && recorded.texture.value < one_look;
}

void AveragedSpeckle::begin(const SpeckleMoments& recorded) {
    recorded_ = recorded;
    take(1 + recorded.texture.value);
    bins_ = recorded.echo_bins.value;
    chain_.sonar.speckle.reset();
    apply();
}

void AveragedSpeckle::improve(const SpeckleMoments& recorded, const SpeckleMoments& simulated) {
    recorded_ = recorded;
    if (recorded.texture.isKnown() && simulated.texture.isKnown())
        take(1.0 / looks_ + inverse_ + recorded.texture.value - simulated.texture.value);
    if (recorded.echo_bins.isKnown() && simulated.echo_bins.isKnown())
        bins_ += recorded.echo_bins.value - simulated.echo_bins.value;
    apply();
}

void AveragedSpeckle::take(double both) {
    looks_ = std::clamp(static_cast<int>(std::ceil(1 / std::max(1e-3, both))), 2, 256);
    inverse_ = std::max(0.0, both - 1.0 / looks_);
}

void AveragedSpeckle::apply() {
    noise::SpeckleConfig& speckle = chain_.noise.speckle.emplace();
    if (inverse_ > min_texture) speckle.law = noise::SpeckleLaw::K, speckle.shape = std::clamp(1 / inverse_, 0.1, 1e6);
    noise::FilterConfig& filter = chain_.noise.filter.emplace();
    filter.looks = looks_;
    if (recorded_.echo_bins.isMoreThanChance() && bins_ > correlationOf(min_width))
        filter.correlation_bins = argumentAt(bins_, min_width, max_width, correlationOf);
}

bool AveragedSpeckle::isTextured() const {
    return recorded_.texture.isKnown() && inverse_ > min_texture && inverse_ > z_95 * recorded_.texture.error;
}

void AveragedSpeckle::addTo(std::vector<Finding>& findings) const {
    findings.push_back(
        {"beam width", "deg", {}, false, "the lines of a side-scan are apart, so they share no speckle"});
    findings.push_back({"pulse length",
                        "m",
                        {},
                        false,
                        "the device averages looks: what neighbouring bins share is its averaging, not the pulse"});
    const double both = 1 + recorded_.texture.value, off = z_95 * recorded_.texture.error;
    findings.push_back({"looks",
                        "1",
                        {static_cast<double>(looks_), std::ceil(1 / (both + off)), 1e9},
                        true,
                        "averaged in each bin: the min number that explains the small variation of intensities"});
    const Fitted shape{1 / inverse_, 1 / (inverse_ + off), inverse_ > off ? 1 / (inverse_ - off) : 1e9};
    findings.push_back({"shape of K", "1", shape, isTextured() && shape.half() <= 0.5 * shape.value,
                        isTextured() ? fmt::format("of the texture beneath these looks, at {:.3g} m", recorded_.range)
                                     : "looks alone explain the speckle within its error"});
    const auto& width = chain_.noise.filter->correlation_bins;
    const double slack = z_95 * recorded_.echo_bins.error;
    const auto at = [](double sum) {
        return argumentAt(std::max(sum, correlationOf(min_width)), min_width, max_width, correlationOf);
    };
    findings.push_back({"speckle over bins", "1",
                        width ? Fitted{*width, at(bins_ - slack), at(bins_ + slack)} : Fitted{}, width.has_value(),
                        width ? "where its correlation is 1/e" : "neighbouring bins share no more than chance"});
}

}  // namespace insonify::study
