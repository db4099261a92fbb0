#include "components/ros/FromSonar.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "components/ros/Clouds.hpp"
#include "components/ros/Echoes.hpp"
#include "components/ros/Times.hpp"

namespace insonify::ros {

namespace {

void fillHeader(const types::Sonar& ping, const SonarOptions& options, Header& header) {
    if (!ping.wellShaped()) throw std::invalid_argument("the lists of the ping are not as long as its counts say");
    header.stamp = toRos(ping.time);
    header.frame_id = options.frame_id;
}

void fillWidths(types::Angle width, std::vector<float>& widths) {
    widths.assign(width.isUnknown() ? 0 : 1, static_cast<float>(width.rad));
}

void fillInfo(const types::Sonar& ping, const SonarOptions& options, PingInfo& info) {
    info.frequency = static_cast<float>(options.frequency_khz * 1000);
    info.sound_speed = ping.speed_of_sound;
    fillWidths(ping.beam_height, info.tx_beamwidths);
    fillWidths(ping.beam_width, info.rx_beamwidths);
}

void fillDirections(const types::Sonar& ping, SensorFrame frame, std::vector<Vector3>& directions) {
    directions.resize(ping.beam_count);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        directions[beam] = directionOf(ping.bearings[beam].rad, frame);
}

/** Of each beam after the ping's stamp; zeros where the beams have no stamps of their own [s]. */
void fillDelays(const types::Sonar& ping, std::vector<float>& delays) {
    delays.resize(ping.beam_count);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        delays[beam] = static_cast<float>((ping.beamStart(beam) - ping.time).seconds());
}

/** From one bearing to the next; 0 for fewer than two [rad]. */
double incrementOf(const types::Sonar& ping) {
    const auto step = [&](size_t k) {
        return types::Angle::fromRad(ping.bearings[k + 1].rad - ping.bearings[k].rad).rad;
    };
    if (ping.beam_count < 2) return 0;
    for (size_t k = 0; k + 1 < ping.bearings.size(); ++k)
        if (!(std::abs(step(k) - step(0)) < 1e-3 * std::abs(step(0))))
            throw std::invalid_argument("the beams do not stand at equal angles from one another, as a LaserScan's do");
    return step(0);
}

}  // namespace

void convert(const types::Sonar& ping, const SonarOptions& options, ProjectedSonarImage& message) {
    fillHeader(ping, options, message.header);
    fillInfo(ping, options, message.ping_info);
    fillDirections(ping, options.frame, message.beam_directions);
    message.ranges.resize(ping.bin_count);
    for (uint32_t bin = 0; bin < ping.bin_count; ++bin) message.ranges[bin] = binCentre(ping, bin);
    fillImage(ping, options, message.image);
}

void convert(const types::Sonar& ping, const SonarOptions& options, RawSonarImage& message) {
    fillHeader(ping, options, message.header);
    fillInfo(ping, options, message.ping_info);
    message.sample_rate = static_cast<float>(1 / (2 * ping.bin_duration.seconds()));
    message.samples_per_beam = ping.bin_count;
    message.sample0 = 0;
    fillDelays(ping, message.tx_delays);
    message.tx_angles.assign(ping.beam_count, 0);
    message.rx_angles.resize(ping.beam_count);
    for (size_t beam = 0; beam < ping.beam_count; ++beam)
        message.rx_angles[beam] = static_cast<float>(-ping.bearings[beam].rad);  // ours are positive to port
    fillImage(ping, options, message.image);
}

void convert(const types::Sonar& ping, const SonarOptions& options, SonarRanges& message) {
    fillHeader(ping, options, message.header);
    fillInfo(ping, options, message.ping_info);
    fillDirections(ping, options.frame, message.beam_unit_vec);
    fillDelays(ping, message.transmit_delays);
    message.flags.assign(ping.beam_count, {DetectionFlag::bad_filter});
    message.intensities.assign(ping.beam_count, 0);
    message.ranges.assign(ping.beam_count, std::numeric_limits<float>::quiet_NaN());
    const DetectionThreshold rule(ping, options);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        if (const auto bin = rule.firstOf(beam)) {
            message.flags[beam].flag = DetectionFlag::ok;
            message.intensities[beam] = ping.bins[size_t{beam} * ping.bin_count + *bin];
            message.ranges[beam] = binCentre(ping, *bin);
        }
}

void convert(const types::Sonar& ping, const SonarOptions& options, PointCloud2& message) {
    fillHeader(ping, options, message.header);
    beginCloud({"x", "y", "z", "intensity"}, message);
    const DetectionThreshold rule(ping, options);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam) {
        if (ping.bearings[beam].isUnknown()) continue;
        const Vector3 direction = directionOf(ping.bearings[beam].rad, SensorFrame::XForward);
        const float x = static_cast<float>(direction.x), y = static_cast<float>(direction.y),
                    z = static_cast<float>(direction.z);
        for (uint32_t bin = 0; bin < ping.bin_count; ++bin)
            if (const float echo = ping.bins[size_t{beam} * ping.bin_count + bin]; rule.isReturn(echo)) {
                const float range = binCentre(ping, bin);
                addPoint({x * range, y * range, z * range, echo}, message);
            }
    }
    endCloud(1, message);
}

void convert(const types::Sonar& ping, const SonarOptions& options, LaserScan& message) {
    fillHeader(ping, options, message.header);
    const double increment = incrementOf(ping), first = ping.beam_count > 0 ? ping.bearings[0].rad : 0;
    message.angle_min = static_cast<float>(first);
    message.angle_increment = static_cast<float>(increment);
    message.angle_max = static_cast<float>(first + increment * (ping.beam_count > 0 ? ping.beam_count - 1 : 0));
    message.range_min = 0;
    message.range_max = static_cast<float>(ping.binStart(ping.bin_count));
    message.ranges.assign(ping.beam_count, std::numeric_limits<float>::infinity());
    message.intensities.assign(ping.beam_count, 0);
    const DetectionThreshold rule(ping, options);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        if (const auto bin = rule.firstOf(beam)) {
            message.ranges[beam] = binCentre(ping, *bin);
            message.intensities[beam] = ping.bins[size_t{beam} * ping.bin_count + *bin];
        }
}

}  // namespace insonify::ros
