#pragma once
#include <array>
#include <opencv2/core.hpp>

#include "components/output/tasks/PictureConfig.hpp"

namespace insonify::output {

/** Compresses bins to levels: 255 is the reference, 0 is `dynamic_range_db` below it, clipped at both ends. Codes are
 *  not compressed: 255 is the max code, 0 is 0.
 *
 *  Without a fixed `reference_db`, the reference follows the echoes. It is the level that 0.2 % of a picture's bins
 *  exceed, smoothed with a tenth of the difference from one picture to the next. */
class LevelScale {
public:
    explicit LevelScale(const DisplayConfig& config) : config_(config) {}

    /** @param bins 32-bit floats on the scale of the configuration; NaN and no echo (0, negative) become level 0
     *  @param levels 8 bits each, of the same shape */
    void apply(const cv::Mat& bins, cv::Mat& levels);

    /** Returns the level of the brightest colour in the last picture [dB]; 0 if bins are codes. */
    double referenceDb() const { return reference_db_; }
    const DisplayConfig& config() const { return config_; }

private:
    void applyToCodes(const cv::Mat& bins, cv::Mat& levels);
    void toDecibels(const cv::Mat& bins);
    void follow();
    double strongLevel();

    static constexpr float nothing_db = -3000;

    DisplayConfig config_;
    cv::Mat decibels_;
    std::array<uint32_t, 8192> histogram_{};
    double reference_db_ = 0;
    bool started_ = false;
};

}  // namespace insonify::output
