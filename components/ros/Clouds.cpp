#include "components/ros/Clouds.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "components/ros/Poses.hpp"
#include "components/ros/Stamps.hpp"
#include "types/Samples.hpp"
#include "types/WorldPlaces.hpp"

namespace insonify::ros {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/** Reads one field of a cloud's points. */
class FieldReader {
public:
    /** Throws std::invalid_argument if the cloud lacks the field, or it does not have 32 or 64 bits. */
    FieldReader(const PointCloud2& cloud, const char* name) : cloud_(cloud) {
        const auto field =
            std::ranges::find_if(cloud.fields, [&](const PointField& candidate) { return candidate.name == name; });
        if (field == cloud.fields.end()) throw std::invalid_argument(std::string("the cloud has no field ") + name);
        if (field->datatype != PointField::float32 && field->datatype != PointField::float64)
            throw std::invalid_argument(std::string("field ") + name + " of the cloud is neither FLOAT32 nor FLOAT64");
        double_ = field->datatype == PointField::float64;
        offset_ = field->offset;
        if (uint64_t{offset_} + (double_ ? sizeof(double) : sizeof(float)) > cloud.point_step)
            throw std::invalid_argument(std::string("field ") + name + " reaches beyond its point");
    }
    double operator()(size_t row, size_t column) const {
        const uint8_t* const at = cloud_.data.data() + row * cloud_.row_step + column * cloud_.point_step + offset_;
        return double_ ? read<double>(at) : static_cast<double>(read<float>(at));
    }

private:
    template <class T>
    static T read(const uint8_t* at) {
        T value;
        std::memcpy(&value, at, sizeof value);
        return value;
    }
    const PointCloud2& cloud_;
    uint32_t offset_ = 0;
    bool double_ = false;
};

template <class Number>
void append(Number number, std::vector<uint8_t>& bytes) {
    const auto* const begin = reinterpret_cast<const uint8_t*>(&number);
    bytes.insert(bytes.end(), begin, begin + sizeof number);
}

bool hasField(const PointCloud2& cloud, const char* name) {
    return std::ranges::any_of(cloud.fields, [&](const PointField& field) { return field.name == name; });
}

void requirePoints(const PointCloud2& cloud) {
    if (cloud.is_bigendian) throw std::invalid_argument("big-endian points are not read");
    const uint64_t row = uint64_t{cloud.width} * cloud.point_step, rows = cloud.height;
    if (rows > 0 && (row > cloud.row_step || (rows - 1) * cloud.row_step + row > cloud.data.size()))
        throw std::invalid_argument("the cloud does not hold the points that it announces");
}

}  // namespace

void beginCloud(std::initializer_list<const char*> fields, PointCloud2& message) {
    message.fields.clear();
    message.point_step = 0;
    for (const char* name : fields) {
        message.fields.push_back({name, message.point_step, PointField::float32, 1});
        message.point_step += sizeof(float);
    }
    message.data.clear();
    message.is_dense = true;
}

void addPoint(std::initializer_list<float> numbers, PointCloud2& message) {
    const size_t at = message.data.size(), size = numbers.size() * sizeof(float);
    message.data.resize(at + size);
    std::memcpy(message.data.data() + at, numbers.begin(), size);
}

void endCloud(uint32_t rows, PointCloud2& message) {
    message.height = rows;
    message.row_step = rows > 0 ? static_cast<uint32_t>(message.data.size()) / rows : 0;
    message.width = message.row_step / message.point_step;
}

void convert(const types::PointCloud& cloud, WorldFrame frame, PointCloud2& message) {
    types::requireSound(cloud, "the cloud");
    message.header.stamp = toRos(cloud.time);
    message.header.frame_id = "map";
    const bool is_far = std::ranges::any_of(cloud.points, types::isFarOut);
    const uint32_t size = is_far ? sizeof(double) : sizeof(float);
    beginCloud({}, message);
    for (const char* name : {"x", "y", "z"}) {
        message.fields.push_back({name, message.point_step, is_far ? PointField::float64 : PointField::float32, 1});
        message.point_step += size;
    }
    message.fields.push_back({"intensity", message.point_step, PointField::float32, 1});
    message.point_step += sizeof(float);
    for (size_t k = 0; k < cloud.points.size(); ++k) {
        const glm::dvec3 p = worldFromRock(frame, cloud.points[k]);
        for (int axis = 0; axis < 3; ++axis)
            is_far ? append(p[axis], message.data) : append(static_cast<float>(p[axis]), message.data);
        append(static_cast<float>(cloud.intensity(k)), message.data);
    }
    endCloud(1, message);
}

void convert(const PointCloud2& message, WorldFrame frame, types::PointCloud& cloud) {
    requirePoints(message);
    cloud.time = fromRos(message.header.stamp);
    cloud.clear();
    const FieldReader x(message, "x"), y(message, "y"), z(message, "z");
    const bool has_intensity = hasField(message, "intensity");
    const FieldReader intensity(message, has_intensity ? "intensity" : "x");
    for (size_t row = 0; row < message.height; ++row)
        for (size_t column = 0; column < message.width; ++column) {
            const glm::dvec3 point = rockFromWorld(frame, {x(row, column), y(row, column), z(row, column)});
            if (has_intensity)
                cloud.add(point, intensity(row, column));
            else
                cloud.points.push_back(point);
        }
}

void convert(const types::DepthMap& map, const std::string& frame_id, PointCloud2& message) {
    types::requireSound(map, "the map");
    const bool polar =
        map.vertical_projection == types::Projection::Polar && map.horizontal_projection == types::Projection::Polar;
    if (!polar || map.vertical_interval.size() != map.vertical_size ||
        map.horizontal_interval.size() != map.horizontal_size)
        throw std::invalid_argument("points are made of polar maps with an angle for each row and column only");
    message.header.stamp = toRos(map.time);
    message.header.frame_id = frame_id;
    beginCloud({"x", "y", "z", "intensity", "range", "azimuth", "elevation"}, message);
    for (size_t row = 0; row < map.vertical_size; ++row)
        for (size_t column = 0; column < map.horizontal_size; ++column) {
            const size_t cell = row * map.horizontal_size + column;
            const float range = map.distances[cell];
            const glm::vec3 p =
                std::isfinite(range) ? glm::vec3(map.direction(row, column)) * range : glm::vec3(not_a_number);
            message.is_dense = message.is_dense && std::isfinite(range);
            addPoint(
                {p.x, p.y, p.z, map.remissions.empty() ? 0 : map.remissions[cell], range,
                 static_cast<float>(map.horizontal_interval[column]), static_cast<float>(-map.vertical_interval[row])},
                message);
        }
    endCloud(map.vertical_size, message);
}

void convert(const PointCloud2& message, types::DepthMap& map) {
    requirePoints(message);
    const FieldReader range(message, "range"), azimuth(message, "azimuth"), elevation(message, "elevation"),
        intensity(message, "intensity");
    map.time = fromRos(message.header.stamp);
    map.timestamps.clear();
    map.vertical_projection = map.horizontal_projection = types::Projection::Polar;
    map.vertical_size = message.height;
    map.horizontal_size = message.width;
    map.vertical_interval.clear(), map.horizontal_interval.clear(), map.distances.clear(), map.remissions.clear();
    for (size_t row = 0; row < message.height && message.width > 0; ++row)
        map.vertical_interval.push_back(-elevation(row, 0));
    for (size_t column = 0; column < message.width && message.height > 0; ++column)
        map.horizontal_interval.push_back(azimuth(0, column));
    for (size_t row = 0; row < message.height; ++row)
        for (size_t column = 0; column < message.width; ++column) {
            map.distances.push_back(static_cast<float>(range(row, column)));
            map.remissions.push_back(static_cast<float>(intensity(row, column)));
        }
}

void convert(const types::Range& range, const std::string& frame_id, Range& message) {
    message.header.stamp = toRos(range.time);
    message.header.frame_id = frame_id;
    message.radiation_type = Range::ultrasound;
    message.field_of_view = static_cast<float>(range.field_of_view.rad);
    message.min_range = static_cast<float>(range.range_min);
    message.max_range = static_cast<float>(range.range_max);
    constexpr float nothing = std::numeric_limits<float>::infinity();  // REP 117
    message.range = range.isKnown() ? std::max(message.min_range, static_cast<float>(range.range))
                                    : (range.range == types::Range::too_near ? -nothing : nothing);
    message.variance = 0;
}

void convert(const Range& message, types::Range& range) {
    range.time = fromRos(message.header.stamp);
    range.field_of_view = {static_cast<double>(message.field_of_view)};
    range.range_min = static_cast<double>(message.min_range);
    range.range_max = static_cast<double>(message.max_range);
    const double measured = static_cast<double>(message.range);
    range.range = std::isfinite(measured) || measured < 0 ? measured : types::Range::none;
}

}  // namespace insonify::ros
