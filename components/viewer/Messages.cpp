#include "components/viewer/Messages.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "components/ros/Cdr.hpp"
#include "components/ros/Clouds.hpp"
#include "components/ros/Stamps.hpp"
#include "components/viewer/PingPicture.hpp"
#include "types/geometry/BeamArc.hpp"
#include "types/samples/SonarScan.hpp"

namespace insonify::viewer {
namespace {

constexpr int directions = 8192;
constexpr double max_covered = 8;

bool same(types::Angle a, types::Angle b) { return a.rad == b.rad || (a.isUnknown() && b.isUnknown()); }

/** Maps bearings to beams, by their place between the outermost edges. */
struct Beams {
    double low = 0, high = 0;
    std::vector<int> beam;  ///< -1: none.

    explicit Beams(const types::Sonar& ping) : beam(directions, -1), arc_(ping, lone_beam_width) {
        const auto sectors = arc_.sectors();
        if (sectors.empty()) return;
        low = sectors.front().right;
        high = sectors.back().left;
        for (size_t i = 0; i < sectors.size(); ++i)
            for (int k = std::max(slot(sectors[i].right), 0); k < std::min(slot(sectors[i].left), directions); ++k)
                beam[static_cast<size_t>(k)] = static_cast<int>(arc_.beams[i]);
    }
    int at(double bearing) const {
        if (arc_.beams.empty()) return -1;
        const int k = slot(arc_.turned(bearing));
        return k >= 0 && k < directions ? beam[static_cast<size_t>(k)] : -1;
    }

private:
    int slot(double bearing) const { return static_cast<int>(std::floor((bearing - low) / (high - low) * directions)); }

    types::BeamArc arc_;
};

/** The extent of the fan in the plane, for a range of 1: x to starboard, y ahead. */
struct Extent {
    double x0 = 0, x1 = 0, y0 = 0, y1 = 0;

    explicit Extent(const Beams& beams) {
        for (int i = 0; i <= 180; ++i) {
            const double bearing = beams.low + (beams.high - beams.low) * i / 180;
            x0 = std::min(x0, -std::sin(bearing));
            x1 = std::max(x1, -std::sin(bearing));
            y0 = std::min(y0, std::cos(bearing));
            y1 = std::max(y1, std::cos(bearing));
        }
    }
};

}  // namespace

bool FanPicture::fits(const types::Sonar& ping) const {
    return ping.bin_count == bin_count_ && ping.binStart(1) == bin_m_ && same(ping.beam_width, beam_width_) &&
           std::ranges::equal(ping.bearings, bearings_, same);
}

void FanPicture::build(const types::Sonar& ping) {
    bearings_ = ping.bearings;
    beam_width_ = ping.beam_width;
    bin_count_ = ping.bin_count;
    bin_m_ = ping.binStart(1);
    const Beams beams(ping);
    const Extent extent(beams);
    const double across = extent.x1 - extent.x0, along = extent.y1 - extent.y0;
    const double pixel = std::max(across, along) / longest_side;  // for a range of 1
    width_ = std::max(1u, static_cast<uint32_t>(across / pixel));
    height_ = std::max(1u, static_cast<uint32_t>(along / pixel));
    table_.assign(size_t{width_} * height_, {});
    const auto covered = static_cast<uint32_t>(std::clamp(std::ceil(pixel * bin_count_), 1.0, max_covered));
    for (uint32_t row = 0; row < height_; ++row)
        for (uint32_t column = 0; column < width_; ++column) {
            const double x = extent.x0 + (column + 0.5) * pixel, y = extent.y1 - (row + 0.5) * pixel;
            const auto bin = static_cast<uint32_t>(std::hypot(x, y) * bin_count_);
            const int beam = beams.at(std::atan2(-x, y));
            if (beam < 0 || bin >= bin_count_) continue;
            table_[size_t{row} * width_ + column] = {static_cast<uint32_t>(beam) * bin_count_ + bin,
                                                     std::min(covered, bin_count_ - bin)};
        }
}

void FanPicture::draw(const types::Sonar& ping, const ros::SonarOptions& options, ros::Image& message) {
    if (!ping.wellShaped() || ping.beam_count == 0)
        throw std::invalid_argument("the lists of the ping are not as long as its counts say, or it has no beams");
    if (!fits(ping)) build(ping);
    ros::SonarOptions levels = options;
    levels.order = ros::ImageOrder::BeamMajor;
    levels.dtype = ros::ImageType::Uint8;
    ros::SonarImageData image;
    ros::fillImage(ping, levels, image);
    message.header = {ros::toRos(ping.time), options.frame_id};
    message.width = message.step = width_;
    message.height = height_;
    message.encoding = "mono8";
    message.data.assign(table_.size(), 0);
    for (size_t i = 0; i < table_.size(); ++i)
        for (uint32_t k = 0; k < table_[i].count; ++k)
            message.data[i] = std::max(message.data[i], image.data[table_[i].first + k]);
}

std::string getTopic(const std::string& source) {
    std::string topic = "/" + source;
    std::ranges::replace(topic, '.', '/');
    return topic;
}

namespace {

/** Returns the transform of a frame in another, from a pose. */
foxglove::FrameTransforms transform(const types::Pose& pose, const std::string& child,
                                    const ros::MessageOptions& options) {
    ros::PoseStamped placed;
    ros::toMessage(pose, options, placed);
    const auto& [position, orientation] = placed.pose;
    return {{{placed.header.stamp, placed.header.frame_id, child, {position.x, position.y, position.z}, orientation}}};
}

const types::Sonar& makePing(const types::Sonar& ping) { return ping; }
types::Sonar makePing(const auto& beams) { return types::toSonar(beams); }

}  // namespace

Messages::Messages(ros::SonarOptions options, ros::WorldFrame world, size_t max_triangles)
    : scene_(world, max_triangles) {
    static_cast<ros::SonarOptions&>(options_) = std::move(options);
    options_.world_frame = world;
}

template <class T>
void Messages::append(const T& sample, Form form, std::vector<char>& bytes) {
    if constexpr (is_ping<T>) {
        if (form == Form::Picture) {
            ros::Image picture;
            picture_.draw(makePing(sample), options_, picture);
            return ros::encode(picture, bytes);
        }
        if (form == Form::Points) {
            ros::PointCloud2 points;
            ros::toMessage(sample, options_, points);
            return ros::encode(points, bytes);
        }
    }
    if constexpr (std::is_same_v<T, types::Pose>) {
        if (form == Form::Transforms) return ros::encode(transform(sample, sample.source_frame, options_), bytes);
    }
    typename ShownMessage<T>::type message;
    if constexpr (std::is_same_v<T, types::Snapshot>) {
        if (form == Form::Transforms) return ros::encode(transform(sample.sonar, options_.frame_id, options_), bytes);
        ros::toMessage(sample.sonar, options_, message);
    } else {
        ros::toMessage(sample, options_, message);
    }
    ros::encode(message, bytes);
}

Bytes Messages::encode(const AnySample& sample, Form form) {
    std::vector<char> bytes;
    std::visit([&](const auto& held) { append(*types::carriedSample(held), form, bytes); }, sample);
    return toBytes({bytes.begin(), bytes.end()});
}

types::Time getStamp(const AnySample& sample, types::Time otherwise) {
    return std::visit(
        [&](const auto& held) {
            const auto* const shown = types::carriedSample(held);
            return shown ? types::sampleTime(*shown, otherwise) : otherwise;
        },
        sample);
}

}  // namespace insonify::viewer
