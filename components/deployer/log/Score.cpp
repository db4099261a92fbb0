#include "components/deployer/log/Score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <ranges>

#include "components/deployer/log/Export.hpp"
#include "components/log/Stream.hpp"
#include "components/output/PictureFiles.hpp"
#include "components/output/pictures/Canvas.hpp"
#include "components/output/pictures/FanImage.hpp"
#include "components/output/pictures/PlainPicture.hpp"

namespace insonify::deployer {
namespace {

constexpr double same_bearing = 1e-6;  ///< [rad]

/** Whether two logs have bins of one width, as far as they state it. In logs of older versions, bins that are not whole
 *  microseconds have the width of their rounded duration.
 *  @param is_stated whether both logs are of one kind */
bool sameBins(const types::Sonar& a, const types::Sonar& b, bool is_stated) {
    constexpr double same_width = 1e-6;  // ranges of messages are floats
    if (!is_stated && a.bin_duration == b.bin_duration) return true;
    return a.sameBins(b) || std::abs(a.binWidth() / b.binWidth() - 1) < same_width;
}

bool sameShape(const types::Sonar& a, const types::Sonar& b, bool is_stated) {
    const auto near = [](types::Angle x, types::Angle y) {
        return std::abs(types::Angle::fromRad(x.rad - y.rad).rad) < same_bearing;
    };
    return a.beam_count == b.beam_count && a.bin_count == b.bin_count && a.bins.size() == b.bins.size() &&
           sameBins(a, b, is_stated) && std::ranges::equal(a.bearings, b.bearings, near);
}

/** Converts bins to energies. */
std::vector<float> energies(const types::Sonar& ping, output::BinScale scale) {
    std::vector<float> result = ping.bins;
    for (float& bin : result) {
        if (scale == output::BinScale::Decibel) bin = std::pow(10.f, bin / 10);
        if (std::isnan(bin)) bin = 0;
    }
    return result;
}

/** Whether a log states the exact width of a stream's bins. */
bool statesBins(const log::Reader& log, const std::string& stream) {
    return !log.streams()[log.findIndex(stream)].metadatum(log::bin_width_key).empty();
}

/** Returns the samples of a stream by time; of equal times the first. */
std::map<types::Time, log::SampleRef> byTime(const log::Reader& log, const std::string& stream) {
    std::map<types::Time, log::SampleRef> samples;
    const size_t index = log.findIndex(stream);
    for (const log::SampleRef& at : log.samples())
        if (at.stream == index) samples.emplace(at.time, at);
    return samples;
}

PingScore computeScore(const types::Sonar& recorded, const types::Sonar& rendered,
                       const output::DisplayConfig& display) {
    const std::vector<float> truth = energies(recorded, display.scale);
    const sonar::Layout layout{static_cast<int>(recorded.beam_count), static_cast<int>(recorded.bin_count),
                               recorded.binStart(1), 0};
    PingScore score;
    score.time = recorded.time;
    score.metrics =
        sonar::compare(energies(rendered, display.scale), std::vector<double>(truth.begin(), truth.end()), layout);
    score.similarity = output::structuralSimilarity(recorded, rendered, display);
    return score;
}

}  // namespace

StreamScore score(log::Reader& recorded, log::Reader& rendered, const std::string& stream) {
    StreamScore result;
    result.stream = stream;
    const bool is_stated = statesBins(recorded, stream) == statesBins(rendered, stream);
    auto others = byTime(rendered, stream);
    types::Sonar before, after;
    for (const auto& [time, at] : byTime(recorded, stream)) {
        const auto other = others.find(time);
        if (other == others.end()) {
            ++result.not_rendered;
            continue;
        }
        recorded.read(at, before);
        rendered.read(other->second, after);
        if (!sameShape(before, after, is_stated) || before.bins.empty()) {
            ++result.other_shape;
        } else {
            if (result.pings.empty()) {
                const log::Stream& shown = recorded.streams()[recorded.findIndex(stream)];
                result.display = displayFor(recorded, shown, before);
            }
            result.pings.push_back(computeScore(before, after, result.display));
            result.pings.back().recorded = at;
            result.pings.back().rendered = other->second;
        }
        others.erase(other);
    }
    result.not_recorded = others.size();
    std::ranges::stable_sort(result.pings, std::greater(), [](const PingScore& ping) { return ping.metrics.rel_l2; });
    return result;
}

namespace {

/** A column: the name for machines, and the heading of the table. */
struct Column {
    const char* key;
    const char* heading;
    double (*value)(const PingScore&);
};

constexpr Column columns[] = {
    {"rel_l2", "relative L2", [](const PingScore& ping) { return ping.metrics.rel_l2; }},
    {"rel_l2_tvg", "with TVG", [](const PingScore& ping) { return ping.metrics.rel_l2_tvg; }},
    {"correlation", "correlation", [](const PingScore& ping) { return ping.metrics.correlation; }},
    {"first_return_bins", "return [bins]", [](const PingScore& ping) { return ping.metrics.first_return_bins; }},
    {"ssim", "SSIM", [](const PingScore& ping) { return ping.similarity; }},
    {"level_distance_db", "levels [dB]", [](const PingScore& ping) { return ping.metrics.level_distance; }},
    {"energy_bias", "energy bias", [](const PingScore& ping) { return ping.metrics.energy_bias; }},
};

void addSummary(std::string& text, const StreamScore& score) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "{}: {} pings compared", score.stream, score.pings.size());
    if (const std::string rest = findOmitted(score); !rest.empty()) text += ", " + rest;
    if (!score.pings.empty())
        fmt::format_to(out, "; relative L2 {:.4g} to {:.4g}, median {:.4g}", score.pings.back().metrics.rel_l2,
                       score.pings.front().metrics.rel_l2, score.pings[score.pings.size() / 2].metrics.rel_l2);
    text += "\n";
}

/** Displays the pings of one log one by one. */
class Screen {
public:
    Screen(log::Reader& log, const types::Sonar& first, const output::DisplayConfig& display) : log_(log) {
        if (first.beam_count == 1)
            painter_ = std::make_unique<output::DiscImage>(display);
        else
            painter_ = std::make_unique<output::FanImage>(display);
    }
    void show(const log::SampleRef& at, bool wanted) {
        log_.read(at, ping_);
        wanted ? painter_->paint(ping_, picture_) : painter_->skip(ping_);
    }
    const types::Image& picture() const { return picture_; }

private:
    log::Reader& log_;
    std::unique_ptr<output::Painter> painter_;
    types::Sonar ping_;
    types::Image picture_;
};

/** Writes the pictures of one stream; `first` is the number of the first picture. */
void writePictures(log::Reader& recorded, log::Reader& rendered, const StreamScore& score, size_t worst, size_t first,
                   const std::filesystem::path& folder) {
    types::Sonar ping;
    recorded.read(score.pings.front().recorded, ping);
    output::DisplayConfig display = score.display;
    display.reference_db = output::referenceLevel(ping, display);
    Screen left(recorded, ping, display), right(rendered, ping, display);

    std::vector<size_t> in_time(score.pings.size());
    for (size_t rank = 0; rank < in_time.size(); ++rank) in_time[rank] = rank;
    std::ranges::sort(in_time, {}, [&](size_t rank) { return score.pings[rank].time; });
    types::Image picture;
    for (const size_t rank : in_time) {
        left.show(score.pings[rank].recorded, rank < worst);
        right.show(score.pings[rank].rendered, rank < worst);
        if (rank >= worst) continue;
        output::sideBySide(
            {left.picture(), score.stream + " as recorded"},
            {right.picture(), fmt::format("rendered again: relative L2 {:.4g}, correlation {:.6g}",
                                          score.pings[rank].metrics.rel_l2, score.pings[rank].metrics.correlation)},
            picture);
        output::writePng(folder / fmt::format("score_{:06}.png", first + rank), picture);
    }
}

}  // namespace

std::string findOmitted(const StreamScore& score) {
    std::vector<std::string> reasons;
    if (score.not_rendered > 0) reasons.push_back(fmt::format("{} not rendered again", score.not_rendered));
    if (score.not_recorded > 0) reasons.push_back(fmt::format("{} not in the log", score.not_recorded));
    if (score.other_shape > 0) reasons.push_back(fmt::format("{} of other beams, bins or range", score.other_shape));
    return fmt::format("{}", fmt::join(reasons, ", "));
}

std::string scoreTable(const std::vector<StreamScore>& streams, size_t worst) {
    std::string text;
    for (const StreamScore& score : streams) {
        addSummary(text, score);
        if (score.pings.empty()) continue;
        text += fmt::format("pings with the largest difference, {} of {}\n", std::min(worst, score.pings.size()),
                            score.pings.size());
        text += fmt::format("{:>26}", "time");
        for (const Column& column : columns) text += fmt::format("{:>14}", column.heading);
        text += "\n";
        for (const PingScore& ping : score.pings | std::views::take(worst)) {
            text += fmt::format("{:>26}", log::readable(ping.time));
            for (const Column& column : columns) text += fmt::format("{:>14.6g}", column.value(ping));
            text += "\n";
        }
    }
    return text;
}

Json scoreJson(const std::vector<StreamScore>& streams) {
    Json all = Json::array();
    for (const StreamScore& score : streams) {
        Json pings = Json::array();
        for (const PingScore& ping : score.pings) {
            Json values{{"time", ping.time.seconds()}};
            for (const Column& column : columns) values[column.key] = column.value(ping);
            pings.push_back(std::move(values));
        }
        const auto scale = types::EnumNames<output::BinScale>::names[static_cast<size_t>(score.display.scale)];
        all.push_back({{"stream", score.stream},
                       {"display", {{"dynamic_range_db", score.display.dynamic_range_db}, {"scale", scale}}},
                       {"compared", score.pings.size()},
                       {"not_rendered", score.not_rendered},
                       {"not_recorded", score.not_recorded},
                       {"other_shape", score.other_shape},
                       {"pings", std::move(pings)}});
    }
    return {{"streams", std::move(all)}};
}

void writeScorePictures(log::Reader& recorded, log::Reader& rendered, const std::vector<StreamScore>& streams,
                        size_t worst, const std::filesystem::path& folder) {
    size_t first = 0;
    for (const StreamScore& score : streams) {
        if (score.pings.empty()) continue;
        writePictures(recorded, rendered, score, worst, first, folder);
        first += std::min(worst, score.pings.size());
    }
}

}  // namespace insonify::deployer
