#include "types/samples/SonarScan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace insonify::types {
namespace {

/** Sets the bins from the two-way time between their samples [s]. Without a speed of sound, ranges are unknown. */
void setBins(double sampling_interval, float speed_of_sound, Sonar& ping) {
    ping.speed_of_sound = speed_of_sound;
    if (!(sampling_interval > 0 && sampling_interval < 1e6))
        throw std::logic_error("has a sampling interval that is no time");
    const double seconds = sampling_interval / 2, speed = static_cast<double>(speed_of_sound);
    if (speed > 0 && std::isfinite(speed))
        ping.setBins(seconds * speed, speed);
    else
        ping.bin_duration.microseconds = std::max<int64_t>(1, std::llround(1e6 * seconds));
}

float strength(uint8_t byte) { return static_cast<float>(byte) / 255.0f; }

}  // namespace

Sonar toSonar(const SonarBeam& beam) {
    Sonar ping;
    ping.time = beam.time;
    ping.beam_width = Angle::fromRad(static_cast<double>(beam.beamwidth_horizontal));
    ping.beam_height = Angle::fromRad(static_cast<double>(beam.beamwidth_vertical));
    ping.bearings = {beam.bearing};
    ping.bin_count = static_cast<uint32_t>(beam.beam.size());
    setBins(beam.sampling_interval, beam.speed_of_sound, ping);
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
    ping.beam_width = scan.beamwidth_horizontal;
    ping.beam_height = scan.beamwidth_vertical;
    ping.resize(scan.number_of_bins, scan.number_of_beams);
    setBins(scan.sampling_interval, scan.speed_of_sound, ping);
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
