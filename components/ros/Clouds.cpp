#include "components/ros/Clouds.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "components/ros/Pings.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Stamps.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/samples/Samples.hpp"

namespace insonify::ros {
namespace {

constexpr double nothing_db = -3000;

double computeLevel(double bin, BinScale scale) {
    if (scale == BinScale::Decibel) return std::isnan(bin) ? nothing_db : bin;
    return bin > 0 ? 10 * std::log10(bin) : nothing_db;
}

float binAt(double level_db, BinScale scale) {
    return static_cast<float>(scale == BinScale::Decibel ? level_db : std::pow(10, level_db / 10));
}

/** Calls `put(place, bin)` for each bin of the ping, in ascending order of places. */
void inOrder(const types::Sonar& ping, ImageOrder order, auto&& put) {
    if (order == ImageOrder::BeamMajor) {
        for (size_t i = 0; i < ping.bins.size(); ++i) put(i, ping.bins[i]);
        return;
    }
    size_t place = 0;
    for (uint32_t bin = 0; bin < ping.bin_count; ++bin)
        for (size_t beam = 0; beam < ping.beam_count; ++beam) put(place++, ping.bins[beam * ping.bin_count + bin]);
}

/** Quantises bins to levels of eight bits: 255 + (level - reference) * per_db, rounded. To avoid a logarithm per linear
 *  bin, it compares with the min bin of every level. The first 16 bits of a float give the level at which the search
 *  starts. */
class LevelQuantiser {
public:
    LevelQuantiser(const types::Sonar& ping, const SonarOptions& options)
        : scale_(options.scale), reference_(referenceDb(ping, options)), per_db_(255 / options.dynamic_range_db) {
        if (scale_ == BinScale::Decibel) return;
        for (size_t level = 1; level < 256; ++level)
            minimum_[level] = binAt(reference_ + (static_cast<double>(level) - 255.5) / per_db_, scale_);
        first_ = findCell(minimum_[1]);
        last_ = findCell(minimum_[255]);
        uint8_t level = 0;
        for (uint32_t cell = first_; cell <= last_; ++cell)
            begin_[cell] = level = above(level, std::bit_cast<float>(cell << 16));
    }

    uint8_t operator()(float bin) const {
        if (scale_ == BinScale::Decibel) return ofDecibels(bin);
        if (!(bin > 0) || findCell(bin) < first_) return 0;
        return above(begin_[std::min(findCell(bin), last_)], bin);
    }

private:
    static uint32_t findCell(float bin) { return std::bit_cast<uint32_t>(bin) >> 16; }
    /** Returns the level of a bin whose level is at least `level`. */
    uint8_t above(uint8_t level, float bin) const {
        while (level < 255 && bin >= minimum_[level + 1u]) ++level;
        return level;
    }
    uint8_t ofDecibels(float bin) const {
        const double level = computeLevel(static_cast<double>(bin), scale_);
        if (level <= nothing_db) return 0;
        return static_cast<uint8_t>(std::lround(std::clamp(255 + (level - reference_) * per_db_, 0.0, 255.0)));
    }

    BinScale scale_;
    double reference_, per_db_;
    std::array<float, 256> minimum_{};  ///< Min bin of each level; ascending.
    uint32_t first_ = 0, last_ = 0;  ///< Range of cells that contain several levels. A cell is the positive floats with
                                     ///< the same first 16 bits.
    std::array<uint8_t, 32768> begin_;  ///< Level of the min float in each cell.
};

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

double referenceDb(const types::Sonar& ping, const SonarOptions& options) {
    if (options.reference_db) return *options.reference_db;
    float strongest = -std::numeric_limits<float>::infinity();
    for (const float bin : ping.bins) strongest = bin > strongest ? bin : strongest;  // false for NaN
    return std::clamp(computeLevel(static_cast<double>(strongest), options.scale), nothing_db, -nothing_db);
}

Vector3 computeDirection(double bearing_rad, SensorFrame frame) {
    const double ahead = std::cos(bearing_rad), port = std::sin(bearing_rad);
    return frame == SensorFrame::ZForward ? Vector3{0, -port, ahead} : Vector3{ahead, port, 0};
}

namespace {

const types::ReturnLevels& computeLevels(const types::Sonar& ping, const SonarOptions& options) {
    static thread_local types::ReturnLevels levels;  // reuses its memory
    types::ReturnRules rules = options.returns;
    rules.range_min = rangeMin(options);
    levels.take(ping, ping.bin_count, rules);
    return levels;
}

}  // namespace

double rangeMin(const SonarOptions& options) { return options.range_min.value_or(options.returns.range_min); }

DetectionThreshold::DetectionThreshold(const types::Sonar& ping, const SonarOptions& options)
    : ping_(ping),
      levels_(computeLevels(ping, options)),
      is_linear_(options.scale == BinScale::Linear),
      is_absolute_(options.reference_db.has_value()) {
    if (!is_linear_) {
        minimum_ = static_cast<double>(std::max(binAt(referenceDb(ping, options) + options.threshold_db, options.scale),
                                                std::nextafter(static_cast<float>(nothing_db), 0.0f)));
        return;
    }
    double reference = is_absolute_ ? std::pow(10, *options.reference_db / 10) : 0;
    for (size_t i = 0; !is_absolute_ && i < ping.bins.size(); ++i)
        reference = std::max(reference, levels_.unblanked(i % ping.bin_count, static_cast<double>(ping.bins[i])));
    reference = std::min(reference, std::numeric_limits<double>::max());
    minimum_ = std::max(reference * std::pow(10, options.threshold_db / 10), std::numeric_limits<double>::denorm_min());
}

std::optional<uint32_t> DetectionThreshold::findFirst(uint32_t beam) const {
    const float* bins = ping_.bins.data() + size_t{beam} * ping_.bin_count;
    for (uint32_t k = 0; k < ping_.bin_count; ++k)
        if (isReturn(k, bins[k])) return k;
    return std::nullopt;
}

bool DetectionThreshold::isTooNear(uint32_t beam) const {
    const float* bins = ping_.bins.data() + size_t{beam} * ping_.bin_count;
    if (findFirst(beam)) return false;
    for (size_t k = 0; k < levels_.first(); ++k)
        if (is_linear_ ? levels_.unblanked(k, static_cast<double>(bins[k])) >= minimum_
                       : bins[k] >= static_cast<float>(minimum_))
            return true;
    return false;
}

void fillImage(const types::Sonar& ping, const SonarOptions& options, SonarImageData& image) {
    image.beam_count = ping.beam_count;
    if (options.dtype == ImageType::Uint8) {
        image.dtype = SonarImageData::uint8;
        image.data.resize(ping.bins.size());
        inOrder(ping, options.order, [&, level = LevelQuantiser(ping, options)](size_t place, float bin) {
            image.data[place] = level(bin);
        });
    } else {
        image.dtype = SonarImageData::float32;
        image.data.resize(ping.bins.size() * sizeof(float));
        inOrder(ping, options.order, [&](size_t place, float bin) {
            std::memcpy(image.data.data() + place * sizeof bin, &bin, sizeof bin);
        });
    }
}

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
