#include "components/output/pictures/FanImage.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace insonify::output {
namespace {

bool sameAngle(types::Angle a, types::Angle b) { return a.rad == b.rad || (a.isUnknown() && b.isUnknown()); }

}  // namespace

FanImage::FanImage(const DisplayConfig& config)
    : config_(config), palette_(getPalette(config.colour_map)), scale_(config) {}

void FanImage::paint(const types::Sonar& ping, types::Image& picture) {
    cv::Mat canvas = draw(ping, picture);
    title_.draw(canvas, ping, scale_);
}

cv::Mat FanImage::draw(const types::Sonar& ping, types::Image& picture) {
    if (!fits(ping)) build(ping);
    cv::Mat canvas = openCanvas(picture, layout_->size(), ping.time);
    paintBackground(canvas, palette_, bar_);
    if (!polar_.empty()) {
        gather(ping);
        scale_.apply(polar_, polar_levels_);
        cv::remap(polar_levels_, levels_, source_, fraction_, cv::INTER_LINEAR, cv::BORDER_WRAP);
        colour(canvas);
    }
    overlay_->blend(canvas);
    return canvas;
}

bool FanImage::fits(const types::Sonar& ping) const {
    return layout_ && shape_.bin_count == ping.bin_count && shape_.range == ping.binStart(ping.bin_count) &&
           sameAngle(types::Angle{beam_width_}, ping.beam_width) &&
           std::equal(bearings_.begin(), bearings_.end(), ping.bearings.begin(), ping.bearings.end(), sameAngle);
}

void FanImage::build(const types::Sonar& ping) {
    bearings_ = ping.bearings;
    beam_width_ = ping.beam_width.rad;
    shape_ = FanShape::of(ping);
    const double range = shape_.range > 0 ? shape_.range : 1;
    layout_.emplace(static_cast<int>(config_.width), shape_.right, shape_.left, range);
    const int again = shape_.fullCircle() ? 1 : 0;  // the first beam follows the last
    const int rows = static_cast<int>(shape_.bearings.size()) + again, bins = static_cast<int>(shape_.bin_count);
    columns_ = std::min(bins, std::max(1, static_cast<int>(layout_->radius())));
    bins_.create(rows, bins, CV_32F);
    polar_.create(rows, columns_, CV_32F);
    buildTables();
    buildOverlay();
    ++tables_built_;
}

void FanImage::buildTables() {
    const cv::Point2d origin = layout_->origin();
    const double cells_per_pixel = columns_ / layout_->radius();
    const cv::Size size = layout_->size();
    source_.create(size, CV_16SC2);
    fraction_.create(size, CV_16UC1);
    cv::Mat column(1, size.width, CV_32F), row(1, size.width, CV_32F);  // one row of pixels at a time: less memory
    spans_.clear();
    for (int y = 0; y < size.height; ++y) {
        column = cv::Scalar(0);
        row = cv::Scalar(0);
        for (int x = 0; x < size.width; ++x) {
            const double ahead = origin.y - y, port = origin.x - x;
            const double distance = std::hypot(ahead, port), bearing = std::atan2(port, ahead);
            if (distance >= layout_->radius()) continue;
            const std::optional<double> place = shape_.placeAt(bearing);
            if (!place) continue;
            if (spans_.empty() || spans_.back().row != y || spans_.back().end != x) spans_.push_back({y, x, x});
            spans_.back().end = x + 1;
            column.at<float>(0, x) =
                static_cast<float>(std::clamp(distance * cells_per_pixel - 0.5, 0.0, columns_ - 1.0));
            row.at<float>(0, x) = static_cast<float>(*place);
        }
        cv::Mat source = source_.row(y), fraction = fraction_.row(y);
        cv::convertMaps(column, row, source, fraction, CV_16SC2);
    }
}

void FanImage::buildOverlay() {
    bar_ = placeOfBar(*layout_, config_);
    labelled_bar_ = labelledBar(bar_, config_) & cv::Rect({}, layout_->size());
    overlay_.emplace(fanOverlay(*layout_, bar_, config_));
}

/** Gathers the ping's beams in order of bearing, in a full circle with the first one again at the end, with at most one
 * range cell per pixel. */
void FanImage::gather(const types::Sonar& ping) {
    const size_t count = shape_.bin_count;
    for (size_t row = 0; row < static_cast<size_t>(bins_.rows); ++row)
        std::memcpy(bins_.ptr(static_cast<int>(row)), &ping.bins[shape_.beams[row % shape_.beams.size()] * count],
                    count * sizeof(float));
    if (columns_ == bins_.cols)
        bins_.copyTo(polar_);
    else
        cv::resize(bins_, polar_, polar_.size(), 0, 0, cv::INTER_AREA);
}

void FanImage::colour(cv::Mat& canvas) const {
    for (const Span& span : spans_) {
        const uint8_t* levels = levels_.ptr<uint8_t>(span.row);
        std::transform(levels + span.begin, levels + span.end, canvas.ptr<cv::Vec3b>(span.row) + span.begin,
                       [this](uint8_t level) { return palette_[level]; });
    }
}

namespace {

constexpr double full_turn = 2 * std::numbers::pi;
constexpr double sector_width = full_turn / DiscImage::sectors;
constexpr int sub_pixel_bits = 4;

/** Returns the centre of a sector, counted from astern over starboard, ahead and port to astern again [rad]. */
double computeBearing(uint32_t sector) { return (sector + 0.5) * sector_width - std::numbers::pi; }

void drawHead(cv::Mat& canvas, const FanLayout& layout, double bearing) {
    const auto subPixel = [](cv::Point2d at) { return cv::Point(at * (1 << sub_pixel_bits)); };
    cv::line(canvas, subPixel(layout.origin()), subPixel(layout.pixel(layout.range(), bearing)), cv::Scalar(ink), 1,
             cv::LINE_AA, sub_pixel_bits);
}

}  // namespace

void DiscImage::paint(const types::Sonar& ping, types::Image& picture) {
    skip(ping);
    cv::Mat canvas = fan_.draw(disc_, picture);
    for (const double bearing : arc_.bearings) drawHead(canvas, fan_.layout(), bearing);
    title_.draw(canvas, ping, fan_.scale());
}

void DiscImage::skip(const types::Sonar& ping) {
    if (disc_.bin_count != ping.bin_count || !disc_.sameBins(ping) || disc_.bearings.empty()) clear(ping);
    disc_.time = ping.time;
    arc_.take(ping);
    for (size_t place = 0; place < arc_.beams.size(); ++place) overwrite(ping, place);
}

void DiscImage::clear(const types::Sonar& ping) {
    static_cast<types::RangeBins&>(disc_) = ping;
    disc_.bin_count = ping.bin_count;
    disc_.beam_count = sectors;
    disc_.beam_width.rad = sector_width;
    disc_.bearings.resize(sectors);
    for (uint32_t sector = 0; sector < sectors; ++sector) disc_.bearings[sector].rad = computeBearing(sector);
    disc_.bins.assign(size_t{sectors} * ping.bin_count, std::numeric_limits<float>::quiet_NaN());
}

/** Copies a beam to the sectors whose centre it covers, unless another beam of the ping is nearer. Always copies it to
 *  the sector that it points to. */
void DiscImage::overwrite(const types::Sonar& ping, size_t place) {
    const uint32_t beam = arc_.beams[place];
    const double half_width = ping.beam_width.rad > 0 ? std::min(ping.beam_width.rad, full_turn) / 2 : 0;
    const types::BeamArc::Reach part = arc_.within(place, half_width);
    const double position = (arc_.bearings[place] + std::numbers::pi) / sector_width;
    const int nearest = static_cast<int>(std::floor(position));
    const int first = std::min(nearest, static_cast<int>(std::ceil(position - part.right / sector_width - 0.5)));
    const int last = std::max(nearest, static_cast<int>(std::floor(position + part.left / sector_width - 0.5)));
    for (int sector = first; sector <= last; ++sector) {
        const size_t turned = static_cast<size_t>((sector + static_cast<int>(2 * sectors)) % static_cast<int>(sectors));
        std::copy_n(&ping.bins[size_t{beam} * ping.bin_count], ping.bin_count, &disc_.bins[turned * ping.bin_count]);
    }
}

}  // namespace insonify::output
