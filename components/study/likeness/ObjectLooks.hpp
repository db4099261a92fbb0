#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "components/study/error/ErrorAnalysis.hpp"

namespace insonify::study {

/** A window of a sonar picture about an object: rows are ranges, the farthest on top; columns are across the beams. */
struct ObjectCrop {
    std::string name;
    size_t width = 0, height = 0;
    std::vector<uint8_t> levels;  ///< Row by row from the top, 0 black to 255.

    uint8_t at(size_t column, size_t row) const { return levels[row * width + column]; }
};

constexpr size_t crop_side = 96;  ///< Of a window, as in the real pictures [px].
constexpr size_t min_side = 24;   ///< Smaller crops have too few pixels for these statistics [px].

/** Statistics of crops of objects, of which each crop has one value.
 *
 *  The mean of 9 x 9 pixels about each pixel is its surroundings'. A deviation is 1.4826 times the median distance of
 *  pixels from it, the level of the background the median of all these means. Background are the pixels whose mean is
 *  within half a deviation of that level, highlights those more than two deviations above it. */
struct ObjectLooks {
    std::array<double, 3>
        across{};  ///< Of background levels 1, 2, 3 px apart in a row, about their linear trend over rows [1].
    std::array<double, 2> along{};         ///< The same 1, 2 px apart in a column [1].
    double skew = 0;                       ///< Third standardised moment of the background's levels [1].
    double run_along = 0, run_across = 0;  ///< Mean length of runs of highlights in columns, in rows [px].
    double step = 0;      ///< Mean difference of neighbours in a column over the crop's standard deviation [1].
    double fall_off = 0;  ///< Mean level of the farthest quarter of the rows minus that of the nearest [levels].
    double depth = 0;     ///< Median of the background minus 3rd percentile of the crop [levels].
};

/** Returns the statistics of a crop; those that it has no pixels for are NaN.
 *  @throws std::invalid_argument if it is smaller than min_side */
ObjectLooks computeLooks(const ObjectCrop& crop);
/** Returns the median of each statistic over the crops that have it; NaN where none has. */
ObjectLooks computeMedian(const std::vector<ObjectLooks>& all);

/** A statistic with its value in real pictures and the difference that is allowed. */
struct ObjectFigure {
    const char* name;
    double value, real, tolerance;
};
/** Returns the statistics next to those of 2,355 real crops: ten small objects in a tank, by an ARIS Explorer 3000 at
 *  3 MHz. A difference of 20 % is allowed, of 0.05 for the correlation of 0.06, and of 0.2 for the skew. */
std::vector<ObjectFigure> getFigures(const ObjectLooks& looks);
/** Returns a claim for each figure; they are open for fewer than ten crops. */
std::vector<Claim> claims(const ObjectLooks& looks, size_t crops);

/** Returns a line for each crop with its statistics, then one of their medians and one of the real ones. */
std::string csv(const std::vector<ObjectCrop>& crops, const std::vector<ObjectLooks>& all);

}  // namespace insonify::study
