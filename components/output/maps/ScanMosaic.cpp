#include "components/output/maps/ScanMosaic.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace insonify::output {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double farthest = 1e9;  ///< [m]
constexpr double edge_on = 0.02;  ///< Min share of the sonar's plane seen from above; below it no ping is shown.

/** Returns the axes of the sonar's plane as seen from above. */
glm::dmat2 makePlane(const types::Pose& sonar) { return glm::dmat2(glm::mat3_cast(glm::normalize(sonar.orientation))); }

glm::dvec2 towards(double bearing) { return {std::cos(bearing), std::sin(bearing)}; }

const std::string disc_caption = "as the head receives it, ahead up";

DisplayConfig halved(DisplayConfig config) {
    config.width /= 2;
    return config;
}

}  // namespace

ScanMap::ScanMap(int radius, double range) : radius_(radius), range_(range), cell_(range / radius) {
    cells_.create(2 * radius + 1, 2 * radius + 1, CV_32F);
    cells_.setTo(std::numeric_limits<float>::quiet_NaN());
    cells_.copyTo(scratch_);
}

cv::Point2d ScanMap::findCell(const glm::dvec2& place) const {
    return {radius_ - (place.y - middle_.y) / cell_, radius_ - (place.x - middle_.x) / cell_};
}

bool ScanMap::shows(const types::Pose& sonar) {
    return types::isUsable(sonar) && glm::length(sonar.position) <= farthest &&
           std::abs(glm::determinant(makePlane(sonar))) >= edge_on;
}

void ScanMap::lay(const types::Sonar& ping, const types::Pose& sonar) {
    world_from_plane_ = makePlane(sonar);
    sonar_ = sonar.position;
    moveTo(sonar_);
    arc_.take(ping);
    if (ping.bin_count == 0) return;
    for (size_t place = 0; place < arc_.beams.size(); ++place) {
        const double bearing = arc_.bearings[place];
        layBeam(&ping.bins[size_t{arc_.beams[place]} * ping.bin_count], ping.bin_count, bearing,
                arc_.within(place, halfWidth(ping, bearing)));
    }
}

/** Moves the map and keeps the cells that stay within it. */
void ScanMap::moveTo(const glm::dvec2& place) {
    const glm::dvec2 steps = glm::round((place - middle_) / cell_);  // north, west
    if (steps == glm::dvec2(0)) return;
    middle_ += steps * cell_;
    const int side = cells_.cols;
    scratch_.setTo(std::numeric_limits<float>::quiet_NaN());
    if (std::max(std::abs(steps.x), std::abs(steps.y)) < side) {
        const int down = static_cast<int>(steps.x), right = static_cast<int>(steps.y);
        const cv::Size kept(side - std::abs(right), side - std::abs(down));
        const cv::Rect from({std::max(0, -right), std::max(0, -down)}, kept);
        const cv::Rect to({std::max(0, right), std::max(0, down)}, kept);
        cells_(from).copyTo(scratch_(to));
    }
    cv::swap(cells_, scratch_);
}

double ScanMap::halfWidth(const types::Sonar& ping, double bearing) {
    const double width = ping.beam_width.rad > 0 ? ping.beam_width.rad : 0;
    if (ping.beam_count > 1) return width / 2;
    const glm::dvec2 axis = world_from_plane_ * towards(bearing);
    const double heading = std::atan2(axis.y, axis.x);
    const double turn = heading_ ? std::abs(std::remainder(heading - *heading_, 2 * pi)) : width;
    heading_ = heading;
    return std::min({width, turn, pi}) / 2;
}

cv::Rect ScanMap::reach(double bearing, double half_width) const {
    const cv::Point2d origin = findCell(sonar_);
    cv::Point2d low = origin, high = origin;
    const int steps = 1 + static_cast<int>(2 * half_width / 0.1);
    for (int i = 0; i <= steps; ++i) {
        const double angle = bearing + half_width * (2.0 * i / steps - 1);
        const cv::Point2d end = findCell(sonar_ + world_from_plane_ * towards(angle) * range_);
        low = {std::min(low.x, end.x), std::min(low.y, end.y)};
        high = {std::max(high.x, end.x), std::max(high.y, end.y)};
    }
    const double bulge = 2 + 0.002 * radius_;  // height of an arc of 0.1 rad above its chord
    const cv::Rect box(cv::Point(cvFloor(low.x - bulge), cvFloor(low.y - bulge)),
                       cv::Point(cvCeil(high.x + bulge) + 1, cvCeil(high.y + bulge) + 1));
    return box & cv::Rect({}, cells_.size());
}

void ScanMap::layBeam(const float* bins, uint32_t bin_count, double bearing, const types::BeamArc::Reach& part) {
    const int columns = std::min(static_cast<int>(bin_count), radius_);
    const cv::Mat all(1, static_cast<int>(bin_count), CV_32F, const_cast<float*>(bins));
    cv::resize(all, echo_, {columns, 1}, 0, 0, cv::INTER_AREA);
    const float* echo = echo_.ptr<float>();

    const glm::dmat2 plane_from_world = glm::inverse(world_from_plane_);
    const glm::dvec2 axis = towards(bearing);
    const double to_right = std::tan(std::min(part.right, 0.49 * pi));
    const double to_left = std::tan(std::min(part.left, 0.49 * pi));
    const cv::Rect box = reach(bearing, std::max(part.right, part.left));
    for (int row = box.y; row < box.y + box.height; ++row)
        for (int column = box.x; column < box.x + box.width; ++column) {
            const glm::dvec2 place = middle_ + glm::dvec2(radius_ - row, radius_ - column) * cell_;
            const glm::dvec2 at = plane_from_world * (place - sonar_);
            const double along = glm::dot(at, axis), port = axis.x * at.y - axis.y * at.x;
            const double range = glm::length(at), slope = port > 0 ? to_left : to_right;
            if (along < 0 || range >= range_ || std::abs(port) > std::max(along * slope, cell_ / 2)) continue;
            const double position = std::clamp(range / range_ * columns - 0.5, 0.0, columns - 1.0);
            const int before = static_cast<int>(position), after = std::min(before + 1, columns - 1);
            const float share = static_cast<float>(position - before);
            cells_.at<float>(row, column) = echo[before] + share * (echo[after] - echo[before]);
        }
}

ScanMosaic::ScanMosaic(const DisplayConfig& config)
    : half_(halved(config)), disc_(half_), palette_(getPalette(config.colour_map)), scale_(config) {}

bool ScanMosaic::place(const std::optional<types::Pose>& sonar) {
    sonar_ = sonar && ScanMap::shows(*sonar) ? sonar : std::nullopt;
    return sonar_.has_value() == sonar.has_value();
}

void ScanMosaic::skip(const types::Sonar& ping) {
    disc_.skip(ping);
    lay(ping);
}

void ScanMosaic::paint(const types::Sonar& ping, types::Image& picture) {
    lay(ping);
    disc_.paint(ping, disc_picture_);
    drawMap(ping);
    sideBySide({disc_picture_, disc_caption}, {map_picture_, caption_}, picture);
}

void ScanMosaic::lay(const types::Sonar& ping) {
    const bool fits = map_ && bin_count_ == ping.bin_count && range_ == ping.binStart(ping.bin_count);
    if (!fits) build(ping);
    if (sonar_) map_->lay(ping, *sonar_);
}

void ScanMosaic::build(const types::Sonar& ping) {
    bin_count_ = ping.bin_count;
    range_ = ping.binStart(ping.bin_count);
    const double range = range_ > 0 ? range_ : 1;
    layout_.emplace(static_cast<int>(half_.width), -std::numbers::pi, std::numbers::pi, range);
    map_.emplace(static_cast<int>(layout_->radius()), range);
    ground_.create(layout_->size(), CV_8UC3);
    const cv::Point bar = placeOfBar(*layout_, half_);
    paintBackground(ground_, palette_, bar);
    overlay_.emplace(fanOverlay(*layout_, bar, half_));
}

cv::Point2d ScanMosaic::pixel(const glm::dvec2& place) const {
    const cv::Point2d cell = map_->findCell(place);
    const double edge = layout_->radius();
    return layout_->origin() + cell - cv::Point2d(edge, edge) + cv::Point2d(layout_->size().width, 0);
}

void ScanMosaic::drawMap(const types::Sonar& ping) {
    cv::Mat canvas = openCanvas(map_picture_, layout_->size(), ping.time);
    ground_.copyTo(canvas);
    const cv::Mat& cells = map_->cells();
    scale_.apply(cells, levels_);
    const cv::Point corner(cvRound(layout_->origin().x - layout_->radius()),
                           cvRound(layout_->origin().y - layout_->radius()));
    for (int row = 0; row < cells.rows; ++row)
        for (int column = 0; column < cells.cols; ++column)
            if (!std::isnan(cells.at<float>(row, column)))
                canvas.at<cv::Vec3b>(corner.y + row, corner.x + column) = palette_[levels_.at<uint8_t>(row, column)];
    overlay_->blend(canvas);
    title_.draw(canvas, ping, scale_);
}

}  // namespace insonify::output
