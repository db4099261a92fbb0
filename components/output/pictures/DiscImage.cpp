#include "components/output/pictures/DiscImage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace insonify::output {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;
constexpr double sector_width = full_turn / DiscImage::sectors;
constexpr int sub_pixel_bits = 4;

/** Returns the centre of a sector, counted from astern over starboard, ahead and port to astern again [rad]. */
double bearingOf(uint32_t sector) { return (sector + 0.5) * sector_width - std::numbers::pi; }

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
    for (uint32_t sector = 0; sector < sectors; ++sector) disc_.bearings[sector].rad = bearingOf(sector);
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
