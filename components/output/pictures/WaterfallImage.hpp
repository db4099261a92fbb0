#pragma once
#include <array>
#include <optional>
#include <string>

#include "components/output/pictures/Canvas.hpp"
#include "components/output/pictures/LevelScale.hpp"
#include "components/output/pictures/Overlay.hpp"
#include "components/output/pictures/Painter.hpp"

namespace insonify::output {

/** Draws range against time: every ping is a row, the newest on top, range from left to right. A row is the mean
 *  intensity over the ping's beams. Labels give range in metres and the age of rows. A ping with other bins or range
 *  restarts the picture. */
class WaterfallImage : public Painter {
public:
    explicit WaterfallImage(const DisplayConfig& config);

    void paint(const types::Sonar& ping, types::Image& picture) override;
    void skip(const types::Sonar& ping) override;

    static constexpr int history = 480;  ///< Max number of pings, a row of pixels each.

    /** Returns the part of the picture that shows echoes. */
    cv::Rect water() const;

protected:
    /** Fills the row of a ping, as wide as water(). */
    virtual void fillRow(const types::Sonar& ping, cv::Mat& row);
    /** Labels the lower edge of water() for pings of this range [m]. */
    virtual void addRanges(Overlay& overlay, double range) const;
    /** Names the axis below water(), where there is room to its left. */
    void nameAxis(Overlay& overlay, const std::string& name) const;

private:
    void clear(const types::Sonar& ping);
    void addRow(const types::Sonar& ping);
    void labelAges(cv::Mat& canvas);

    DisplayConfig config_;
    int width_;
    cv::Point bar_;  ///< Of colours.
    Palette palette_;
    LevelScale scale_;
    Title title_;

    uint32_t bin_count_ = 0;
    double range_ = 0;
    cv::Mat mean_, rows_, levels_, ground_;
    std::array<types::Time, history> times_{};
    int filled_ = 0;
    std::optional<Overlay> overlay_;
    std::string text_;
};

}  // namespace insonify::output
