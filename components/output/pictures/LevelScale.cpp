#include "components/output/pictures/LevelScale.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numbers>

namespace insonify::output {

void LevelScale::applyToCodes(const cv::Mat& bins, cv::Mat& levels) {
    bins.copyTo(decibels_);
    cv::patchNaNs(decibels_, 0);
    decibels_.convertTo(levels, CV_8U, 255 / config_.maxCode());
}

void LevelScale::apply(const cv::Mat& bins, cv::Mat& levels) {
    if (config_.scale == BinScale::Code) return applyToCodes(bins, levels);
    toDecibels(bins);
    if (config_.reference_db)
        reference_db_ = *config_.reference_db;
    else
        follow();
    const double steps_per_db = 255 / config_.dynamic_range_db;
    decibels_.convertTo(levels, CV_8U, steps_per_db, 255 - steps_per_db * reference_db_);
}

void LevelScale::toDecibels(const cv::Mat& bins) {
    bins.copyTo(decibels_);
    const bool linear = config_.scale == BinScale::Linear;
    cv::patchNaNs(decibels_, linear ? 0 : nothing_db);
    if (!linear) return;
    cv::max(decibels_, FLT_MIN, decibels_);
    cv::min(decibels_, FLT_MAX, decibels_);
    cv::log(decibels_, decibels_);
    decibels_ *= 10 / std::numbers::ln10;
}

void LevelScale::follow() {
    const double strong = strongLevel();
    if (std::isnan(strong)) return;
    reference_db_ = started_ ? reference_db_ + 0.1 * (strong - reference_db_) : strong;
    started_ = true;
}

/** Returns the level that 0.2 % of the bins with an echo exceed [dB]; NaN without echoes. */
double LevelScale::strongLevel() {
    constexpr float lowest = -379, highest = 385.5f;  // covers floats, and all levels in dB
    const float steps_per_db = static_cast<float>(histogram_.size() - 1) / (highest - lowest);
    histogram_.fill(0);
    size_t count = 0;
    for (int row = 0; row < decibels_.rows; ++row) {
        const float* level = decibels_.ptr<float>(row);
        for (int i = 0; i < decibels_.cols; ++i) {
            if (level[i] <= lowest) continue;
            ++histogram_[static_cast<size_t>((std::min(level[i], highest) - lowest) * steps_per_db)];
            ++count;
        }
    }
    if (count == 0) return std::nan("");
    size_t above = 0, step = histogram_.size();
    while (above <= count / 500) above += histogram_[--step];
    return lowest + (static_cast<double>(step) + 0.5) / steps_per_db;
}

}  // namespace insonify::output
