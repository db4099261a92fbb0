#pragma once
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "components/output/pictures/Canvas.hpp"
#include "components/output/pictures/FanShape.hpp"
#include "components/output/pictures/LevelScale.hpp"
#include "components/output/pictures/Overlay.hpp"
#include "components/output/pictures/Painter.hpp"

namespace insonify::output {

/** Draws a ping as a fan: ahead is up, port is left, with range rings in metres and bearings in degrees. Bearings may
 *  be in any order, unevenly spaced, and span up to the full circle.
 *
 *  A table maps pixels to bins until bearings, bins or range change. Ranges finer than the picture are first averaged
 *  as intensities. */
class FanImage final : public Painter {
public:
    explicit FanImage(const DisplayConfig& config);

    void paint(const types::Sonar& ping, types::Image& picture) override;

    /** Draws the same without the line of text on top; returns a view of the picture's pixels. */
    cv::Mat draw(const types::Sonar& ping, types::Image& picture);

    /** Returns the layout of the last picture, which must exist. */
    const FanLayout& layout() const { return *layout_; }
    const LevelScale& scale() const { return scale_; }
    /** Returns the area of the colour bar and its labels in the last picture, if it has one [px]. */
    const cv::Rect& bar() const { return labelled_bar_; }
    const Overlay& overlay() const { return *overlay_; }
    int tablesBuilt() const { return tables_built_; }

private:
    /** The pixels of one row that show water. */
    struct Span {
        int row, begin, end;
    };

    bool fits(const types::Sonar& ping) const;
    void build(const types::Sonar& ping);
    void buildTables();
    void buildOverlay();
    void gather(const types::Sonar& ping);
    void colour(cv::Mat& canvas) const;

    DisplayConfig config_;
    Palette palette_;
    LevelScale scale_;
    Title title_;

    std::vector<types::Angle> bearings_;  // as in the ping for which the tables were built
    double beam_width_ = 0;
    FanShape shape_;
    std::optional<FanLayout> layout_;
    int columns_ = 0;  // range cells of the polar picture
    cv::Mat source_, fraction_;
    std::vector<Span> spans_;
    std::optional<Overlay> overlay_;
    cv::Point bar_;  // of colours
    cv::Rect labelled_bar_;
    int tables_built_ = 0;

    cv::Mat bins_, polar_, polar_levels_, levels_;
};

/** Draws the pings of a mechanically scanning sonar on a disc. Each ping overwrites the sector of its beam width, so
 *  that each direction shows its last echo. Where beams of one ping overlap, the nearest centre counts. A line shows
 *  the direction of the head. Ahead is up, port left. A ping with other bins or range starts an empty disc. */
class DiscImage final : public Painter {
public:
    explicit DiscImage(const DisplayConfig& config) : fan_(config) {}

    void paint(const types::Sonar& ping, types::Image& picture) override;
    void skip(const types::Sonar& ping) override;

    const FanLayout& layout() const { return fan_.layout(); }

    /** Resolution of directions: 0.45 degrees each, the finest step of common heads. */
    static constexpr uint32_t sectors = 800;

private:
    void clear(const types::Sonar& ping);
    void overwrite(const types::Sonar& ping, size_t place);

    FanImage fan_;
    types::Sonar disc_;
    types::BeamArc arc_;  ///< The beams of the last ping.
    Title title_;
};

}  // namespace insonify::output
