#include "components/output/pictures/SideScanImage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "types/geometry/BeamArc.hpp"

namespace insonify::output {
namespace {

constexpr float blank = std::numeric_limits<float>::quiet_NaN();

/** Returns the bins of the first beam on a side, +1 for port; null if there is none. */
const float* getBins(const types::Sonar& ping, int side) {
    const auto beam = types::firstBeamOn(ping, side);
    return beam ? ping.bins.data() + size_t{*beam} * ping.bin_count : nullptr;
}

/** Returns the mean of the bins between two places, counted in bins; at least the bin at `from`. */
float computeMean(const float* bins, uint32_t count, double from, double to) {
    const auto first = static_cast<uint32_t>(std::clamp(from, 0.0, count - 1.0));
    const auto last = static_cast<uint32_t>(std::clamp(std::ceil(to), first + 1.0, static_cast<double>(count)));
    float sum = 0;
    for (uint32_t k = first; k < last; ++k) sum += bins[k];
    return sum / static_cast<float>(last - first);
}

}  // namespace

SideScanImage::SideScanImage(const SideScanPictureConfig& config)
    : WaterfallImage(config), ground_range_(config.ground_range), is_decibel_(config.scale == BinScale::Decibel) {}

double SideScanImage::computeAltitude(const types::Sonar& ping) {
    if (!ground_range_) return 0;
    if (ground_range_->altitude) return *ground_range_->altitude;
    if (std::isfinite(altitude_)) return altitude_;
    levels_.take(ping, ping.bin_count, returns_);
    const auto levelAt = [&](size_t i) {
        const float bin = is_decibel_ ? std::pow(10.0f, ping.bins[i] / 10) : ping.bins[i];
        return levels_.at(i % ping.bin_count, static_cast<double>(bin));
    };
    double strongest = 0;
    for (size_t i = 0; i < ping.bins.size(); ++i) strongest = std::max(strongest, levelAt(i));
    const double minimum = strongest * std::pow(10, ground_range_->threshold_db / 10);
    uint32_t first = ping.bin_count;
    for (size_t i = 0; strongest > 0 && i < ping.bins.size(); ++i)
        if (levelAt(i) >= minimum) first = std::min(first, static_cast<uint32_t>(i % ping.bin_count));
    return ping.binStart(first == ping.bin_count ? 0 : first + 0.5);
}

void SideScanImage::fillRow(const types::Sonar& ping, cv::Mat& row) {
    const double range = ping.binStart(ping.bin_count), bin = ping.binStart(1), altitude = computeAltitude(ping);
    const double half = row.cols / 2.0;
    for (int column = 0; column < row.cols; ++column) {
        const double offset = half - column - 0.5;  // positive to port
        const double from = (std::abs(offset) - 0.5) / half * range, to = (std::abs(offset) + 0.5) / half * range;
        const double r1 = std::hypot(from, altitude), r2 = std::hypot(to, altitude);
        const float* const bins = getBins(ping, offset > 0 ? 1 : -1);
        row.at<float>(column) = bins && r1 < range ? computeMean(bins, ping.bin_count, r1 / bin, r2 / bin) : blank;
    }
}

void SideScanImage::addRanges(Overlay& overlay, double range) const {
    const double per_pixel = 2 * range / water().width, step = roundStep(80 * per_pixel, range), y = water().br().y;
    const double middle = water().x + water().width / 2.0;
    for (double at = 0; at <= 0.97 * range; at += step)
        for (const int side : {-1, 1}) {
            const double x = middle + side * at / per_pixel;
            overlay.line({x, y}, {x, y + 5}, 235);
            if (at > 0 || side > 0)
                overlay.text(fmt::format("{:g} m{}", at, at > 0 ? (side < 0 ? " P" : " S") : ""), {x, y + 16},
                             Overlay::Anchor::Centre);
        }
    nameAxis(overlay, ground_range_ ? "ground range" : "slant range");
}

}  // namespace insonify::output
