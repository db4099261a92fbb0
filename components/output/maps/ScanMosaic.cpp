#include "components/output/maps/ScanMosaic.hpp"

#include <cmath>
#include <numbers>

namespace insonify::output {
namespace {

const std::string disc_caption = "as the head receives it, ahead up";

DisplayConfig halved(DisplayConfig config) {
    config.width /= 2;
    return config;
}

}  // namespace

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
