#pragma once
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "components/output/pictures/FanImage.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::output {

/** Draws a ping twice, side by side. Left: as FanImage draws it. Right: the same fan, each object in its own colour, as
 *  bright as its echo, and shadow in dark blue. The names of the objects are listed, those with the most bins first, as
 *  far as they fit. */
class TruthImage final : public Painter {
public:
    /** The width is that of both pictures together. */
    explicit TruthImage(const DisplayConfig& config);

    /** Sets the truth of the next ping; it must outlive its picture. */
    void setTruth(const types::SonarTruth& truth) { truth_ = &truth; }
    /** Throws std::runtime_error if ping and truth differ in beams or bins. */
    void paint(const types::Sonar& ping, types::Image& picture) override;

    /** Returns an object's colour at full brightness: blue, green, red. */
    static cv::Vec3b getColour(int32_t object);
    static constexpr int shadow_blue = 60;
    /** Returns the layout of the left half; the right half follows it. A picture must have been drawn. */
    const FanLayout& layout() const { return fan_.layout(); }

private:
    void build(const types::Sonar& ping);
    cv::Vec3b colourAt(size_t bin, const cv::Vec3b& echo) const;
    void colour(const cv::Mat& fan, cv::Mat& canvas) const;
    void count();
    /** Returns the row above which the corner left of the fan is free. */
    int legendEnd(const cv::Mat& canvas) const;
    void addLegend(cv::Mat& canvas) const;
    void addLine(cv::Mat& canvas, int row, const std::string& text, const cv::Vec3b& colour) const;

    FanImage fan_;
    const types::SonarTruth* truth_ = nullptr;
    int tables_ = 0;  ///< Number of the fan's tables when bin_of_ was built.
    cv::Mat bin_of_;  ///< The bin that each pixel shows; -1: none.
    types::Image fan_picture_, truth_picture_;
    /** Returns the objects that the ping shows with their numbers of bins, in descending order. */
    struct Shown {
        int32_t object;
        size_t bins;
    };
    std::vector<Shown> shown_;
    std::vector<size_t> bins_of_;  ///< Bins of each object.
};

}  // namespace insonify::output
