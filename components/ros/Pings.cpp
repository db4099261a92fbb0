#include "components/ros/Pings.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "components/ros/Clouds.hpp"
#include "components/ros/Stamps.hpp"
#include "types/geometry/BeamArc.hpp"
#include "types/samples/Samples.hpp"

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

/** @param ping a ping, or the detections of one */
void fillInfo(const auto& ping, const SonarOptions& options, PingInfo& info) {
    info.frequency = static_cast<float>(options.frequency_khz * 1000);
    info.sound_speed = ping.speed_of_sound;
    fillWidths(ping.beam_height, info.tx_beamwidths);
    fillWidths(ping.beam_width, info.rx_beamwidths);
}

void fillDirections(const types::Sonar& ping, SensorFrame frame, std::vector<Vector3>& directions) {
    directions.resize(ping.beam_count);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        directions[beam] = computeDirection(ping.bearings[beam].rad, frame);
}

/** Fills the delay of each beam after the ping's stamp; zeros if the beams have no stamps [s]. */
void fillDelays(const types::Sonar& ping, std::vector<float>& delays) {
    delays.resize(ping.beam_count);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        delays[beam] = static_cast<float>((ping.beamStart(beam) - ping.time).seconds());
}

/** Fills the steering angle of each beam, positive to starboard [rad]. @param bearings positive to port */
void fillReceiveAngles(const std::vector<types::Angle>& bearings, std::vector<float>& angles) {
    angles.resize(bearings.size());
    for (size_t beam = 0; beam < bearings.size(); ++beam) angles[beam] = static_cast<float>(-bearings[beam].rad);
}

/** Fills flags, intensities and the places of the first return of each beam. @param getPlace returns that of a bin */
void fillFirstReturns(const types::Sonar& ping, const SonarOptions& options, auto& message, std::vector<float>& places,
                      auto&& getPlace) {
    message.flags.assign(ping.beam_count, {DetectionFlag::bad_filter});
    message.intensities.assign(ping.beam_count, 0);
    places.assign(ping.beam_count, std::numeric_limits<float>::quiet_NaN());
    const DetectionThreshold rule(ping, options);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        if (const auto bin = rule.findFirst(beam)) {
            message.flags[beam].flag = DetectionFlag::ok;
            message.intensities[beam] = ping.bins[size_t{beam} * ping.bin_count + *bin];
            places[beam] = getPlace(*bin);
        }
}

double stepTo(const types::BeamArc& arc, size_t place) { return arc.bearings[place] - arc.bearings[place - 1]; }

/** Returns the min angle between two neighbouring beams; 0 for fewer than two beams [rad]. */
double minStep(const types::BeamArc& arc) {
    double minimum = arc.beams.size() > 1 ? stepTo(arc, 1) : 0;
    for (size_t place = 2; place < arc.beams.size(); ++place) minimum = std::min(minimum, stepTo(arc, place));
    return minimum;
}

/** Returns the LaserScan's ray for the beam at `place`, if the preceding beam is ray `before`. */
size_t findRay(const types::BeamArc& arc, size_t place, double minimum, size_t before) {
    constexpr double tolerance = 1e-3, max_rays = 16384;
    const double step = stepTo(arc, place), steps = std::round(step / minimum);
    if (!(std::abs(step - steps * minimum) < tolerance * steps * minimum) ||
        static_cast<double>(before) + steps >= max_rays)
        throw std::invalid_argument(
            "the beams are not at equal angles from one another, nor at multiples of the smallest angle, as a "
            "LaserScan needs; send them as PointCloud2 or SonarRanges");
    return before + static_cast<size_t>(steps);
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
    if (!(ping.binSeconds() > 0)) throw std::invalid_argument("bins without a duration have no sample rate");
    message.sample_rate = static_cast<float>(1 / (2 * ping.binSeconds()));
    message.samples_per_beam = ping.bin_count;
    message.sample0 = 0;
    fillDelays(ping, message.tx_delays);
    message.tx_angles.assign(ping.beam_count, 0);
    fillReceiveAngles(ping.bearings, message.rx_angles);
    fillImage(ping, options, message.image);
}

void convert(const types::Sonar& ping, const SonarOptions& options, SonarRanges& message) {
    fillHeader(ping, options, message.header);
    fillInfo(ping, options, message.ping_info);
    fillDirections(ping, options.frame, message.beam_unit_vec);
    fillDelays(ping, message.transmit_delays);
    fillFirstReturns(ping, options, message, message.ranges, [&](uint32_t bin) { return binCentre(ping, bin); });
}

void convert(const types::Sonar& ping, const SonarOptions& options, SonarDetections& message) {
    fillHeader(ping, options, message.header);
    fillInfo(ping, options, message.ping_info);
    fillDelays(ping, message.tx_delays);
    message.tx_angles.assign(ping.beam_count, 0);
    fillReceiveAngles(ping.bearings, message.rx_angles);
    fillFirstReturns(ping, options, message, message.two_way_travel_times,
                     [&](uint32_t bin) { return static_cast<float>(2 * (bin + 0.5) * ping.binSeconds()); });
}

void convert(const types::SonarDetections& detections, const SonarOptions& options, SonarDetections& message) {
    types::requireSound(detections, "it");
    message.header = {toRos(detections.time), options.frame_id};
    fillInfo(detections, options, message.ping_info);
    const size_t beams = detections.bearings.size();
    message.flags.assign(beams, {DetectionFlag::ok});
    message.two_way_travel_times = detections.travel_times;
    message.tx_delays.assign(beams, 0);
    message.intensities = detections.intensities;
    message.tx_angles = detections.elevations;
    fillReceiveAngles(detections.bearings, message.rx_angles);
    for (size_t beam = 0; beam < beams; ++beam)
        if (!std::isfinite(message.two_way_travel_times[beam])) message.flags[beam].flag = DetectionFlag::bad_sonar;
}

void convert(const types::Sonar& ping, const SonarOptions& options, PointCloud2& message) {
    fillHeader(ping, options, message.header);
    beginCloud({"x", "y", "z", "intensity"}, message);
    const DetectionThreshold rule(ping, options);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam) {
        if (ping.bearings[beam].isUnknown()) continue;
        const Vector3 direction = computeDirection(ping.bearings[beam].rad, SensorFrame::XForward);
        const float x = static_cast<float>(direction.x), y = static_cast<float>(direction.y),
                    z = static_cast<float>(direction.z);
        for (uint32_t bin = 0; bin < ping.bin_count; ++bin)
            if (const float echo = ping.bins[size_t{beam} * ping.bin_count + bin]; rule.isReturn(bin, echo)) {
                const float range = binCentre(ping, bin);
                addPoint({x * range, y * range, z * range, echo}, message);
            }
    }
    endCloud(1, message);
}

void convert(const types::Sonar& ping, const SonarOptions& options, LaserScan& message) {
    fillHeader(ping, options, message.header);
    static thread_local types::BeamArc arc;  // reuses its memory
    arc.take(ping);
    const double minimum = minStep(arc);
    const DetectionThreshold rule(ping, options);
    const auto nearest = static_cast<float>(rangeMin(options));
    message.ranges.clear();
    message.intensities.clear();
    for (size_t place = 0, ray = 0; place < arc.beams.size(); ++place) {
        if (place > 0) ray = findRay(arc, place, minimum, ray);
        message.ranges.resize(ray + 1, std::numeric_limits<float>::quiet_NaN());
        message.intensities.resize(ray + 1, 0);
        const auto bin = rule.findFirst(arc.beams[place]);
        constexpr float nothing = std::numeric_limits<float>::infinity();
        // The bin that range_min divides has echoes of its farther part, and readers drop ranges below range_min.
        message.ranges[ray] = bin                                ? std::max(nearest, binCentre(ping, *bin))
                              : rule.isTooNear(arc.beams[place]) ? -nothing
                                                                 : nothing;
        if (bin) message.intensities[ray] = ping.bins[size_t{arc.beams[place]} * ping.bin_count + *bin];
    }
    const size_t rays = message.ranges.size();
    const double first = rays > 0 ? arc.bearings.front() : 0, last = rays > 0 ? arc.bearings.back() : 0;
    message.angle_min = static_cast<float>(first);
    message.angle_increment = rays > 1 ? static_cast<float>((last - first) / static_cast<double>(rays - 1)) : 0;
    message.angle_max = static_cast<float>(last);
    message.range_min = nearest;
    message.range_max = static_cast<float>(ping.binStart(ping.bin_count));
}

namespace {

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument("sonar image: " + why); }

size_t getSize(uint32_t dtype) {
    switch (dtype) {
        case SonarImageData::uint8: return 1;
        case SonarImageData::uint16: return 2;
        case SonarImageData::uint32: return 4;
        case SonarImageData::float32: return 4;
        case SonarImageData::float64: return 8;
        default:
            refuse("dtype " + std::to_string(dtype) + " is not read, only uint8, uint16, uint32, float32, float64");
    }
}

void checkShape(const ProjectedSonarImage& message) {
    const SonarImageData& image = message.image;
    if (message.beam_directions.size() != image.beam_count)
        refuse(std::to_string(message.beam_directions.size()) + " directions for " + std::to_string(image.beam_count) +
               " beams");
    const size_t size = getSize(image.dtype);
    if (image.is_bigendian && size > 1) refuse("big-endian numbers are not read");
    if (image.data.size() / size != message.ranges.size() * image.beam_count || image.data.size() % size != 0)
        refuse(std::to_string(image.data.size()) + " bytes of data for " + std::to_string(image.beam_count) +
               " beams, " + std::to_string(message.ranges.size()) + " ranges and " + std::to_string(size) +
               " bytes a number");
}

/** Returns the width of the bins whose centres are the ranges [m]. */
double binWidth(const std::vector<float>& ranges) {
    const double width = static_cast<double>(ranges.back()) / (static_cast<double>(ranges.size()) - 0.5);
    for (size_t k = 0; k < ranges.size(); ++k) {
        const double expected = (static_cast<double>(k) + 0.5) * width;
        if (!(std::abs(static_cast<double>(ranges[k]) - expected) <= 0.01 * width + 1e-6 * expected))
            refuse("range " + std::to_string(k) + " is " + std::to_string(ranges[k]) +
                   " m; the ranges must be the centres of equal bins from 0 on");
    }
    return width;
}

void readRanges(const ProjectedSonarImage& message, types::Sonar& ping) {
    const double speed = static_cast<double>(message.ping_info.sound_speed);
    static_cast<types::RangeBins&>(ping) = {};
    ping.speed_of_sound = message.ping_info.sound_speed;
    if (message.ranges.empty()) return;
    if (!(speed > 0) || !std::isfinite(speed)) refuse("a speed of sound of " + std::to_string(speed) + " m/s");
    const double width = binWidth(message.ranges), seconds = width / speed;
    if (!(seconds >= 1e-9 && seconds < 1e6)) refuse("bins of " + std::to_string(seconds) + " s");
    ping.setBins(width, speed);
}

double computeBearing(const Vector3& direction, SensorFrame frame) {
    return frame == SensorFrame::ZForward ? std::atan2(-direction.y, direction.z)
                                          : std::atan2(direction.y, direction.x);
}

template <class Number>
float numberAt(const uint8_t* data, size_t place) {
    Number number;
    std::memcpy(&number, data + place * sizeof number, sizeof number);
    if constexpr (std::is_integral_v<Number>)
        return static_cast<float>(static_cast<double>(number) / std::numeric_limits<Number>::max());
    else
        return static_cast<float>(number);
}

template <class Number>
void readBins(const SonarImageData& image, ImageOrder order, types::Sonar& ping) {
    const size_t bins = ping.bin_count, beams = ping.beam_count;
    for (size_t beam = 0; beam < beams; ++beam)
        for (size_t bin = 0; bin < bins; ++bin)
            ping.bins[beam * bins + bin] = numberAt<Number>(
                image.data.data(), order == ImageOrder::RangeMajor ? bin * beams + beam : beam * bins + bin);
}

void readBins(const SonarImageData& image, ImageOrder order, types::Sonar& ping) {
    switch (image.dtype) {
        case SonarImageData::uint8: return readBins<uint8_t>(image, order, ping);
        case SonarImageData::uint16: return readBins<uint16_t>(image, order, ping);
        case SonarImageData::uint32: return readBins<uint32_t>(image, order, ping);
        case SonarImageData::float32: return readBins<float>(image, order, ping);
        default: return readBins<double>(image, order, ping);
    }
}

types::Angle computeWidth(const std::vector<float>& widths) {
    return widths.empty() ? types::Angle{} : types::Angle{static_cast<double>(widths.front())};
}

}  // namespace

void convert(const SonarDetections& message, types::SonarDetections& detections) {
    const size_t beams = message.two_way_travel_times.size();
    const auto require = [&](const char* name, size_t size, bool may_be_empty) {
        if (size != beams && !(may_be_empty && size == 0))
            throw std::invalid_argument("sonar detections: " + std::to_string(size) + " " + name + " for " +
                                        std::to_string(beams) + " travel times");
    };
    require("rx_angles", message.rx_angles.size(), false);
    require("tx_angles", message.tx_angles.size(), true);
    require("flags", message.flags.size(), true);
    require("intensities", message.intensities.size(), true);
    detections.clear();
    detections.time = fromRos(message.header.stamp);
    detections.speed_of_sound = message.ping_info.sound_speed;
    detections.beam_height = computeWidth(message.ping_info.tx_beamwidths);
    detections.beam_width = computeWidth(message.ping_info.rx_beamwidths);
    for (const float angle : message.rx_angles) detections.bearings.push_back({-static_cast<double>(angle)});
    detections.elevations = message.tx_angles;
    detections.travel_times = message.two_way_travel_times;
    detections.intensities = message.intensities;
    detections.elevations.resize(beams);
    detections.intensities.resize(beams);
    for (size_t beam = 0; beam < message.flags.size(); ++beam)
        if (message.flags[beam].flag != DetectionFlag::ok)
            detections.travel_times[beam] = std::numeric_limits<float>::quiet_NaN(), detections.intensities[beam] = 0;
}

void convert(const ProjectedSonarImage& message, const ImageLayout& layout, types::Sonar& ping) {
    checkShape(message);
    ping.time = fromRos(message.header.stamp);
    ping.timestamps.clear();
    readRanges(message, ping);
    ping.beam_height = computeWidth(message.ping_info.tx_beamwidths);
    ping.beam_width = computeWidth(message.ping_info.rx_beamwidths);
    ping.beam_count = message.image.beam_count;
    ping.bin_count = static_cast<uint32_t>(message.ranges.size());
    ping.bearings.resize(ping.beam_count);
    for (size_t beam = 0; beam < ping.beam_count; ++beam)
        ping.bearings[beam] = types::Angle::fromRad(computeBearing(message.beam_directions[beam], layout.frame));
    ping.bins.resize(size_t{ping.bin_count} * ping.beam_count);
    readBins(message.image, layout.order, ping);
}

}  // namespace insonify::ros
