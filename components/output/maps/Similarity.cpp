#include "components/output/maps/Similarity.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "components/output/pictures/LevelScale.hpp"
#include "types/geometry/BeamArc.hpp"

namespace insonify::output {
namespace {

constexpr double white = 255;

/** Returns the levels of 8 bits as 64-bit floats; neighbouring rows are neighbouring beams. */
cv::Mat levelsOf(const types::Sonar& ping, LevelScale& scale) {
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
    levelsOf(ping, scale);
    return scale.referenceDb();
}

double structuralSimilarity(const types::Sonar& reference, const types::Sonar& other, DisplayConfig display) {
    const double c1 = std::pow(0.01 * white, 2), c2 = std::pow(0.03 * white, 2);
    LevelScale scale(display);
    const cv::Mat x = levelsOf(reference, scale);
    display.reference_db = scale.referenceDb();
    LevelScale same_scale(display);
    const cv::Mat y = levelsOf(other, same_scale);
    const cv::Mat mean_x = blurred(x), mean_y = blurred(y);
    const cv::Mat means = mean_x.mul(mean_y), squares = mean_x.mul(mean_x) + mean_y.mul(mean_y);
    const cv::Mat covariance = blurred(x.mul(y)) - means;
    const cv::Mat variances = blurred(x.mul(x)) + blurred(y.mul(y)) - squares;
    const cv::Mat above = (2 * means + c1).mul(2 * covariance + c2), below = (squares + c1).mul(variances + c2);
    return cv::mean(above / below)[0];
}

}  // namespace insonify::output
