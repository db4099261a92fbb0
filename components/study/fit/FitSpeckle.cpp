#include "components/study/fit/FitSpeckle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

constexpr size_t sectors = 8, sector_beams = 16;  // of the jackknife; beams in a block of overPatches
constexpr size_t lags_of_moments = 3;
constexpr double alike_of_texture = 0.6;  ///< Patches of few scatterers differ within themselves; edges differ more.
constexpr double mostly = 0.75;           ///< Min fraction of the intensity for bins of echoes, or of noise.

/** Returns the mean levels of the 16 x 16 bins about each bin [dB]. */
std::vector<double> levelsAbout(const CodedPing& ping) {
    std::vector<double> levels(ping.codes.size(), -400);
    for (size_t b = 0; b < ping.beam_count; b += sector_beams)
        for (size_t k = 0; k < ping.bin_count; k += sector_beams) {
            const size_t b1 = std::min(b + sector_beams, ping.beam_count),
                         k1 = std::min(k + sector_beams, ping.bin_count);
            double sum = 0;
            for (size_t beam = b; beam < b1; ++beam)
                for (size_t bin = k; bin < k1; ++bin) sum += std::pow(10, ping.levelDb(ping.code(beam, bin)) / 10);
            const double level = 10 * std::log10(std::max(sum / static_cast<double>((b1 - b) * (k1 - k)), 1e-40));
            for (size_t beam = b; beam < b1; ++beam)
                std::fill_n(levels.begin() + static_cast<long>(beam * ping.bin_count + k), k1 - k, level);
        }
    return levels;
}

/** The bins of a field whose fraction of echoes is within bounds, with their mean fraction and range. */
struct Selected {
    SpeckleField field;
    double share = 0, range = 0;
};

Selected select(const CodedPing& ping, const SpeckleField& field, const LevelFit& levels, double low, double high) {
    const std::vector<double> about = levelsAbout(ping);
    Selected selected{.field = field};
    double count = 0;
    for (size_t i = 0; i < field.relative.size(); ++i) {
        if (std::isnan(field.relative[i])) continue;
        const double range = (static_cast<double>(i % field.bin_count) + 0.5) * ping.resolution;
        const double share = levels.echoShare(about[i], range);
        if (share < low || share > high) {
            selected.field.relative[i] = NAN;
            continue;
        }
        ++count;
        selected.share += share;
        selected.range += range;
    }
    selected.share /= std::max(1.0, count);
    selected.range /= std::max(1.0, count);
    return selected;
}

/** Returns the field without the bins of one sector of beams. */
SpeckleField withoutSector(const SpeckleField& field, size_t sector) {
    SpeckleField rest = field;
    for (size_t i = 0; i < rest.relative.size(); ++i)
        if (i / field.bin_count / sector_beams % sectors == sector) rest.relative[i] = NAN;
    return rest;
}

using Moments = std::array<double, 5>;  ///< Beams: three lags, one; bins: three lags, one; texture.

std::optional<Moments> momentsIn(const SpeckleField& field) {
    try {
        const SpeckleFigures figures = computeFigures(field);
        Moments moments{0, figures.across[1], 0, figures.along[1], figures.texture.value};
        for (size_t lag = 1; lag <= lags_of_moments; ++lag) {
            moments[0] += figures.across[lag];
            moments[2] += figures.along[lag];
        }
        return moments;
    } catch (const std::invalid_argument&) {
        return std::nullopt;  // too few bins
    }
}

using MeasuredMoments = std::array<Measured, std::tuple_size_v<Moments>>;

MeasuredMoments jackknifed(const SpeckleField& field, bool with_errors) {
    MeasuredMoments measured;
    const std::optional<Moments> all = momentsIn(field);
    if (all && !with_errors)
        for (size_t i = 0; i < measured.size(); ++i) measured[i] = {(*all)[i], 0};
    if (!with_errors) return measured;
    std::vector<Moments> parts;
    for (size_t sector = 0; all && sector < sectors; ++sector)
        if (const auto part = momentsIn(withoutSector(field, sector))) parts.push_back(*part);
    if (parts.size() < sectors / 2) return measured;
    const auto count = static_cast<double>(parts.size());
    for (size_t i = 0; i < measured.size(); ++i) {
        double mean = 0, squares = 0;
        for (const Moments& part : parts) mean += part[i] / count;
        for (const Moments& part : parts) squares += (part[i] - mean) * (part[i] - mean);
        measured[i] = {(*all)[i], std::sqrt(squares * (count - 1) / count)};
    }
    return measured;
}

/** Averages over pings. Speckle of a still scene is the same in each ping, so errors remain those of one ping. */
MeasuredMoments computeMean(const std::vector<MeasuredMoments>& all) {
    MeasuredMoments mean;
    for (size_t i = 0; i < mean.size(); ++i) {
        double value = 0, error = 0, count = 0;
        for (const MeasuredMoments& each : all)
            if (each[i].isKnown()) value += each[i].value, error += each[i].error, ++count;
        if (count > 0) mean[i] = {value / count, error / count};
    }
    return mean;
}

/** Returns the sum over lags of the squared autocorrelation of a field. @param reach where the field ends */
double autocorrelation(const std::function<double(double)>& field, double lag, double reach) {
    constexpr int steps = 4000;
    const double step = 2 * reach / steps;
    std::array<double, lags_of_moments + 1> sums{};
    for (int i = 0; i < steps; ++i) {
        const double x = -reach + (i + 0.5) * step, here = field(x);
        for (size_t k = 0; k < sums.size(); ++k) sums[k] += here * field(x + static_cast<double>(k) * lag);
    }
    double total = 0;
    for (size_t k = 1; k < sums.size(); ++k) total += std::pow(sums[k] / sums[0], 2);
    return total;
}

double median(std::vector<double> values) {
    if (values.empty()) return NAN;
    const auto middle = values.begin() + static_cast<long>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/** A ping that is searched for targets. */
class TargetView {
public:
    TargetView(const CodedPing& ping, double width_beams)
        : ping_(ping),
          near_(static_cast<long>(std::ceil(1.2 * width_beams)) + 1),
          far_(static_cast<long>(std::ceil(6 * width_beams)) + 2) {}

    /** Returns the level of the highest sidelobe relative to the target in this bin [dB]; none without a suitable
     *  target. */
    std::optional<double> sidelobeAt(long beam, long bin) const {
        const double level = levelAt(beam, bin);
        if (ping_.code(static_cast<size_t>(beam), static_cast<size_t>(bin)) >= 0.99f || !isPeak(beam, bin)) return {};
        std::vector<double> at, nearer, farther;
        for (long away = near_; away <= far_; ++away)
            for (const long side : {-away, away}) {
                if (beam + side < 0 || beam + side >= static_cast<long>(ping_.beam_count)) continue;
                at.push_back(levelAt(beam + side, bin));
                for (const long aside : {9L, 12L}) {
                    nearer.push_back(levelAt(beam + side, bin - aside));
                    farther.push_back(levelAt(beam + side, bin + aside));
                }
            }
        const double background = std::max(median(nearer), median(farther));
        if (at.size() < 4 || level < background + 25) return {};
        const double highest = *std::ranges::max_element(at);
        return highest > background + 6 ? std::optional(highest - level) : std::nullopt;
    }
    static constexpr long margin = 12;  ///< Bins to either side [1].

private:
    double levelAt(long beam, long bin) const {
        return ping_.levelDb(ping_.code(static_cast<size_t>(beam), static_cast<size_t>(bin)));
    }
    /** Returns whether no neighbour is stronger, out to the sidelobes and within three bins. */
    bool isPeak(long beam, long bin) const {
        const double level = levelAt(beam, bin);
        for (long b = std::max(0L, beam - far_); b <= std::min(static_cast<long>(ping_.beam_count) - 1, beam + far_);
             ++b)
            for (long k = bin - 3; k <= bin + 3; ++k)
                if (levelAt(b, k) > level || (levelAt(b, k) == level && (b < beam || (b == beam && k < bin))))
                    return false;
        return true;
    }

    const CodedPing& ping_;
    long near_, far_;  ///< Range of distances from the target in which sidelobes are searched [beams].
};

}  // namespace

Measured sidelobes(const std::vector<CodedPing>& pings, double width_beams) {
    std::vector<double> all, off;
    for (const CodedPing& ping : pings) {
        const TargetView view(ping, width_beams);
        for (long beam = 0; beam < static_cast<long>(ping.beam_count); ++beam)
            for (long bin = TargetView::margin; bin + TargetView::margin < static_cast<long>(ping.bin_count); ++bin)
                if (ping.code(static_cast<size_t>(beam), static_cast<size_t>(bin)) > 0.1f)
                    if (const auto level = view.sidelobeAt(beam, bin)) all.push_back(*level);
    }
    if (all.empty()) return {};
    const double middle = median(all);
    for (const double level : all) off.push_back(std::abs(level - middle));
    // 1.4826: standard deviation over median deviation of a normal law; for few targets at least 1 dB each.
    const double deviation = std::max(1.0, 1.4826 * median(off));
    return {middle, 1.25 * deviation / std::sqrt(static_cast<double>(all.size()))};
}

SpeckleMoments computeMoments(const std::vector<CodedPing>& pings, const LevelFit& levels, bool with_errors) {
    std::vector<MeasuredMoments> echoes, noises, textures;
    SpeckleMoments moments{.echo_share = 0};
    for (const CodedPing& ping : pings) {
        const SpeckleField field = overPatches(ping);
        const Selected echo = select(ping, field, levels, mostly, 1),
                       noise = select(ping, field, levels, 0, 1 - mostly);
        echoes.push_back(jackknifed(echo.field, with_errors));
        noises.push_back(jackknifed(noise.field, with_errors));
        const Selected textured = select(ping, overPatches(ping, alike_of_texture), levels, mostly, 1);
        textures.push_back(jackknifed(textured.field, with_errors));
        moments.echo_share += textured.share / static_cast<double>(pings.size());
        moments.range += textured.range / static_cast<double>(pings.size());
    }
    const MeasuredMoments echo = computeMean(echoes), noise = computeMean(noises);
    moments.echo_beams = echo[0];
    moments.echo_bins = echo[2];
    moments.texture = computeMean(textures)[4];
    moments.noise_beams = noise[1];
    moments.noise_bins = noise[3];
    return moments;
}

double beamCorrelation(const acoustics::BeamLaw& law, double spacing) {
    const acoustics::BeamPattern pattern(law);
    const double reach = std::min(1.5, 12 * types::radians(law.width_deg.value_or(1)));
    return autocorrelation([&](double angle) { return std::abs(angle) < 1.57 ? pattern.amplitude(angle) : 0.0; },
                           spacing, reach);
}

double binCorrelation(const acoustics::PulseConfig& pulse, double bin, double speed_of_sound) {
    const acoustics::Pulse shape(pulse, speed_of_sound);
    return autocorrelation([&](double distance) { return shape.amplitude(distance); }, bin, 12 * shape.resolution());
}

}  // namespace insonify::study
