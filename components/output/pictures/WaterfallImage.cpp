#include "components/output/pictures/WaterfallImage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "components/output/pictures/FanShape.hpp"

namespace insonify::output {
namespace {

constexpr int left_margin = 78, top_margin = 10, bottom_margin = 34, beside_bar = 10;

}  // namespace

WaterfallImage::WaterfallImage(const DisplayConfig& config)
    : config_(config),
      width_(static_cast<int>(config.width + config.width % 2)),
      bar_(width_ - labelledBar({}, config).width - 4, FanLayout::title_height + top_margin + 6),
      palette_(getPalette(config.colour_map)),
      scale_(config) {}

cv::Rect WaterfallImage::water() const {
    return {left_margin, FanLayout::title_height + top_margin, bar_.x - beside_bar - left_margin, history};
}

void WaterfallImage::paint(const types::Sonar& ping, types::Image& picture) {
    skip(ping);
    cv::Mat canvas = openCanvas(picture, ground_.size(), ping.time);
    ground_.copyTo(canvas);
    scale_.apply(rows_, levels_);
    for (int row = 0; row < filled_; ++row)
        std::transform(levels_.ptr(row), levels_.ptr(row) + levels_.cols,
                       canvas.ptr<cv::Vec3b>(row + water().y) + water().x,
                       [this](uint8_t level) { return palette_[level]; });
    overlay_->blend(canvas);
    labelAges(canvas);
    title_.draw(canvas, ping, scale_);
}

void WaterfallImage::skip(const types::Sonar& ping) {
    if (!overlay_ || bin_count_ != ping.bin_count || range_ != ping.binStart(ping.bin_count)) clear(ping);
    if (ping.beam_count > 0 && ping.bin_count > 0) addRow(ping);
}

void WaterfallImage::clear(const types::Sonar& ping) {
    bin_count_ = ping.bin_count;
    range_ = ping.binStart(ping.bin_count);
    filled_ = 0;
    rows_.create(history, water().width, CV_32F);
    rows_ = std::numeric_limits<float>::quiet_NaN();
    ground_.create(water().br().y + bottom_margin, width_, CV_8UC3);
    paintBackground(ground_, palette_, bar_);
    overlay_.emplace(ground_.size());
    addColourBar(*overlay_, bar_, config_);
    addRanges(*overlay_, range_ > 0 ? range_ : 1);
    overlay_->finish();
}

void WaterfallImage::addRanges(Overlay& overlay, double range) const {
    const double metres_per_pixel = range / water().width;
    const double step = roundStep(80 * metres_per_pixel, range);
    for (double at = 0; at <= range * (1 + 1e-9); at += step) {
        const double x = water().x + at / metres_per_pixel, y = water().br().y;
        overlay.line({x, y}, {x, y + 5}, 235);
        overlay.text(fmt::format("{:g} m", at), {x, y + 16}, Overlay::Anchor::Centre);
    }
    nameAxis(overlay, "range");
}

void WaterfallImage::nameAxis(Overlay& overlay, const std::string& name) const {
    overlay.text(name, {8, water().br().y + 16.0}, Overlay::Anchor::Left);
}

void WaterfallImage::fillRow(const types::Sonar& ping, cv::Mat& row) {
    const cv::Mat bins(static_cast<int>(ping.beam_count), static_cast<int>(ping.bin_count), CV_32F,
                       const_cast<float*>(ping.bins.data()));
    cv::reduce(bins, mean_, 0, cv::REDUCE_AVG);
    const int shrinks = mean_.cols > row.cols ? cv::INTER_AREA : cv::INTER_LINEAR;
    cv::resize(mean_, row, row.size(), 0, 0, shrinks);
}

void WaterfallImage::addRow(const types::Sonar& ping) {
    std::memmove(rows_.ptr(1), rows_.ptr(0), rows_.step * (history - 1));
    cv::Mat newest = rows_.row(0);
    fillRow(ping, newest);
    std::copy_backward(times_.begin(), times_.end() - 1, times_.end());
    times_[0] = ping.time;
    filled_ = std::min(filled_ + 1, history);
}

void WaterfallImage::labelAges(cv::Mat& canvas) {
    for (int row = 0; row < filled_; row += 60) {
        text_.clear();
        const double age = (times_[static_cast<size_t>(row)] - times_[0]).seconds();
        const auto out = std::back_inserter(text_);
        if (age > -900)
            fmt::format_to(out, "{:.1f} s", age);
        else if (age > -360000)
            fmt::format_to(out, "{:.2f} h", age / 3600);
        else
            fmt::format_to(out, "{:.1f} d", age / 86400);
        cv::putText(canvas, text_, {8, water().y + row + 6}, cv::FONT_HERSHEY_SIMPLEX, 0.42, cv::Scalar(ink), 1,
                    cv::LINE_AA);
    }
}

}  // namespace insonify::output
