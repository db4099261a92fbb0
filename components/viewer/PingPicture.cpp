#include "components/viewer/PingPicture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "types/geometry/BeamArc.hpp"

namespace insonify::viewer {
namespace {

constexpr float nothing_db = -10000;

nlohmann::json findEdges(const types::BeamArc& arc) {
    nlohmann::json edges = nlohmann::json::array();
    for (const auto& [right, left] : arc.sectors()) edges.insert(edges.end(), {right, left});
    return edges;
}

/** Replaces NaN, which JSON cannot represent. */
double orZero(double value) { return std::isfinite(value) ? value : 0; }

/** Returns the middle of the floats that begin with these bits. */
float computeLevel(uint32_t bits) {
    const float value = std::bit_cast<float>(bits << 16 | 0x8000);
    return value > 0 && std::isfinite(value) ? 10 * std::log10(value) : nothing_db;
}

}  // namespace

std::string pageMessage(uint32_t kind, std::string json, const std::string& data) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const uint32_t head[] = {kind, static_cast<uint32_t>(json.size())};
    std::string message(sizeof head, '\0');
    std::memcpy(message.data(), head, sizeof head);
    return message + json + data;
}

PingPicture::PingPicture(ros::BinScale scale) : scale_(scale), levels_(std::make_unique<std::array<float, 65536>>()) {
    for (uint32_t bits = 0; bits < levels_->size(); ++bits) (*levels_)[bits] = computeLevel(bits);
}

float PingPicture::decibels(float bin) const {
    if (scale_ == ros::BinScale::Linear) return (*levels_)[std::bit_cast<uint32_t>(bin) >> 16];
    return std::isfinite(bin) ? bin : nothing_db;
}

std::string PingPicture::encode(const types::Sonar& ping, const PictureNote& note) const {
    const uint32_t pool = (ping.bin_count + max_bins - 1) / max_bins;
    const uint32_t bins = pool > 0 ? (ping.bin_count + pool - 1) / pool : 0;
    const types::BeamArc arc(ping, lone_beam_width);
    std::vector<float> levels(size_t{bins} * arc.beams.size(), nothing_db);
    for (size_t row = 0; row < arc.beams.size(); ++row)
        for (uint32_t bin = 0; bin < ping.bin_count; ++bin) {
            float& level = levels[row * bins + bin / pool];
            level = std::max(level, decibels(ping.bins[size_t{arc.beams[row]} * ping.bin_count + bin]));
        }
    float top = nothing_db;
    for (const float level : levels) top = std::max(top, level);
    std::string data(levels.size(), '\0');
    for (size_t i = 0; i < levels.size(); ++i)
        data[i] = static_cast<char>(
            static_cast<uint8_t>(std::max(0.0f, std::round(255 - (top - levels[i]) / float{step_db}))));
    if (top == nothing_db) data.assign(data.size(), '\0');
    const nlohmann::json json = {{"source", note.source},
                                 {"time_us", ping.time.microseconds},
                                 {"count", note.count},
                                 {"latency_s", orZero(note.latency_s)},
                                 {"beams", arc.beams.size()},
                                 {"bins", bins},
                                 {"bin_m", orZero(ping.binStart(pool))},
                                 {"top_db", top == nothing_db ? 0 : top},
                                 {"step_db", step_db},
                                 {"beam_width", orZero(ping.beam_width.rad)},
                                 {"beam_height", orZero(ping.beam_height.rad)},
                                 {"bearings", arc.bearings},
                                 {"edges", findEdges(arc)}};
    return pageMessage(ping_kind, json.dump(), data);
}

}  // namespace insonify::viewer
