#include "components/console/ProgressLine.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>

#include "components/console/Console.hpp"

namespace insonify::console {

ProgressLine::ProgressLine(bool wanted) : shown_(wanted && isatty(STDERR_FILENO)) {
    if (shown_) startPrinting();
}

ProgressLine::~ProgressLine() {
    if (shown_) showProgress("");
}

void ProgressLine::show(double wall_s, const std::string& text) {
    if (!shown_ || wall_s < next_s_) return;
    next_s_ = wall_s + 0.1;
    showProgress(text);
}

StudyProgress::StudyProgress(bool wanted, size_t total) : shown_(wanted && isatty(STDERR_FILENO)), total_(total) {
    if (shown_) startPrinting();
}

void StudyProgress::operator()(const std::string& at) {
    if (!shown_) return;
    const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const std::string count = total_ > 0 ? fmt::format(", {} of {} done", done_, total_) : "";
    const double share = total_ > 0 ? static_cast<double>(done_) / static_cast<double>(total_) : 0;
    showProgress(fmt::format("{}{}, {} so far{}", at, count, durationText(wall_s), timeLeft(share, wall_s)));
}

void StudyProgress::end() {
    if (shown_) showProgress("");
}

std::string durationText(double seconds) {
    const auto whole = static_cast<int64_t>(std::ceil(seconds));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string timeLeft(double share, double wall_s) {
    if (!(share > 0) || share >= 1) return "";
    return fmt::format(", {:.0f} % done, {} left", std::floor(100 * share), durationText(wall_s * (1 - share) / share));
}

}  // namespace insonify::console
