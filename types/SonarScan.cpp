#include "types/SonarScan.hpp"

#include <algorithm>
#include <stdexcept>

namespace insonify::types {
namespace {

/** Returns the one-way time through a bin, in whole microseconds as in a ping. */
Time binDuration(double sampling_interval) {
    if (!(sampling_interval >= 0 && sampling_interval < 1e6))
        throw std::logic_error("has a sampling interval that is no time");
    return Time::fromSeconds(sampling_interval / 2);
}

float strength(uint8_t byte) { return static_cast<float>(byte) / 255.0f; }

}  // namespace

Sonar toSonar(const SonarBeam& beam) {
    Sonar ping;
    ping.time = beam.time;
    ping.bin_duration = binDuration(beam.sampling_interval);
    ping.beam_width = Angle::fromRad(static_cast<double>(beam.beamwidth_horizontal));
    ping.beam_height = Angle::fromRad(static_cast<double>(beam.beamwidth_vertical));
    ping.bearings = {beam.bearing};
    ping.speed_of_sound = beam.speed_of_sound;
    ping.bin_count = static_cast<uint32_t>(beam.beam.size());
    ping.beam_count = 1;
    std::transform(beam.beam.begin(), beam.beam.end(), std::back_inserter(ping.bins), strength);
    return ping;
}

Sonar toSonar(const SonarScan& scan) {
    const size_t beams = scan.number_of_beams, bins = scan.number_of_bins;
    if (!scan.polar_coordinates) throw std::logic_error("is a picture, not beams");
    if (scan.data.size() != beams * bins || (!scan.time_beams.empty() && scan.time_beams.size() != beams))
        throw std::logic_error("has other numbers of bins or beam times than it says");
    Sonar ping;
    ping.time = scan.time;
    ping.bin_duration = binDuration(scan.sampling_interval);
    ping.beam_width = scan.beamwidth_horizontal;
    ping.beam_height = scan.beamwidth_vertical;
    ping.speed_of_sound = scan.speed_of_sound;
    ping.resize(scan.number_of_bins, scan.number_of_beams);
    ping.setRegularBearings(scan.start_bearing, {-scan.angular_resolution.rad});
    ping.timestamps = scan.time_beams;
    for (size_t beam = 0; beam < beams; ++beam) {
        if (!ping.timestamps.empty() && ping.timestamps[beam].isNull()) continue;
        for (size_t bin = 0; bin < bins; ++bin)
            ping.bins[beam * bins + bin] =
                strength(scan.data[scan.memory_layout_column ? bin * beams + beam : beam * bins + bin]);
    }
    return ping;
}

}  // namespace insonify::types
