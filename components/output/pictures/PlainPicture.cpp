#include "components/output/pictures/PlainPicture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "components/output/pictures/LevelScale.hpp"
#include "types/geometry/BeamArc.hpp"

namespace insonify::output {
namespace {

constexpr double quarter_turn = std::numbers::pi / 2;

/** Returns width and height of the picture of a fan of unit radius, as {half the width, height behind the sonar}. */
std::pair<double, double> reach(const FanShape& shape) {
    const double half_angle = FanShape::halfAngle(shape.right, shape.left, 1e-3);
    if (half_angle < quarter_turn) return {std::sin(half_angle), 0};
    return {1, -std::cos(half_angle)};
}

constexpr double nothing = -std::numeric_limits<double>::infinity();

/** Returns the level that 0.2 % of the finite levels exceed; 0 if there are none [dB]. In double precision, because
 *  processors' logarithms differ in the last bit. */
double strongLevel(std::vector<double> levels) {
    std::erase_if(levels, [](double level) { return !std::isfinite(level); });
    if (levels.empty()) return 0;
    const auto at = levels.begin() + static_cast<std::ptrdiff_t>(levels.size() - 1 - levels.size() / 500);
    std::nth_element(levels.begin(), at, levels.end());
    return *at;
}

bool isToPort(const types::Angle& bearing) { return bearing.rad >= 0; }

/** Returns the first of the lines that a ping contains one after the other. */
types::Sonar firstLine(const types::Sonar& ping) {
    types::Sonar line;
    static_cast<types::RangeBins&>(line) = ping;
    line.bin_count = ping.bin_count;
    line.beam_width = ping.beam_width;
    line.beam_count = ping.beam_count > 1 && isToPort(ping.bearings[0]) != isToPort(ping.bearings[1]) ? 2 : 1;
    line.bearings.assign(ping.bearings.begin(), ping.bearings.begin() + line.beam_count);
    return line;
}

/** Joins groups that touch across the ends of a ring: cells of the last row and of the first. `number_of` turns the
 *  numbers of groups into those of joined groups, which have no gaps. */
void joinEnds(const cv::Mat& numbers, std::vector<int32_t>& number_of) {
    const auto root = [&](int32_t group) {
        while (number_of[static_cast<size_t>(group)] != group) group = number_of[static_cast<size_t>(group)];
        return group;
    };
    const auto *first = numbers.ptr<int32_t>(0), *last = numbers.ptr<int32_t>(numbers.rows - 1);
    for (int cell = 0; cell < numbers.cols; ++cell)
        for (int other = std::max(0, cell - 1); other <= std::min(cell + 1, numbers.cols - 1); ++other) {
            if (first[cell] == 0 || last[other] == 0) continue;
            const int32_t a = root(first[cell]), b = root(last[other]);
            number_of[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
        }
    int32_t count = 0;
    for (size_t group = 0; group < number_of.size(); ++group) {
        const auto own = static_cast<int32_t>(group);
        number_of[group] = number_of[group] == own ? count++ : number_of[static_cast<size_t>(number_of[group])];
    }
}

}  // namespace

DisplayConfig PlainConfig::display() const {
    DisplayConfig display;
    display.dynamic_range_db = dynamic_range_db;
    display.reference_db = reference_db;
    display.scale = scale;
    display.code_bits = code_bits;
    return display;
}

void PlainPicture::take(const types::Sonar& ping) {
    if (!ping.wellShaped() || ping.bin_count == 0 || ping.beam_count == 0)
        throw std::runtime_error("a ping without bins, or whose lists do not match its counts, cannot be a picture");
    const bool is_waterfall = config_.shape == PlainShape::Waterfall;
    shape_ = FanShape::of(is_waterfall ? firstLine(ping) : ping);
    if (shape_.beams.empty()) throw std::runtime_error("a ping without known bearings cannot be a picture");
    time_ = ping.time;
    bins_per_cell_ = (ping.bin_count + config_.height - 1) / config_.height;
    cells_ = (ping.bin_count + bins_per_cell_ - 1) / bins_per_cell_;
    bearing_of_.assign(ping.bearings.size(), types::Angle{}.rad);
    if (is_waterfall)
        std::ranges::transform(ping.bearings, bearing_of_.begin(), &types::Angle::rad);
    else
        for (size_t i = 0; i < shape_.beams.size(); ++i) bearing_of_[shape_.beams[i]] = shape_.bearings[i];
    switch (config_.shape) {
        case PlainShape::Fan: buildFan(); break;
        case PlainShape::Polar: buildPolar(); break;
        case PlainShape::Waterfall: buildWaterfall(ping); break;
        case PlainShape::Range: throw std::runtime_error("a ping is not a range image");
    }
    findLevels(ping);
}

void PlainPicture::take(const types::DepthMap& map, double range_max) {
    if (const char* const diagnostic = map.diagnostic()) throw std::runtime_error(std::string("a map ") + diagnostic);
    time_ = map.time;
    shape_ = {};
    shape_.bearings.assign(map.horizontal_interval.rbegin(), map.horizontal_interval.rend());
    bins_per_cell_ = cells_ = 1;
    width_ = map.horizontal_size, height_ = map.vertical_size;
    reference_db_ = 0;
    bearing_of_.clear();
    levels_.clear();
    for (size_t cell = 0; cell < map.distances.size(); ++cell) {
        const auto distance = static_cast<double>(map.distances[cell]);
        bearing_of_.push_back(map.horizontal_interval[cell % width_]);
        levels_.push_back(std::isfinite(distance) ? static_cast<uint8_t>(std::lround(
                                                        255 - 254 * std::clamp(distance / range_max, 0.0, 1.0)))
                                                  : 0);
    }
    cell_of_.resize(map.distances.size());
    std::iota(cell_of_.begin(), cell_of_.end(), 0);
}

void PlainPicture::buildFan() {
    radius_ = config_.height;
    const auto [half_width, depth] = reach(shape_);
    width_ = 2 * static_cast<uint32_t>(std::ceil(radius_ * half_width));
    height_ = static_cast<uint32_t>(std::ceil(radius_ * (1 + depth)));
    origin_ = {width_ / 2.0 - 0.5, radius_ - 0.5};
    cell_of_.assign(size_t{width_} * height_, -1);
    places_.resize(config_.smooth ? cell_of_.size() : 0);
    for (uint32_t y = 0; y < height_; ++y)
        for (uint32_t x = 0; x < width_; ++x) {
            const double ahead = origin_.y - y, port = origin_.x - x;
            const double bearing = std::atan2(port, ahead);
            const double place = std::hypot(ahead, port) / radius_ * cells_;
            const auto cell = static_cast<uint32_t>(place);
            const size_t pixel = size_t{y} * width_ + x;
            if (cell >= cells_) continue;
            if (const auto beam = shape_.beamAt(bearing)) cell_of_[pixel] = static_cast<int32_t>(*beam * cells_ + cell);
            if (config_.smooth) places_[pixel] = {shape_.placeAt(bearing).value_or(0), place};
        }
}

void PlainPicture::buildPolar() {
    width_ = static_cast<uint32_t>(shape_.beams.size());
    height_ = cells_;
    column_of_.assign(bearing_of_.size(), 0);
    cell_of_.assign(size_t{width_} * height_, -1);
    for (uint32_t x = 0; x < width_; ++x) {
        const uint32_t beam = shape_.beams[width_ - 1 - x];
        column_of_[beam] = x;
        for (uint32_t y = 0; y < height_; ++y)
            cell_of_[size_t{y} * width_ + x] = static_cast<int32_t>(beam * cells_ + cells_ - 1 - y);
    }
}

void PlainPicture::buildWaterfall(const types::Sonar& ping) {
    line_of_.clear();
    bool has_side[2] = {}, is_there[2] = {};  // starboard, port; of all lines, of this line
    uint32_t lines = 1;
    for (const types::Angle& bearing : ping.bearings) {
        bool& side = is_there[isToPort(bearing)];
        if (side) ++lines, is_there[0] = is_there[1] = false;
        side = has_side[isToPort(bearing)] = true;
        line_of_.push_back(lines - 1);
    }
    port_cells_ = has_side[1] ? cells_ : 0;
    width_ = port_cells_ + (has_side[0] ? cells_ : 0);
    height_ = lines;
    cell_of_.assign(size_t{width_} * height_, -1);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        for (uint32_t cell = 0; cell < cells_; ++cell) {
            const cv::Point at = findPixel(beam, cell);
            cell_of_[static_cast<size_t>(at.y) * width_ + static_cast<size_t>(at.x)] =
                static_cast<int32_t>(beam * cells_ + cell);
        }
}

void PlainPicture::findLevels(const types::Sonar& ping) {
    const bool linear = config_.scale == BinScale::Linear, codes = config_.scale == BinScale::Code;
    std::vector<double> shown;
    shown.reserve(size_t{ping.beam_count} * cells_);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        for (uint32_t cell = 0; cell < cells_; ++cell) {
            const double mean = computeMean(ping, beam, cell);
            shown.push_back(!linear ? mean : mean > 0 ? 10 * std::log10(mean) : nothing);
        }
    reference_db_ = codes ? 0 : config_.reference_db.value_or(strongLevel(shown));
    const double step = codes ? 255 / config_.display().maxCode() : 255 / config_.dynamic_range_db;
    const double black = codes ? 0 : reference_db_ - config_.dynamic_range_db;
    levels_.clear();
    for (const double level : shown)  // unknown levels and no echo: 0
        levels_.push_back(level > black ? static_cast<uint8_t>(std::lround(std::min((level - black) * step, 255.0)))
                                        : 0);
}

double PlainPicture::computeMean(const types::Sonar& ping, uint32_t beam, uint32_t cell) const {
    const uint32_t first = cell * bins_per_cell_, last = std::min(first + bins_per_cell_, ping.bin_count);
    double sum = 0;
    for (uint32_t k = first; k < last; ++k) sum += static_cast<double>(ping.bins[size_t{beam} * ping.bin_count + k]);
    return sum / (last - first);
}

cv::Point PlainPicture::findPixel(uint32_t beam, uint32_t cell) const {
    if (config_.shape == PlainShape::Range) return {static_cast<int>(beam % width_), static_cast<int>(beam / width_)};
    if (config_.shape == PlainShape::Polar)
        return {static_cast<int>(column_of_[beam]), static_cast<int>(cells_ - 1 - cell)};
    if (config_.shape == PlainShape::Waterfall)
        return {static_cast<int>(bearing_of_[beam] >= 0 ? port_cells_ - 1 - cell : port_cells_ + cell),
                static_cast<int>(height_ - 1 - line_of_[beam])};
    const double distance = (cell + 0.5) / cells_ * radius_, bearing = bearing_of_[beam];
    const int x = static_cast<int>(std::lround(origin_.x - distance * std::sin(bearing)));
    const int y = static_cast<int>(std::lround(origin_.y - distance * std::cos(bearing)));
    return {std::clamp(x, 0, static_cast<int>(width_) - 1), std::clamp(y, 0, static_cast<int>(height_) - 1)};
}

std::vector<int32_t> PlainPicture::groupBy(const std::vector<uint8_t>& chosen) const {
    std::vector<uint32_t> order(bearing_of_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::erase_if(order, [&](uint32_t beam) { return std::isnan(bearing_of_[beam]); });
    std::ranges::stable_sort(order, {}, [&](uint32_t beam) { return bearing_of_[beam]; });
    std::vector<int32_t> groups(chosen.size(), 0);
    if (order.empty()) return groups;
    cv::Mat in_order(static_cast<int>(order.size()), static_cast<int>(cells_), CV_8U), numbers;
    for (size_t row = 0; row < order.size(); ++row)
        std::copy_n(&chosen[size_t{order[row]} * cells_], cells_, in_order.ptr<uint8_t>(static_cast<int>(row)));
    const int count = cv::connectedComponents(in_order, numbers);
    std::vector<int32_t> number_of(static_cast<size_t>(count));
    std::iota(number_of.begin(), number_of.end(), 0);
    if (config_.shape == PlainShape::Fan && shape_.isRing()) joinEnds(numbers, number_of);
    for (size_t row = 0; row < order.size(); ++row) {
        const auto* of_row = numbers.ptr<int32_t>(static_cast<int>(row));
        std::transform(of_row, of_row + cells_, &groups[size_t{order[row]} * cells_],
                       [&](int32_t number) { return number_of[static_cast<size_t>(number)]; });
    }
    return groups;
}

types::Image PlainPicture::image() const {
    types::Image picture;
    picture.time = time_;
    picture.frame_mode = types::ImageMode::Grayscale;
    picture.size = {static_cast<uint16_t>(width_), static_cast<uint16_t>(height_)};
    picture.pixel_size = 1;
    picture.row_size = width_;
    picture.frame_status = types::ImageStatus::Valid;
    picture.image.resize(cell_of_.size());
    std::ranges::transform(cell_of_, picture.image.begin(),
                           [this](int32_t cell) { return cell < 0 ? uint8_t{0} : levels_[static_cast<size_t>(cell)]; });
    if (!config_.smooth) return picture;
    for (size_t pixel = 0; pixel < cell_of_.size(); ++pixel)
        if (cell_of_[pixel] >= 0) picture.image[pixel] = interpolate(places_[pixel]);
    return picture;
}

uint8_t PlainPicture::interpolate(const cv::Point2d& at) const {
    const size_t count = shape_.beams.size();
    const double last_place = static_cast<double>(shape_.isRing() ? count : count - 1), last_cell = cells_ - 1.0;
    const double place = std::clamp(at.x, 0.0, last_place), cell = std::clamp(at.y - 0.5, 0.0, last_cell);
    const auto beam = static_cast<size_t>(place), near = static_cast<size_t>(cell);
    const double u = place - static_cast<double>(beam), v = cell - static_cast<double>(near);
    const auto level = [&](size_t number, size_t of_cell) {
        const size_t of_beam = shape_.beams[std::min(number, static_cast<size_t>(last_place)) % count];
        return static_cast<double>(levels_[of_beam * cells_ + std::min(of_cell, size_t{cells_} - 1)]);
    };
    return static_cast<uint8_t>(std::lround((1 - u) * ((1 - v) * level(beam, near) + v * level(beam, near + 1)) +
                                            u * ((1 - v) * level(beam + 1, near) + v * level(beam + 1, near + 1))));
}

namespace {

constexpr double white = 255;

/** Returns the levels of 8 bits as 64-bit floats; neighbouring rows are neighbouring beams. */
cv::Mat computeLevels(const types::Sonar& ping, LevelScale& scale) {
    const cv::Mat bins(static_cast<int>(ping.beam_count), static_cast<int>(ping.bin_count), CV_32F,
                       const_cast<float*>(ping.bins.data()));
    cv::Mat rows(0, bins.cols, CV_32F), levels;
    for (const uint32_t beam : types::BeamArc(ping).beams) rows.push_back(bins.row(static_cast<int>(beam)));
    scale.apply(rows.empty() ? bins : rows, levels);
    levels.convertTo(levels, CV_64F);
    return levels;
}

cv::Mat blurred(const cv::Mat& picture) {
    cv::Mat result;
    cv::GaussianBlur(picture, result, {11, 11}, 1.5);
    return result;
}

}  // namespace

double referenceLevel(const types::Sonar& ping, const DisplayConfig& display) {
    LevelScale scale(display);
    computeLevels(ping, scale);
    return scale.referenceDb();
}

double structuralSimilarity(const types::Sonar& reference, const types::Sonar& other, DisplayConfig display) {
    const double c1 = std::pow(0.01 * white, 2), c2 = std::pow(0.03 * white, 2);
    LevelScale scale(display);
    const cv::Mat x = computeLevels(reference, scale);
    display.reference_db = scale.referenceDb();
    LevelScale same_scale(display);
    const cv::Mat y = computeLevels(other, same_scale);
    const cv::Mat mean_x = blurred(x), mean_y = blurred(y);
    const cv::Mat means = mean_x.mul(mean_y), squares = mean_x.mul(mean_x) + mean_y.mul(mean_y);
    const cv::Mat covariance = blurred(x.mul(y)) - means;
    const cv::Mat variances = blurred(x.mul(x)) + blurred(y.mul(y)) - squares;
    const cv::Mat above = (2 * means + c1).mul(2 * covariance + c2), below = (squares + c1).mul(variances + c2);
    return cv::mean(above / below)[0];
}

}  // namespace insonify::output
