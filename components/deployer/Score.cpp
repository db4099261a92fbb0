#include "components/deployer/Score.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "components/deployer/PictureExport.hpp"
#include "components/output/Similarity.hpp"

namespace insonify::deployer {
namespace {

constexpr double same_bearing = 1e-6;  ///< [rad]

bool sameShape(const types::Sonar& a, const types::Sonar& b) {
    const auto near = [](types::Angle x, types::Angle y) { return std::abs(x.rad - y.rad) < same_bearing; };
    return a.beam_count == b.beam_count && a.bin_count == b.bin_count && a.bin_duration == b.bin_duration &&
           a.speed_of_sound == b.speed_of_sound && a.bins.size() == b.bins.size() &&
           std::ranges::equal(a.bearings, b.bearings, near);
}

/** Bins as energies. */
std::vector<float> energies(const types::Sonar& ping, output::BinScale scale) {
    std::vector<float> result = ping.bins;
    for (float& bin : result) {
        if (scale == output::BinScale::Decibel) bin = std::pow(10.f, bin / 10);
        if (std::isnan(bin)) bin = 0;
    }
    return result;
}

/** Samples of a stream by their time; of several of one time the first. */
std::map<types::Time, log::SampleRef> byTime(const log::Reader& log, const std::string& stream) {
    std::map<types::Time, log::SampleRef> samples;
    const size_t index = log.indexOf(stream);
    for (const log::SampleRef& at : log.samples())
        if (at.stream == index) samples.emplace(at.time, at);
    return samples;
}

PingScore scoreOf(const types::Sonar& recorded, const types::Sonar& rendered, const output::DisplayConfig& display) {
    const std::vector<float> truth = energies(recorded, display.scale);
    const study::Layout layout{static_cast<int>(recorded.beam_count), static_cast<int>(recorded.bin_count),
                               recorded.binStart(1), 0};
    PingScore score;
    score.time = recorded.time;
    score.metrics =
        study::compare(energies(rendered, display.scale), std::vector<double>(truth.begin(), truth.end()), layout);
    score.similarity = output::structuralSimilarity(recorded, rendered, display);
    return score;
}

}  // namespace

StreamScore score(log::Reader& recorded, log::Reader& rendered, const std::string& stream) {
    StreamScore result;
    result.stream = stream;
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
        if (!sameShape(before, after) || before.bins.empty()) {
            ++result.other_shape;
        } else {
            if (result.pings.empty()) {
                const log::Stream& shown = recorded.streams()[recorded.indexOf(stream)];
                result.display = displayFor(recorded, shown, before);
            }
            result.pings.push_back(scoreOf(before, after, result.display));
            result.pings.back().recorded = at;
            result.pings.back().rendered = other->second;
        }
        others.erase(other);
    }
    result.not_recorded = others.size();
    std::ranges::stable_sort(result.pings, std::greater(), [](const PingScore& ping) { return ping.metrics.rel_l2; });
    return result;
}

}  // namespace insonify::deployer
