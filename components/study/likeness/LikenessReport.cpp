#include "components/study/likeness/LikenessReport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>

#include "components/output/PictureFiles.hpp"

namespace insonify::study {
namespace {

constexpr int fan_height = 600, gap = 12;  // [pixels]
using Out = std::back_insert_iterator<std::string>;

/** Maps pixels to bins of a fan with some half-opening; the lines of a waterfall are side by side. */
class Fan {
public:
    explicit Fan(const CodedPing& ping) : ping_(ping) {
        if (ping.is_waterfall) {
            half_ = 0;
            width_ = static_cast<int>(ping.beam_count);
            return;
        }
        const auto [minimum, maximum] = std::ranges::minmax(ping.bearings);
        half_ = std::min(std::max(std::abs(minimum), std::abs(maximum)), 0.5 * std::numbers::pi);
        width_ = static_cast<int>(std::ceil(2 * fan_height * std::sin(half_))) + 2;
        order_.resize(ping.bearings.size());
        for (size_t i = 0; i < order_.size(); ++i) order_[i] = i;
        std::ranges::sort(order_, {}, [&](size_t beam) { return ping.bearings[beam]; });
    }
    int width() const { return width_; }

    uint8_t at(int x, int y) const {
        if (ping_.is_waterfall)
            return grey(static_cast<size_t>(x), static_cast<size_t>(fan_height - 1 - y) * ping_.bin_count / fan_height);
        const double ahead = fan_height - y - 0.5, to_port = 0.5 * width_ - x - 0.5;
        const double share = std::hypot(ahead, to_port) / fan_height, bearing = std::atan2(to_port, ahead);
        if (share >= 1 || std::abs(bearing) > half_) return 0;
        const auto bin = static_cast<size_t>(share * static_cast<double>(ping_.bin_count));
        return grey(beamAt(bearing), bin);
    }

private:
    uint8_t grey(size_t beam, size_t bin) const {
        return static_cast<uint8_t>(
            std::lround(255.0 * static_cast<double>(std::clamp(ping_.code(beam, bin), 0.0f, 1.0f))));
    }
    size_t beamAt(double bearing) const {
        const auto above =
            std::ranges::lower_bound(order_, bearing, {}, [&](size_t beam) { return ping_.bearings[beam]; });
        if (above == order_.begin()) return order_.front();
        if (above == order_.end()) return order_.back();
        const size_t low = *(above - 1), high = *above;
        return bearing - ping_.bearings[low] < ping_.bearings[high] - bearing ? low : high;
    }

    const CodedPing& ping_;
    double half_;
    int width_;
    std::vector<size_t> order_;  ///< Beams by bearing.
};

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    if (!(file << text).flush()) throw std::runtime_error(path.string() + " cannot be written");
}

}  // namespace

const LikenessRow* LikenessResult::row(const std::string& name) const {
    const auto found = std::ranges::find(rows, name, &LikenessRow::name);
    return found == rows.end() ? nullptr : &*found;
}

LikenessResult studyLikeness(const std::vector<CodedPing>& recorded, const CodedPing* simulated) {
    if (recorded.empty()) throw std::invalid_argument("there is no recorded ping to compare with");
    LikenessResult result;
    std::vector<Looks> looks;
    for (const CodedPing& ping : recorded) looks.push_back(looksOf(ping));
    result.recorded = meanOf(looks);
    const auto add = [&](const std::string& name, const Looks& each) {
        result.rows.push_back({name, each, apart(each, result.recorded)});
    };
    for (size_t i = 0; i < recorded.size(); ++i) add(recorded[i].name, looks[i]);
    result.shown = {recorded.front()};
    if (simulated) {
        add("simulated", looksOf(*simulated));
        result.shown.push_back(*simulated);
    }
    double mean_code = 0;
    for (size_t code = 0; code < code_classes; ++code)
        mean_code += static_cast<double>(code) * result.recorded.histogram[code];
    add("uniform", looksOf(uniformPing(recorded.front(), mean_code)));
    add("cosine", looksOf(cosinePing(recorded.front())));
    return result;
}

std::vector<LikenessFigure> figuresOf(const LikenessRow& row) {
    const Looks& looks = row.looks;
    const auto& p = looks.percentiles;
    return {{"p1", p[0]},
            {"p5", p[1]},
            {"p25", p[2]},
            {"p50", p[3]},
            {"p75", p[4]},
            {"p95", p[5]},
            {"p99", p[6]},
            {"zeros", looks.zeros},
            {"saturated", looks.saturated},
            {"dynamic_range_db", looks.dynamic_range_db},
            {"patches", static_cast<double>(looks.patches)},
            {"contrast", looks.contrast},
            {"range_correlation", looks.range_correlation},
            {"beam_correlation", looks.beam_correlation},
            {"arc_db", looks.arc_db},
            {"arc_excess_db", looks.arc_excess_db},
            {"emd_codes", row.apart.emd_codes},
            {"js_bits", row.apart.js_bits},
            {"fall_off_apart_db", row.apart.fall_off_db}};
}

std::string csvOf(const LikenessResult& result) {
    std::string text = "ping";
    for (const LikenessFigure& figure : figuresOf(result.rows.front())) text += std::string(",") + figure.name;
    for (const LikenessRow& row : result.rows) {
        text += "\n" + row.name;
        for (const LikenessFigure& figure : figuresOf(row)) fmt::format_to(Out(text), ",{:.6g}", figure.value);
    }
    return text + "\n";
}

std::string profilesCsvOf(const LikenessResult& result) {
    std::string text = "ping,code,share\n";
    for (const LikenessRow& row : result.rows)
        for (size_t code = 0; code < code_classes; ++code)
            fmt::format_to(Out(text), "{},{},{:.6g}\n", row.name, code, row.looks.histogram[code]);
    text += "\nping,range_share,mean_code,level_db\n";
    for (const LikenessRow& row : result.rows)
        for (size_t slice = 0; slice < range_slices; ++slice)
            fmt::format_to(Out(text), "{},{:.6g},{:.6g},{:.6g}\n", row.name,
                           (static_cast<double>(slice) + 0.5) / range_slices, row.looks.mean_code[slice],
                           row.looks.level_db[slice]);
    return text;
}

types::Image fansOf(const std::vector<CodedPing>& pings) {
    std::vector<Fan> fans;
    int width = -gap;
    for (const CodedPing& ping : pings) width += fans.emplace_back(ping).width() + gap;
    types::Image image;
    image.size = {static_cast<uint16_t>(width), static_cast<uint16_t>(fan_height)};
    image.pixel_size = 1;
    image.row_size = image.size.width;
    image.frame_mode = types::ImageMode::Grayscale;
    image.frame_status = types::ImageStatus::Valid;
    image.image.assign(size_t{image.row_size} * fan_height, 0);
    int from = 0;
    for (const Fan& fan : fans) {
        for (int y = 0; y < fan_height; ++y)
            for (int x = 0; x < fan.width(); ++x)
                image.image[static_cast<size_t>(y) * image.row_size + static_cast<size_t>(from + x)] = fan.at(x, y);
        from += fan.width() + gap;
    }
    return image;
}

void writeReport(const LikenessResult& result, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    write(folder / "likeness.csv", csvOf(result));
    write(folder / "profiles.csv", profilesCsvOf(result));
    output::writePng(folder / "fans.png", fansOf(result.shown));
}

}  // namespace insonify::study
