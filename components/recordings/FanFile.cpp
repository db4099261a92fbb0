#include "components/recordings/FanFile.hpp"

#include <fmt/format.h>

#include "components/recordings/ArisFile.hpp"
#include "components/recordings/GlfFile.hpp"
#include "types/BeamArc.hpp"
#include "types/ConfigError.hpp"

namespace insonify::recordings {

std::optional<FanFrame> FanFile::next() {
    if (!damage_.empty()) return std::nullopt;
    try {
        std::optional<FanFrame> frame = read();
        if (frame) {
            ++frames_;
            last_ = frame->ping.time;
        }
        return frame;
    } catch (const types::ConfigError& error) {
        if (frames_ == 0) throw;
        const types::Diagnostic& found = error.diagnostics().front();
        damage_ = fmt::format("{}: {}; only the {} earlier pings are read", found.path, found.message, frames_);
        return std::nullopt;
    }
}

std::string FanFile::diagnosticOf(double time_us) const {
    constexpr double year_2200 = 7.26e15;
    if (!(time_us > 0 && time_us < year_2200))
        return fmt::format("the time is {:.6g} s since 1970; it must be above 0 and before the year 2200",
                           time_us * 1e-6);
    const double step = time_us - static_cast<double>(last_.microseconds);
    if (frames_ > 0 && step < 0)
        return fmt::format("the time is {:.6g} s before that of the previous ping", -step * 1e-6);
    return "";
}

void FanFile::setBins(std::span<const double> bearings, uint32_t first, std::span<const char> samples,
                      types::Sonar& ping) {
    std::vector<types::Angle> table;
    for (const double bearing : bearings) table.push_back(types::Angle::fromRad(bearing));
    types::BeamArc arc;
    arc.take(table, {});
    const size_t rows = samples.size() / bearings.size();
    ping.beam_count = static_cast<uint32_t>(arc.beams.size());
    ping.bin_count = first + static_cast<uint32_t>(rows);
    ping.bins.assign(size_t{ping.beam_count} * ping.bin_count, 0);
    float* bin = ping.bins.data();
    for (const uint32_t beam : arc.beams) {
        ping.bearings.push_back(table[beam]);
        bin += first;
        for (size_t row = 0; row < rows; ++row) *bin++ = static_cast<uint8_t>(samples[row * bearings.size() + beam]);
    }
}

std::vector<std::string> FanFile::notices() const {
    std::vector<std::string> all;
    if (!damage_.empty()) all.push_back(damage_);
    for (std::string& notice : RecordingReader::notices()) all.push_back(std::move(notice));
    return all;
}

std::unique_ptr<FanFile> openFan(const std::filesystem::path& path) {
    if (ArisFile::isOne(path)) return std::make_unique<ArisFile>(path);
    if (GlfFile::isOne(path)) return std::make_unique<GlfFile>(path);
    return nullptr;
}

}  // namespace insonify::recordings
