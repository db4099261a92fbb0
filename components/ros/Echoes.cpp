#include "components/ros/Echoes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "components/ros/Pings.hpp"

namespace insonify::ros {

namespace {

constexpr double nothing_db = -3000;

double levelOf(double bin, BinScale scale) {
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
        first_ = cellOf(minimum_[1]);
        last_ = cellOf(minimum_[255]);
        uint8_t level = 0;
        for (uint32_t cell = first_; cell <= last_; ++cell)
            begin_[cell] = level = above(level, std::bit_cast<float>(cell << 16));
    }

    uint8_t operator()(float bin) const {
        if (scale_ == BinScale::Decibel) return ofDecibels(bin);
        if (!(bin > 0) || cellOf(bin) < first_) return 0;
        return above(begin_[std::min(cellOf(bin), last_)], bin);
    }

private:
    static uint32_t cellOf(float bin) { return std::bit_cast<uint32_t>(bin) >> 16; }
    /** Returns the level of a bin whose level is at least `level`. */
    uint8_t above(uint8_t level, float bin) const {
        while (level < 255 && bin >= minimum_[level + 1u]) ++level;
        return level;
    }
    uint8_t ofDecibels(float bin) const {
        const double level = levelOf(static_cast<double>(bin), scale_);
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

}  // namespace

double referenceDb(const types::Sonar& ping, const SonarOptions& options) {
    if (options.reference_db) return *options.reference_db;
    float strongest = -std::numeric_limits<float>::infinity();
    for (const float bin : ping.bins) strongest = bin > strongest ? bin : strongest;  // false for NaN
    return std::clamp(levelOf(static_cast<double>(strongest), options.scale), nothing_db, -nothing_db);
}

Vector3 directionOf(double bearing_rad, SensorFrame frame) {
    const double ahead = std::cos(bearing_rad), port = std::sin(bearing_rad);
    return frame == SensorFrame::ZForward ? Vector3{0, -port, ahead} : Vector3{ahead, port, 0};
}

namespace {

const types::ReturnLevels& levelsOf(const types::Sonar& ping, const SonarOptions& options) {
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
      levels_(levelsOf(ping, options)),
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

std::optional<uint32_t> DetectionThreshold::firstOf(uint32_t beam) const {
    const float* bins = ping_.bins.data() + size_t{beam} * ping_.bin_count;
    for (uint32_t k = 0; k < ping_.bin_count; ++k)
        if (isReturn(k, bins[k])) return k;
    return std::nullopt;
}

bool DetectionThreshold::isTooNear(uint32_t beam) const {
    const float* bins = ping_.bins.data() + size_t{beam} * ping_.bin_count;
    if (firstOf(beam)) return false;
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

}  // namespace insonify::ros
