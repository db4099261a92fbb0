#include "components/study/likeness/Likeness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>

#include "components/output/PictureFiles.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::study {
namespace {

constexpr size_t patch = 16;             ///< Bins and beams of a patch.
constexpr double quarters_alike = 0.25;  ///< Max relative difference of a quarter's mean from the patch's mean [1].
constexpr double clipped_at_max = 0.02;  ///< Max fraction of a patch's bins with code 0 or the max code [1].
constexpr double seen_arc_db = 3;        ///< Min level of an arc above its surroundings.
constexpr size_t targets = 5;            ///< Number of targets whose arcs are examined.

double median(std::vector<double> values) {
    if (values.empty()) return NAN;
    const auto middle = values.begin() + static_cast<long>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? NAN : sum / static_cast<double>(values.size());
}

double decibels(double power) { return 10 * std::log10(std::max(power, 1e-30)); }

/** The data of the statistics: intensity and amplitude relative to the max code. */
class Picture {
public:
    explicit Picture(const CodedPing& ping) : ping_(ping) {
        for (const float code : ping.codes) intensity_.push_back(std::pow(10, ping.levelDb(code) / 10));
    }
    size_t beams() const { return ping_.beam_count; }
    size_t bins() const { return ping_.bin_count; }
    double intensity(size_t beam, size_t bin) const { return intensity_[beam * ping_.bin_count + bin]; }
    double amplitude(size_t beam, size_t bin) const { return std::sqrt(intensity(beam, bin)); }
    bool isClipped(size_t beam, size_t bin) const {
        const float code = ping_.code(beam, bin);
        return code <= 0 || code >= maximum_;
    }

private:
    const CodedPing& ping_;
    std::vector<double> intensity_;
    float maximum_ = 254.0f / 255;
};

void addCodes(const CodedPing& ping, Looks& looks) {
    const auto count = static_cast<double>(ping.codes.size());
    for (const float code : ping.codes) {
        const double of_255 = std::clamp(255.0 * static_cast<double>(code), 0.0, 255.0);
        looks.histogram[static_cast<size_t>(std::lround(of_255))] += 1 / count;
        looks.zeros += code <= 0 ? 1 / count : 0;
        looks.saturated += of_255 >= 254 - 1e-3 ? 1 / count : 0;
    }
    std::vector<float> sorted = ping.codes;
    std::ranges::sort(sorted);
    const auto at = [&](double percent) {
        return sorted[std::min(sorted.size() - 1, static_cast<size_t>(percent / 100 * count))];
    };
    for (size_t i = 0; i < shown_percentiles.size(); ++i)
        looks.percentiles[i] = 255 * static_cast<double>(at(shown_percentiles[i]));
    looks.dynamic_range_db = ping.levelDb(at(99.5)) - ping.levelDb(at(5));
}

void addFallOff(const CodedPing& ping, const Picture& picture, Looks& looks) {
    for (size_t slice = 0; slice < range_slices; ++slice) {
        const size_t from = slice * ping.bin_count / range_slices, to = (slice + 1) * ping.bin_count / range_slices;
        double codes = 0, intensities = 0;
        for (size_t beam = 0; beam < ping.beam_count; ++beam)
            for (size_t bin = from; bin < to; ++bin) {
                codes += static_cast<double>(ping.code(beam, bin));
                intensities += picture.intensity(beam, bin);
            }
        const auto count = static_cast<double>((to - from) * ping.beam_count);
        looks.mean_code[slice] = 255 * codes / count;
        looks.level_db[slice] = decibels(intensities / count);
    }
}

/** Bins and beams from (beam, bin) on that may be one kind of bottom. */
struct Patch {
    const Picture& picture;
    size_t beam, bin;

    double amplitude(size_t i, size_t j) const { return picture.amplitude(beam + i, bin + j); }
    double computeMean(size_t from_i, size_t from_j, size_t size) const {
        double sum = 0;
        for (size_t i = 0; i < size; ++i)
            for (size_t j = 0; j < size; ++j) sum += amplitude(from_i + i, from_j + j);
        return sum / static_cast<double>(size * size);
    }
    bool isHomogeneous() const {
        size_t clipped = 0;
        for (size_t i = 0; i < patch; ++i)
            for (size_t j = 0; j < patch; ++j) clipped += picture.isClipped(beam + i, bin + j);
        if (static_cast<double>(clipped) > clipped_at_max * patch * patch) return false;
        const double all = computeMean(0, 0, patch);
        for (const size_t i : {size_t{0}, patch / 2})
            for (const size_t j : {size_t{0}, patch / 2})
                if (std::abs(computeMean(i, j, patch / 2) - all) > quarters_alike * all) return false;
        return true;
    }
};

/** Adds contrast and correlations of homogeneous patches. */
void addSpeckle(const Picture& picture, Looks& looks) {
    std::vector<double> contrast, along, across;
    for (size_t beam = 0; beam + patch <= picture.beams(); beam += patch)
        for (size_t bin = 0; bin + patch <= picture.bins(); bin += patch) {
            const Patch each{picture, beam, bin};
            if (!each.isHomogeneous()) continue;
            ++looks.patches;
            const double all = each.computeMean(0, 0, patch);
            double squares = 0, in_range = 0, in_beams = 0;
            for (size_t i = 0; i < patch; ++i)
                for (size_t j = 0; j < patch; ++j) {
                    const double here = each.amplitude(i, j) - all;
                    squares += here * here;
                    if (j + 1 < patch) in_range += here * (each.amplitude(i, j + 1) - all);
                    if (i + 1 < patch) in_beams += here * (each.amplitude(i + 1, j) - all);
                }
            contrast.push_back(std::sqrt(squares / (patch * patch)) / all);
            if (!(squares > 1e-12 * all * all)) continue;  // constant
            const double pairs = static_cast<double>(patch - 1) / patch;
            along.push_back(in_range / squares / pairs);
            across.push_back(in_beams / squares / pairs);
        }
    looks.contrast = median(contrast);
    looks.range_correlation = mean(along);
    looks.beam_correlation = mean(across);
}

struct Target {
    size_t beam, bin;
    double intensity;  ///< Mean of the 3 x 3 bins around it.
};

/** Returns the strongest targets, each at a different range. */
std::vector<Target> strongestTargets(const Picture& picture, size_t apart_bins) {
    std::vector<Target> all;
    for (size_t bin = apart_bins; bin + apart_bins < picture.bins(); ++bin) {
        Target best{0, bin, -1};
        for (size_t beam = 1; beam + 1 < picture.beams(); ++beam) {
            double sum = 0;
            for (size_t i = beam - 1; i <= beam + 1; ++i)
                for (size_t j = bin - 1; j <= bin + 1; ++j) sum += picture.intensity(i, j) / 9;
            if (sum > best.intensity) best = {beam, bin, sum};
        }
        all.push_back(best);
    }
    std::ranges::stable_sort(all, std::greater{}, &Target::intensity);
    std::vector<Target> chosen;
    for (const Target& target : all) {
        const auto isNear = [&](const Target& other) {
            return std::max(target.bin, other.bin) - std::min(target.bin, other.bin) <= 2 * apart_bins;
        };
        if (chosen.size() < targets && std::ranges::none_of(chosen, isNear)) chosen.push_back(target);
    }
    return chosen;
}

/** Returns the median intensity of the beams next to a target, from 1/32 to 1/4 of all beams away, in bins [from,
 *  to]. */
double levelNear(const Picture& picture, const Target& target, size_t from, size_t to) {
    const size_t near = std::max<size_t>(4, picture.beams() / 32), far = picture.beams() / 4;
    std::vector<double> values;
    for (size_t beam = 0; beam < picture.beams(); ++beam) {
        const size_t away = std::max(beam, target.beam) - std::min(beam, target.beam);
        if (away < near || away > far) continue;
        for (size_t bin = from; bin <= to; ++bin) values.push_back(picture.intensity(beam, bin));
    }
    return median(std::move(values));
}

void addArcs(const Picture& picture, Looks& looks) {
    const size_t apart_bins = std::max<size_t>(6, picture.bins() / 64);
    std::vector<double> arcs, excess;
    for (const Target& target : strongestTargets(picture, apart_bins)) {
        const double at = levelNear(picture, target, target.bin - 1, target.bin + 1);
        const double nearer = levelNear(picture, target, target.bin - apart_bins, target.bin - apart_bins / 2);
        const double farther = levelNear(picture, target, target.bin + apart_bins / 2, target.bin + apart_bins);
        arcs.push_back(decibels(at) - decibels(target.intensity));
        excess.push_back(decibels(at) - decibels((nearer + farther) / 2));
    }
    looks.arc_db = median(arcs);
    looks.arc_excess_db = median(excess);
}

/** Calls a function with each statistic of two looks. */
void forEachFigure(Looks& a, const Looks& b, const auto& f) {
    for (size_t i = 0; i < code_classes; ++i) f(a.histogram[i], b.histogram[i]);
    for (size_t i = 0; i < shown_percentiles.size(); ++i) f(a.percentiles[i], b.percentiles[i]);
    for (size_t i = 0; i < range_slices; ++i) f(a.mean_code[i], b.mean_code[i]), f(a.level_db[i], b.level_db[i]);
    for (const auto figure :
         {&Looks::zeros, &Looks::saturated, &Looks::dynamic_range_db, &Looks::contrast, &Looks::range_correlation,
          &Looks::beam_correlation, &Looks::arc_db, &Looks::arc_excess_db})
        f(a.*figure, b.*figure);
}

double computeMean(const std::array<double, range_slices>& levels) {
    double sum = 0;
    for (const double level : levels) sum += level / range_slices;
    return sum;
}

/** Returns a ping of the same shape and law with all codes 0. */
CodedPing emptyLike(const CodedPing& like, const char* name) {
    CodedPing ping = like;
    ping.name = name;
    std::ranges::fill(ping.codes, 0.0f);
    return ping;
}

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

Looks computeLooks(const CodedPing& ping) {
    if (ping.beam_count < 2 * patch || ping.bin_count < 4 * patch)
        throw types::ConfigError(
            ping.file, ping.name,
            fmt::format("has {} beams (or lines) x {} bins; these statistics need at least {} x {}, of a sonar of the "
                        "recording's kind",
                        ping.beam_count, ping.bin_count, 2 * patch, 4 * patch));
    Looks looks;
    const Picture picture(ping);
    addCodes(ping, looks);
    addFallOff(ping, picture, looks);
    addSpeckle(picture, looks);
    addArcs(picture, looks);
    return looks;
}

Looks computeMean(const std::vector<Looks>& all) {
    Looks sum;
    for (const Looks& each : all) {
        forEachFigure(sum, each, [&](double& a, double b) { a += b / static_cast<double>(all.size()); });
        sum.patches += each.patches;
    }
    return sum;
}

double earthMoversDistance(const std::array<double, code_classes>& a, const std::array<double, code_classes>& b) {
    double distance = 0, ahead = 0;
    for (size_t i = 0; i < code_classes; ++i) {
        ahead += a[i] - b[i];
        distance += std::abs(ahead);
    }
    return distance;
}

double jensenShannonDivergence(const std::array<double, code_classes>& a, const std::array<double, code_classes>& b) {
    const auto part = [](double p, double q) { return p > 0 ? p * std::log2(p / ((p + q) / 2)) / 2 : 0; };
    double divergence = 0;
    for (size_t i = 0; i < code_classes; ++i) divergence += part(a[i], b[i]) + part(b[i], a[i]);
    return divergence;
}

Apart apart(const Looks& a, const Looks& b) {
    const auto difference = [&](double Looks::*figure) { return std::abs(a.*figure - b.*figure); };
    double squares = 0;
    for (size_t i = 0; i < range_slices; ++i)
        squares += std::pow(a.level_db[i] - computeMean(a.level_db) - (b.level_db[i] - computeMean(b.level_db)), 2);
    return {.emd_codes = earthMoversDistance(a.histogram, b.histogram),
            .js_bits = jensenShannonDivergence(a.histogram, b.histogram),
            .dynamic_range_db = difference(&Looks::dynamic_range_db),
            .zeros = difference(&Looks::zeros),
            .saturated = difference(&Looks::saturated),
            .fall_off_db = std::sqrt(squares / range_slices),
            .contrast = difference(&Looks::contrast),
            .range_correlation = difference(&Looks::range_correlation),
            .beam_correlation = difference(&Looks::beam_correlation),
            .arc_db = difference(&Looks::arc_db)};
}

CodedPing uniformPing(const CodedPing& like, double code) {
    CodedPing ping = emptyLike(like, "uniform");
    std::ranges::fill(ping.codes, static_cast<float>(code / 255));
    return ping;
}

CodedPing cosinePing(const CodedPing& like) {
    CodedPing ping = emptyLike(like, "cosine");
    const double height = 0.25 * static_cast<double>(like.bin_count);  // of the sonar, a quarter of its range [bins]
    for (size_t beam = 0; beam < like.beam_count; ++beam)
        for (size_t bin = 0; bin < like.bin_count; ++bin) {
            const double cosine = height / (static_cast<double>(bin) + 0.5);
            ping.codes[beam * like.bin_count + bin] = cosine > 1 ? 0.0f : static_cast<float>(cosine);
        }
    return ping;
}

std::vector<Claim> claims(const Apart& apart, const Looks& recorded) {
    return {{"histogram: earth mover's distance [codes]", apart.emd_codes, 25.5, true},
            {"histogram: Jensen-Shannon divergence [bit]", apart.js_bits, 0.15, true},
            {"dynamic range, apart by [dB]", apart.dynamic_range_db, 6, true},
            {"share of code 0, apart by", apart.zeros, 0.02, true},
            {"share of saturated codes, apart by", apart.saturated, 0.02, true},
            {"level over range, rms [dB]", apart.fall_off_db, 12, true},
            {"speckle contrast, apart by", apart.contrast, 0.1, true},
            {"correlation of neighbouring bins, apart by", apart.range_correlation, 0.2, true},
            {"correlation of neighbouring beams, apart by", apart.beam_correlation, 0.2, true},
            {"level of arcs next to the strongest, apart by [dB]", apart.arc_db, 10, true,
             recorded.arc_excess_db >= seen_arc_db}};
}

const LikenessRow* LikenessResult::row(const std::string& name) const {
    const auto found = std::ranges::find(rows, name, &LikenessRow::name);
    return found == rows.end() ? nullptr : &*found;
}

LikenessResult studyLikeness(const std::vector<CodedPing>& recorded, const CodedPing* simulated) {
    if (recorded.empty()) throw std::invalid_argument("there is no recorded ping to compare with");
    LikenessResult result;
    std::vector<Looks> looks;
    for (const CodedPing& ping : recorded) looks.push_back(computeLooks(ping));
    result.recorded = computeMean(looks);
    const auto add = [&](const std::string& name, const Looks& each) {
        result.rows.push_back({name, each, apart(each, result.recorded)});
    };
    for (size_t i = 0; i < recorded.size(); ++i) add(recorded[i].name, looks[i]);
    result.shown = {recorded.front()};
    if (simulated) {
        add("simulated", computeLooks(*simulated));
        result.shown.push_back(*simulated);
    }
    double mean_code = 0;
    for (size_t code = 0; code < code_classes; ++code)
        mean_code += static_cast<double>(code) * result.recorded.histogram[code];
    add("uniform", computeLooks(uniformPing(recorded.front(), mean_code)));
    add("cosine", computeLooks(cosinePing(recorded.front())));
    return result;
}

std::vector<LikenessFigure> computeFigures(const LikenessRow& row) {
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

std::string csv(const LikenessResult& result) {
    std::string text = "ping";
    for (const LikenessFigure& figure : computeFigures(result.rows.front())) text += std::string(",") + figure.name;
    for (const LikenessRow& row : result.rows) {
        text += "\n" + row.name;
        for (const LikenessFigure& figure : computeFigures(row)) fmt::format_to(Out(text), ",{:.6g}", figure.value);
    }
    return text + "\n";
}

std::string profilesCsv(const LikenessResult& result) {
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

types::Image drawFans(const std::vector<CodedPing>& pings) {
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
    write(folder / "likeness.csv", csv(result));
    write(folder / "profiles.csv", profilesCsv(result));
    output::writePng(folder / "fans.png", drawFans(result.shown));
}

}  // namespace insonify::study
