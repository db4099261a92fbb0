#include "components/output/pictures/Colours.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace insonify::output {
namespace {

struct Anchor {
    int level;
    cv::Vec3d bgr;
};

/** From black water over brown and orange to white, as in viewers of imaging sonars. */
const Anchor amber[] = {{0, {6, 5, 6}},        {40, {6, 22, 44}},      {96, {8, 62, 120}},    {150, {14, 118, 204}},
                        {200, {48, 180, 246}}, {235, {140, 226, 255}}, {255, {236, 252, 255}}};

const Anchor copper[] = {{0, {0, 0, 0}}, {203, {101, 159, 255}}, {255, {127, 199, 255}}};
const Anchor gray[] = {{0, {0, 0, 0}}, {255, {255, 255, 255}}};

Palette interpolated(const Anchor* anchor) {
    Palette palette;
    for (int level = 0; level < 256; ++level) {
        if (level > anchor[1].level) ++anchor;
        const double share = double(level - anchor[0].level) / (anchor[1].level - anchor[0].level);
        palette[static_cast<size_t>(level)] = cv::Vec3b(anchor[0].bgr * (1 - share) + anchor[1].bgr * share);
    }
    return palette;
}

Palette fromOpenCv(int map) {
    cv::Mat levels(1, 256, CV_8U), colours;
    for (int level = 0; level < 256; ++level) levels.at<uint8_t>(level) = static_cast<uint8_t>(level);
    cv::applyColorMap(levels, colours, map);
    Palette palette;
    std::copy_n(colours.ptr<cv::Vec3b>(), palette.size(), palette.begin());
    return palette;
}

}  // namespace

Palette paletteOf(ColourMap map) {
    switch (map) {
        case ColourMap::Amber: return interpolated(amber);
        case ColourMap::Copper: return interpolated(copper);
        case ColourMap::Turbo: return fromOpenCv(cv::COLORMAP_TURBO);
        case ColourMap::Viridis: return fromOpenCv(cv::COLORMAP_VIRIDIS);
        case ColourMap::Inferno: return fromOpenCv(cv::COLORMAP_INFERNO);
        case ColourMap::Gray: break;
    }
    return interpolated(gray);
}

}  // namespace insonify::output
