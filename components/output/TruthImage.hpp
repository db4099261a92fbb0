#pragma once
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "components/output/FanImage.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::output {

/** A ping twice, side by side: to the left as FanImage draws it, to the right the same fan with what its bins show:
 *  each object in a colour of its own, as bright as its echo; what lies in shadow dark blue; and the names of the
 *  objects that the ping shows, those in most bins first, as many as there is room for. */
class TruthImage final : public Painter {
public:
    /** The width is that of both together. */
    explicit TruthImage(const DisplayConfig& config);

    /** What the next ping shows; it must outlive its picture. */
    void regard(const types::SonarTruth& truth) { truth_ = &truth; }
    /** Throws std::runtime_error for a ping with other beams or bins than its truth. */
    void paint(const types::Sonar& ping, types::Image& picture) override;

    /** Of an object, at full brightness: blue, green, red. */
    static cv::Vec3b colourOf(int32_t object);
    static constexpr int shadow_blue = 60;
    /** Of the left half; the right one's is beside it. There must have been a picture. */
    const FanLayout& layout() const { return fan_.layout(); }

private:
    void build(const types::Sonar& ping);
    cv::Vec3b colourAt(size_t bin, const cv::Vec3b& echo) const;
    void colour(const cv::Mat& fan, cv::Mat& canvas) const;
    void count();
    /** Row down to which the corner to the left of the fan is free. */
    int legendEnd(const cv::Mat& canvas) const;
    void addLegend(cv::Mat& canvas) const;
    void addLine(cv::Mat& canvas, int row, const std::string& text, const cv::Vec3b& colour) const;

    FanImage fan_;
    const types::SonarTruth* truth_ = nullptr;
    int tables_ = 0;  ///< Of the fan, when ours were built.
    cv::Mat bin_of_;  ///< Of each pixel the bin that it shows; -1: none.
    types::Image fan_picture_, truth_picture_;
    /** Objects that the ping shows, with the number of bins; those with most first. */
    struct Shown {
        int32_t object;
        size_t bins;
    };
    std::vector<Shown> shown_;
    std::vector<size_t> bins_of_;  ///< Of each object.
};

}  // namespace insonify::output
