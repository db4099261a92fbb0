#include "components/study/likeness/ObjectLooks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace insonify::study {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double to_deviation = 1.4826;     // of a normal law, from the median distance
constexpr double background_share = 0.5;    // of a deviation, between the mean of a window and the background
constexpr double highlight_deviations = 2;  // also beyond which a level counts for no skew
constexpr int window_px = 9;
constexpr size_t enough_crops = 10, enough_pixels = 100;

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return none;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/** Sums of a set of numbers: mean, deviation and skew. */
struct Moments {
    double count = 0, sum = 0, squares = 0, cubes = 0;

    void add(double x) { ++count, sum += x, squares += x * x, cubes += x * x * x; }
    double mean() const { return count > 0 ? sum / count : none; }
    double variance() const { return squares / count - mean() * mean(); }
    double skew() const {
        const double m = mean(), v = variance();
        return v > 0 ? (cubes / count - 3 * m * squares / count + 2 * m * m * m) / std::pow(v, 1.5) : none;
    }
};

/** Returns the mean of the window about each pixel, as far as it is within the crop. */
std::vector<double> computeMeans(const ObjectCrop& crop) {
    const cv::Mat levels = cv::Mat(crop.levels).reshape(1, static_cast<int>(crop.height));
    const auto sum = [](const cv::Mat& of) {
        cv::Mat result;
        cv::boxFilter(of, result, CV_64F, {window_px, window_px}, {-1, -1}, false, cv::BORDER_CONSTANT);
        return result;
    };
    const cv::Mat means = sum(levels) / sum(cv::Mat::ones(levels.size(), CV_8U));
    return {means.begin<double>(), means.end<double>()};
}

/** A crop with its background. */
class Scaled {
public:
    explicit Scaled(const ObjectCrop& crop) : crop_(crop) {
        const std::vector<double> means = computeMeans(crop);
        level_ = quantile(means, 0.5);
        std::vector<double> off;
        for (size_t i = 0; i < means.size(); ++i) off.push_back(std::abs(crop.levels[i] - means[i]));
        deviation_ = to_deviation * std::max(0.5, quantile(std::move(off), 0.5));
        double count = 0, rows = 0, levels = 0, products = 0, squares = 0;
        for (size_t i = 0; i < means.size(); ++i) {
            is_background_.push_back(std::abs(means[i] - level_) <= background_share * deviation_);
            if (!is_background_.back()) continue;
            const double row = static_cast<double>(i / crop.width), level = crop.levels[i];
            ++count, rows += row, levels += level, products += row * level, squares += row * row;
        }
        const double spread = squares - rows * rows / count;
        slope_ = count > 1 && spread > 0 ? (products - rows * levels / count) / spread : 0;
    }
    bool isBackground(size_t column, size_t row) const { return is_background_[row * crop_.width + column]; }
    /** Returns how many deviations a pixel's level is above that of the background. */
    double above(size_t column, size_t row) const { return (crop_.at(column, row) - level_) / deviation_; }
    bool isHighlight(size_t column, size_t row) const { return above(column, row) > highlight_deviations; }

    /** Returns the correlation of background pixels that are apart by columns and rows, about their linear trend. */
    double correlation(size_t columns, size_t rows) const {
        Moments one, other;
        double products = 0;
        const auto residual = [&](size_t column, size_t row) {
            return crop_.at(column, row) - slope_ * static_cast<double>(row);
        };
        for (size_t row = 0; row + rows < crop_.height; ++row)
            for (size_t column = 0; column + columns < crop_.width; ++column) {
                if (!isBackground(column, row) || !isBackground(column + columns, row + rows)) continue;
                const double a = residual(column, row), b = residual(column + columns, row + rows);
                one.add(a), other.add(b), products += a * b;
            }
        if (one.count < enough_pixels) return none;
        const double spread = std::sqrt(one.variance() * other.variance());
        return spread > 0 ? (products / one.count - one.mean() * other.mean()) / spread : none;
    }

    /** Returns the mean length of runs of highlights in the lines of `count` pixels for which `isHigh(line, place)`
     * holds. */
    template <class At>
    static double meanRun(size_t lines, size_t count, const At& isHigh) {
        double pixels = 0, runs = 0;
        for (size_t line = 0; line < lines; ++line)
            for (size_t place = 0; place < count; ++place)
                if (isHigh(line, place)) ++pixels, runs += place == 0 || !isHigh(line, place - 1);
        return runs > 0 ? pixels / runs : none;
    }

private:
    const ObjectCrop& crop_;
    double level_ = 0, deviation_ = 0, slope_ = 0;
    std::vector<bool> is_background_;
};

double meanLevel(const ObjectCrop& crop, size_t from, size_t to) {
    Moments moments;
    for (size_t row = from; row < to; ++row)
        for (size_t column = 0; column < crop.width; ++column) moments.add(crop.at(column, row));
    return moments.mean();
}

/** Returns a copy with the value that `select` returns for each statistic. */
template <class Select>
ObjectLooks makeLooks(const Select& select) {
    ObjectLooks looks;
    for (size_t i = 0; i < looks.across.size(); ++i)
        looks.across[i] = select([i](const auto& l) { return l.across[i]; });
    for (size_t i = 0; i < looks.along.size(); ++i) looks.along[i] = select([i](const auto& l) { return l.along[i]; });
    looks.skew = select([](const auto& l) { return l.skew; });
    looks.run_along = select([](const auto& l) { return l.run_along; });
    looks.run_across = select([](const auto& l) { return l.run_across; });
    looks.step = select([](const auto& l) { return l.step; });
    looks.fall_off = select([](const auto& l) { return l.fall_off; });
    looks.depth = select([](const auto& l) { return l.depth; });
    return looks;
}

}  // namespace

ObjectLooks computeLooks(const ObjectCrop& crop) {
    if (crop.width < min_side || crop.height < min_side)
        throw std::invalid_argument(fmt::format("{} has {} x {} pixels; it must have {} x {} for these statistics",
                                                crop.name, crop.width, crop.height, min_side, min_side));
    const Scaled scaled(crop);
    ObjectLooks looks;
    for (size_t i = 0; i < looks.across.size(); ++i) looks.across[i] = scaled.correlation(i + 1, 0);
    for (size_t i = 0; i < looks.along.size(); ++i) looks.along[i] = scaled.correlation(0, i + 1);
    Moments background, all;
    std::vector<double> floor;
    double steps = 0;
    for (size_t row = 0; row < crop.height; ++row)
        for (size_t column = 0; column < crop.width; ++column) {
            all.add(crop.at(column, row));
            if (scaled.isBackground(column, row)) {
                floor.push_back(crop.at(column, row));
                if (std::abs(scaled.above(column, row)) <= highlight_deviations) background.add(crop.at(column, row));
            }
            if (row > 0) steps += std::abs(crop.at(column, row) - crop.at(column, row - 1));
        }
    looks.skew = background.skew();
    looks.run_along =
        Scaled::meanRun(crop.width, crop.height, [&](size_t x, size_t y) { return scaled.isHighlight(x, y); });
    looks.run_across =
        Scaled::meanRun(crop.height, crop.width, [&](size_t y, size_t x) { return scaled.isHighlight(x, y); });
    const double pairs = static_cast<double>(crop.width * (crop.height - 1));
    looks.step = all.variance() > 0 ? steps / pairs / std::sqrt(all.variance()) : none;
    looks.fall_off = meanLevel(crop, 0, crop.height / 4) - meanLevel(crop, crop.height - crop.height / 4, crop.height);
    looks.depth = quantile(std::move(floor), 0.5) - quantile({crop.levels.begin(), crop.levels.end()}, 0.03);
    return looks;
}

ObjectLooks computeMedian(const std::vector<ObjectLooks>& all) {
    return makeLooks([&](const auto& get) {
        std::vector<double> values;
        for (const ObjectLooks& looks : all)
            if (std::isfinite(get(looks))) values.push_back(get(looks));
        return quantile(std::move(values), 0.5);
    });
}

std::vector<ObjectFigure> getFigures(const ObjectLooks& looks) {
    std::vector<ObjectFigure> figures{
        {"correlation_across_1", looks.across[0], 0.57, 0},    {"correlation_across_2", looks.across[1], 0.21, 0},
        {"correlation_across_3", looks.across[2], 0.06, 0.05}, {"correlation_along_1", looks.along[0], 0.44, 0},
        {"correlation_along_2", looks.along[1], 0.13, 0},      {"background_skew", looks.skew, -0.01, 0.2},
        {"highlight_run_along", looks.run_along, 4.5, 0},      {"highlight_run_across", looks.run_across, 7.5, 0},
        {"step_over_deviation", looks.step, 0.36, 0},          {"last_minus_first_quarter", looks.fall_off, -23, 0},
        {"background_minus_darkest", looks.depth, 43, 0}};
    for (ObjectFigure& figure : figures)
        if (figure.tolerance == 0) figure.tolerance = 0.2 * std::abs(figure.real);
    return figures;
}

std::vector<Claim> claims(const ObjectLooks& looks, size_t crops) {
    std::vector<Claim> all;
    for (const ObjectFigure& figure : getFigures(looks))
        all.push_back(
            {fmt::format("{} is {:.3g}, of real pictures {:g}, apart by", figure.name, figure.value, figure.real),
             std::abs(figure.value - figure.real), figure.tolerance, true, crops >= enough_crops});
    return all;
}

std::string csv(const std::vector<ObjectCrop>& crops, const std::vector<ObjectLooks>& all) {
    const ObjectLooks median = computeMedian(all);
    std::string text = "crop";
    for (const ObjectFigure& figure : getFigures(median)) fmt::format_to(std::back_inserter(text), ",{}", figure.name);
    const auto addLine = [&](const std::string& name, const ObjectLooks& looks, double ObjectFigure::*column) {
        text += "\n" + name;
        for (const ObjectFigure& figure : getFigures(looks))
            fmt::format_to(std::back_inserter(text), ",{:.6g}", figure.*column);
    };
    for (size_t i = 0; i < crops.size(); ++i) addLine(crops[i].name, all[i], &ObjectFigure::value);
    addLine("median", median, &ObjectFigure::value);
    addLine("real", median, &ObjectFigure::real);
    return text + "\n";
}

}  // namespace insonify::study
