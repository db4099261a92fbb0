#pragma once
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "components/output/pictures/Canvas.hpp"
#include "types/geometry/Datum.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/PointCloud.hpp"

namespace insonify::output {

/** Draws a chart of soundings from above: north up, west to the left, coloured by height, the highest brightest.
 *
 *  Shows the points of the last `history` clouds, and fits its scale to them. */
class SoundingMap {
public:
    using Sample = types::PointCloudPtr;
    static constexpr const char* port = "soundings";

    SoundingMap(uint32_t width, ColourMap colour_map) : chart_(width, colour_map) {}

    /** Sets the world's origin on the earth, which the title then names. */
    void setDatum(const std::optional<types::Datum>& datum) { datum_ = datum; }
    /** Adds the points of a ping; points that are not finite are ignored. */
    void add(const types::PointCloudPtr& cloud);
    /** @param picture becomes a BGR image, 8 bits a channel, with the newest cloud's time; its memory is reused */
    void paint(types::Image& picture);
    void clear() { clouds_.clear(), next_ = 0; }

    static constexpr size_t history = 2000;  ///< Max number of clouds shown.

    /** Returns the pixel of a place in the last picture. */
    cv::Point pixel(double x, double y) const;

private:
    /** The bounding box of all points [m]. */
    struct Bounds {
        glm::dvec3 low{0}, high{0};
        size_t points = 0;
    };
    Bounds bounds() const;
    /** Chooses the scale at which the points fit; returns the rows needed. */
    int fit(const Bounds& bounds);
    void drawPoints(cv::Mat& canvas, const Bounds& bounds) const;
    void drawLabels(cv::Mat& canvas, const Bounds& bounds) const;

    Chart chart_;
    std::vector<std::vector<glm::dvec3>> clouds_;  ///< A ring buffer, whose memory is reused.
    size_t next_ = 0;                              ///< Index of the next cloud.
    std::optional<types::Datum> datum_;
    types::Time time_;    ///< Time of the newest cloud.
    cv::Point2d centre_;  ///< x north, y west of the middle of the chart [m].
    double pixels_per_m_ = 1;
};

}  // namespace insonify::output
