#include "components/output/pictures/TruthImage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace insonify::output {
namespace {

const std::string fan_caption = "echoes", truth_caption = "objects; dark blue: in shadow";
constexpr int line_height = 15, swatch = 10, margin = 12, legend_width = 132;
constexpr double dimmest = 0.35;  ///< Brightness of an object whose echo is below the dynamic range.

DisplayConfig halved(DisplayConfig config) {
    config.width /= 2;
    return config;
}

/** Returns red, green or blue of a hue in turns, at full saturation. */
double component(double hue, double offset) {
    const double turn = std::fmod(hue + offset, 1.0);
    return std::clamp(std::abs(6 * turn - 3) - 1, 0.0, 1.0);
}

uint8_t brightest(const cv::Vec3b& pixel) { return std::max({pixel[0], pixel[1], pixel[2]}); }

}  // namespace

cv::Vec3b TruthImage::getColour(int32_t object) {
    constexpr double golden = 0.6180339887498949;  // hues of neighbouring numbers differ strongly, and none repeats
    const double hue = std::fmod(0.08 + golden * object, 1.0), pale = object % 3 == 2 ? 0.45 : 0.12;
    const auto level = [&](double offset) {
        return static_cast<uint8_t>(255 * (pale + (1 - pale) * component(hue, offset)));
    };
    return {level(1.0 / 3), level(2.0 / 3), level(0)};
}

TruthImage::TruthImage(const DisplayConfig& config) : fan_(halved(config)) {}

void TruthImage::paint(const types::Sonar& ping, types::Image& picture) {
    if (truth_->beam_count != ping.beam_count || truth_->bin_count != ping.bin_count)
        throw std::runtime_error(
            fmt::format("a ping of {} x {} bins does not fit a truth of {} x {}: they are not of the "
                        "same sonar",
                        ping.beam_count, ping.bin_count, truth_->beam_count, truth_->bin_count));
    fan_.paint(ping, fan_picture_);
    if (tables_ != fan_.tablesBuilt()) build(ping);
    const cv::Mat fan(layout().size(), CV_8UC3, fan_picture_.image.data());
    cv::Mat canvas = openCanvas(truth_picture_, fan.size(), ping.time);
    colour(fan, canvas);
    count();
    addLegend(canvas);
    sideBySide({fan_picture_, fan_caption}, {truth_picture_, truth_caption}, picture);
}

void TruthImage::build(const types::Sonar& ping) {
    tables_ = fan_.tablesBuilt();
    const FanShape shape = FanShape::of(ping);
    const cv::Point2d origin = layout().origin();
    bin_of_.create(layout().size(), CV_32S);
    bin_of_.setTo(-1);
    if (shape.beams.empty() || shape.bin_count == 0) return;
    for (int y = 0; y < bin_of_.rows; ++y)
        for (int x = 0; x < bin_of_.cols; ++x) {
            const double ahead = origin.y - y, port = origin.x - x;
            const double bearing = std::atan2(port, ahead);
            const auto bin = static_cast<uint32_t>(std::hypot(ahead, port) / layout().radius() * shape.bin_count);
            if (bin >= shape.bin_count) continue;
            if (const auto beam = shape.beamAt(bearing))
                bin_of_.at<int32_t>(y, x) = static_cast<int32_t>(*beam * shape.bin_count + bin);
        }
}

cv::Vec3b TruthImage::colourAt(size_t bin, const cv::Vec3b& echo) const {
    if (truth_->shadow[bin]) return {static_cast<uint8_t>(std::max<int>(echo[0], shadow_blue)), echo[1], echo[2]};
    const int32_t object = truth_->object[bin];
    if (object == types::SonarTruth::no_object) return echo;
    const double brightness = dimmest + (1 - dimmest) * brightest(echo) / 255.0;
    return getColour(object) * brightness;
}

void TruthImage::colour(const cv::Mat& fan, cv::Mat& canvas) const {
    for (int y = 0; y < canvas.rows; ++y) {
        const auto* echoes = fan.ptr<cv::Vec3b>(y);
        const auto* bins = bin_of_.ptr<int32_t>(y);
        auto* pixels = canvas.ptr<cv::Vec3b>(y);
        for (int x = 0; x < canvas.cols; ++x)
            pixels[x] = bins[x] < 0 ? echoes[x] : colourAt(static_cast<size_t>(bins[x]), echoes[x]);
    }
}

void TruthImage::count() {
    bins_of_.assign(truth_->objects.size(), 0);
    for (const int32_t object : truth_->object)
        if (object != types::SonarTruth::no_object) ++bins_of_[static_cast<size_t>(object)];
    shown_.clear();
    for (size_t i = 0; i < bins_of_.size(); ++i)
        if (bins_of_[i] > 0) shown_.push_back({static_cast<int32_t>(i), bins_of_[i]});
    std::ranges::sort(shown_, [](const Shown& a, const Shown& b) {
        return a.bins != b.bins ? a.bins > b.bins : a.object < b.object;
    });
}

int TruthImage::legendEnd(const cv::Mat& canvas) const {
    const double aside = layout().origin().x - legend_width, radius = layout().radius();
    const double widest = radius * std::sin(std::min(layout().left(), std::numbers::pi / 2));
    int end = canvas.rows - line_height;
    if (aside <= widest)
        end = static_cast<int>(layout().origin().y - std::sqrt(radius * radius - aside * aside)) - line_height / 2;
    for (const cv::Rect& label : fan_.overlay().taken())
        if (label.x < legend_width && label.y >= FanLayout::title_height && (label & fan_.bar()) != label)
            end = std::min(end, label.y);
    return end;
}

void TruthImage::addLegend(cv::Mat& canvas) const {
    constexpr int top = FanLayout::title_height + margin;
    const int end = legendEnd(canvas);
    const auto room = static_cast<size_t>(std::max(0, (end - top) / line_height));
    const bool all = shown_.size() <= room;
    const size_t count = all ? shown_.size() : room - std::min<size_t>(room, 1);
    canvas(fan_.bar()).setTo(background);
    int row = top;
    for (size_t i = 0; i < count; ++i, row += line_height)
        addLine(canvas, row, truth_->objects[static_cast<size_t>(shown_[i].object)], getColour(shown_[i].object));
    if (!all && room > 0) addLine(canvas, row, fmt::format("and {} more", shown_.size() - count), {90, 90, 90});
}

void TruthImage::addLine(cv::Mat& canvas, int row, const std::string& text, const cv::Vec3b& colour) const {
    cv::rectangle(canvas, cv::Rect(margin, row, swatch, swatch), cv::Scalar(colour), cv::FILLED);
    putLabel(canvas, text, {margin + swatch + 7, row + swatch - 1}, legend_width - margin - swatch - 8);
}

}  // namespace insonify::output
