#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/deployer/Json.hpp"
#include "components/log/Reader.hpp"
#include "components/output/tasks/PictureConfig.hpp"
#include "components/sonar/renderer/Metrics.hpp"

namespace insonify::deployer {

/** The similarity of a ping rendered again to the recorded ping. */
struct PingScore {
    types::Time time;
    sonar::Metrics metrics;
    double similarity = 0;  ///< SSIM of both pings as displayed [1].
    log::SampleRef recorded, rendered;
};

/** A stream of pings in two logs. */
struct StreamScore {
    std::string stream;
    output::DisplayConfig display;  ///< How the pings are displayed, for the similarity and in pictures.
    std::vector<PingScore> pings;   ///< Greatest relative L2 first; equal values in order of time.
    uint64_t not_rendered = 0;      ///< Recorded pings without a rendered ping of the same time.
    uint64_t not_recorded = 0;      ///< Rendered pings without a recorded ping of the same time.
    uint64_t other_shape = 0;       ///< Pairs that differ in beams, bins, range or bearings.
};

/** Compares the pings of a stream in pairs of the same time. Bins below 0 are levels in dB; NaN counts as silence. */
StreamScore score(log::Reader& recorded, log::Reader& rendered, const std::string& stream);

/** Returns how many pings were not compared, and why; empty: all were. */
std::string findOmitted(const StreamScore& score);

/** Returns, for each stream, a line on all its pings and a table of the `worst` pings with the greatest error. */
std::string scoreTable(const std::vector<StreamScore>& streams, size_t worst);

/** `{streams: [{stream, display: {dynamic_range_db, scale}, compared, not_rendered, not_recorded, other_shape, pings:
 *  [{time, rel_l2, rel_l2_tvg, correlation, first_return_bins, ssim, level_distance_db, energy_bias}]}]}`, worst first.
 */
Json scoreJson(const std::vector<StreamScore>& streams);

/** Writes pictures of the worst pings, recorded and rendered side by side on the same scale, worst first:
 *  score_000000.png and on, numbered through all streams. A ping of one beam is shown on the disc of its scan. */
void writeScorePictures(log::Reader& recorded, log::Reader& rendered, const std::vector<StreamScore>& streams,
                        size_t worst, const std::filesystem::path& folder);

}  // namespace insonify::deployer
