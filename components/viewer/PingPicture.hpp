#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "components/ros/Options.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::viewer {

/** Information for a page in addition to the picture. */
struct PictureNote {
    std::string source;    ///< "noise.noisy"
    double latency_s = 0;  ///< Since the ping's stamp, on the deployment's clock [s].
    uint64_t count = 0;    ///< Pings of this source so far [1].
};

/** Returns a binary message for pages: u32 kind, u32 size of the JSON, JSON padded to a multiple of 4, data; little
 *  endian. */
std::string pageMessage(uint32_t kind, std::string json, const std::string& data);

inline constexpr uint32_t ping_kind = 1, scene_kind = 2, snapshot_kind = 3;

inline constexpr double lone_beam_width = 0.03;  ///< Shown width of a single beam whose ping does not state it [rad].

/** Encodes pings as messages for pages: a level of 8 bits for each beam and bin, beam-first. The beams are those of
 *  types::BeamArc, from starboard to port; `bearings` are their centres, `edges` two for each beam [rad].
 *
 *  255 is `top_db`, at or slightly above the strongest echo; each step below is `step_db`; 0 is no echo, or an echo
 *  below all steps. Above 4096 bins, several bins are merged into one with the strongest of their echoes. */
class PingPicture {
public:
    static constexpr double step_db = 0.4;
    static constexpr uint32_t max_bins = 4096;

    explicit PingPicture(ros::BinScale scale);
    /** Encodes a ping, whose lists must match its counts. */
    std::string encode(const types::Sonar& ping, const PictureNote& note) const;

private:
    float decibels(float bin) const;
    ros::BinScale scale_;
    std::unique_ptr<std::array<float, 65536>> levels_;  ///< By the first 16 bits of a float, to 0.02 dB [dB].
};

}  // namespace insonify::viewer
