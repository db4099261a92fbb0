#pragma once
#include <cstdint>
#include <vector>

#include "components/output/pictures/FanShape.hpp"
#include "components/output/tasks/PictureConfig.hpp"
#include "types/samples/DepthMap.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::output {

enum class PlainShape { Fan, Polar, Waterfall, Range };

/** The appearance of a plain picture. */
struct PlainConfig {
    PlainShape shape = PlainShape::Fan;
    uint32_t height = 512;
    double dynamic_range_db = 50;
    std::optional<double> reference_db;
    BinScale scale = BinScale::Linear;
    int code_bits = 8;
    bool smooth = false;

    DisplayConfig display() const;

    static void describe(auto& self, auto& visit) {
        visit({"shape", "",
               "fan: as in the water, ahead is up; polar: a column for each beam; waterfall: a row for "
               "each line of "
               "a side-scan, the newest on top, port left; range: a pixel for each beam of a 3-D sonar, nearest "
               "brightest"},
              self.shape);
        visit({"height", "1", "max number of pixels over the range; a pixel covers at least one bin", 16, 8192},
              self.height);
        visit({"dynamic_range_db", "dB", "between black and white", 1, 300}, self.dynamic_range_db);
        visit({"reference_db", "dB",
               "level of white, 10 log10 of a bin; absent: the level that 0.2 % of the picture's bins exceed", -3000,
               3000},
              self.reference_db);
        visit({"scale", "", "content of the bins: linear intensities, decibel, or code"}, self.scale);
        visit({"code_bits", "1", "bits of a code, if scale is code", 1, 32}, self.code_bits);
        visit(
            {"smooth", "",
             "true: a pixel of a fan is interpolated between the four nearest cells, as by displays of sonars; labels "
             "are those of the nearest"},
            self.smooth);
    }
    void check(types::Diagnostics& diagnostics) const {
        display().check(diagnostics);
        if (smooth && shape != PlainShape::Fan)
            diagnostics.push_back(
                {"smooth", "is true, but a pixel of this shape shows one cell; only a fan has others"});
    }
};

/** Draws a ping in grey levels, without rings, text or bars, for machine learning. Port is left, far ranges are on top.
 *  Each pixel shows one cell: one or several bins of a beam. So labels of cells are labels of pixels. Each ping is
 *  scaled independently of earlier pings. */
class PlainPicture {
public:
    explicit PlainPicture(const PlainConfig& config) : config_(config) {}

    /** Takes a ping with one bearing for each beam. A waterfall is one ping of all lines, line by line. A line has a
     *  beam to port (its bearing is not negative), a beam to starboard, or both. */
    void take(const types::Sonar& ping);
    /** Takes a range image as if each of its cells were a beam of one bin, row by row. Grey levels are from 1 at
     *  `range_max` [m] to 255 at the sonar, 0 without a return. */
    void take(const types::DepthMap& map, double range_max);

    uint32_t width() const { return width_; }    ///< [px]
    uint32_t height() const { return height_; }  ///< [px]
    /** Bins in each cell of a beam; the last cell may have fewer. */
    uint32_t binsPerCell() const { return bins_per_cell_; }
    uint32_t cellsPerBeam() const { return cells_; }
    /** The cell of each pixel, row by row from the top: beam * cellsPerBeam() + number of the cell; -1: no water. */
    const std::vector<int32_t>& cells() const { return cell_of_; }
    /** The level of each cell from black, 0, to white, 255. */
    const std::vector<uint8_t>& levels() const { return levels_; }
    /** The ping's beams from starboard to port; for a waterfall those of the first line, for a range image the
     *  columns. */
    const types::BeamArc& arc() const { return shape_; }
    /** Returns the bearing of a beam on that arc, which exceeds pi across +-180 degrees; NaN: unknown [rad]. */
    double bearing(uint32_t beam) const { return bearing_of_[beam]; }
    /** Returns the pixel nearest to the middle of a cell, {column, row}; inside the picture. */
    cv::Point findPixel(uint32_t beam, uint32_t cell) const;
    /** Returns the group of each cell: chosen cells that touch, in one beam or in neighbouring beams of the picture,
     *  also at corners. Groups are numbered from 1; 0 is a cell that is not chosen. Independent of the order of beams
     *  in the ping.
     *  @param chosen one number for each cell, 0: not chosen */
    std::vector<int32_t> groupBy(const std::vector<uint8_t>& chosen) const;
    /** Returns the level of white [dB]; 0 if bins are codes. */
    double referenceDb() const { return reference_db_; }
    types::Image image() const;

private:
    void buildFan();
    void buildPolar();
    void buildWaterfall(const types::Sonar& ping);
    void findLevels(const types::Sonar& ping);
    double computeMean(const types::Sonar& ping, uint32_t beam, uint32_t cell) const;
    /** Returns the level between the four cells about a place: x by BeamArc::placeAt(), y in cells from range 0. */
    uint8_t interpolate(const cv::Point2d& at) const;

    PlainConfig config_;
    FanShape shape_;
    std::vector<double> bearing_of_;   ///< The bearing of each beam of the ping, on the arc [rad].
    std::vector<uint32_t> column_of_;  ///< The column of each beam in a polar picture.
    std::vector<uint32_t> line_of_;    ///< The line of each beam in a waterfall, from the oldest.
    uint32_t port_cells_ = 0;          ///< Pixels to port (left) in a row of a waterfall [px].
    uint32_t bins_per_cell_ = 1, cells_ = 0, width_ = 0, height_ = 0;
    cv::Point2d origin_{};  ///< The sonar's place in a fan [px].
    double radius_ = 0;     ///< Radius of a fan [px].
    double reference_db_ = 0;
    types::Time time_;
    std::vector<int32_t> cell_of_;
    std::vector<cv::Point2d> places_;  ///< For interpolate(), of each pixel; empty unless pictures are smooth.
    std::vector<uint8_t> levels_;
};

}  // namespace insonify::output

template <>
struct insonify::types::EnumNames<insonify::output::PlainShape> {
    static constexpr std::string_view names[] = {"fan", "polar", "waterfall", "range"};
};

namespace insonify::output {

/** Returns the mean structural similarity of two pings of the same shape: SSIM of Wang et al. 2004, a Gaussian window
 *  of 11 x 11 with a deviation of 1.5, constants 0.01 and 0.03. Compares their log-compressed levels of 8 bits, beams
 *  by bins, not bent into a fan, so that each echo counts once. 1: equal, 0: nothing in common.
 *  @param display range and scale; without a reference level both use that of the first ping */
double structuralSimilarity(const types::Sonar& reference, const types::Sonar& other, DisplayConfig display);

/** Returns a ping's level of the brightest colour, as in LevelScale [dB]. */
double referenceLevel(const types::Sonar& ping, const DisplayConfig& display);

}  // namespace insonify::output
