#pragma once
#include "components/output/pictures/FanImage.hpp"

namespace insonify::output {

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
