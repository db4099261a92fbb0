#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/deployer/Json.hpp"
#include "components/deployer/Score.hpp"

namespace insonify::deployer {

/** How many pings were not compared, and why; empty: all were. */
std::string leftOut(const StreamScore& score);

/** For each stream a line on all of its pings, and a table of the worst of them. */
std::string scoreTable(const std::vector<StreamScore>& streams, size_t worst);

/** `{streams: [{stream, display: {dynamic_range_db, scale}, compared, not_rendered, not_recorded, other_shape, pings:
 *  [{time, rel_l2, rel_l2_tvg, correlation, first_return_bins, ssim, level_distance_db, energy_bias}]}]}`, worst first.
 */
Json scoreJson(const std::vector<StreamScore>& streams);

/** Writes pictures of the worst pings, recorded and rendered side by side on the same scale, worst first:
 *  score_000000.png and on, on through the streams. A ping of one beam is shown on the disc of its scan. */
void writeScorePictures(log::Reader& recorded, log::Reader& rendered, const std::vector<StreamScore>& streams,
                        size_t worst, const std::filesystem::path& folder);

}  // namespace insonify::deployer
