#include "components/study/fit/RecordingFit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/receiver/Receiver.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::study {
namespace {

constexpr double one_look = -0.15;    ///< T of one look is at least 0; rounding of codes lowers it by less than this.
constexpr double min_texture = 0.01;  ///< Min 1 / shape of the K law.
constexpr double min_width = 0.3, max_width = 16;  ///< Bounds of a filter's width [bins].

/** Returns the sum of the first three lags of a filter's correlation of intensities, exp(-(lag / width)^2). */
double computeCorrelation(double width) {
    double sum = 0;
    for (int lag = 1; lag <= 3; ++lag) sum += std::exp(-std::pow(lag / width, 2));
    return sum;
}

constexpr size_t rounds = 5, simulations = 3;
constexpr size_t fewest_beams = 32, fewest_bins = 64;

void refuseUnusable(const std::vector<CodedPing>& recorded) {
    if (recorded.empty()) throw types::ConfigError("", "--real", "has no ping");
    const CodedPing& first = recorded.front();
    const auto refuse = [&](const std::string& why) { throw types::ConfigError(first.file, "", why); };
    if (first.beam_count < fewest_beams || first.bin_count < fewest_bins)
        refuse(fmt::format("has pings of {} beams and {} bins; a fit needs at least {} and {}", first.beam_count,
                           first.bin_count, fewest_beams, fewest_bins));
    if (first.bits < 8 || first.bits > 16)
        refuse(fmt::format("has codes of {} bits; the receiver of a deployment outputs 8 to 16", first.bits));
    size_t clipped = 0, zero = 0, all = 0;
    for (const CodedPing& ping : recorded) {
        if (ping.beam_count != first.beam_count || ping.bin_count != first.bin_count)
            throw types::ConfigError(
                ping.file, "",
                fmt::format(
                    "has a ping of {} beams and {} bins, another ping has {} and {}; a fit needs pings of one shape",
                    ping.beam_count, ping.bin_count, first.beam_count, first.bin_count));
        for (const float code : ping.codes) ++all, clipped += code >= 1, zero += code <= 0;
    }
    const auto share = [&](size_t count) { return static_cast<double>(count) / static_cast<double>(all); };
    if (share(zero) > 0.9)
        refuse(fmt::format("has codes of 0 in {:.0f} % of its bins: nothing to fit", 100 * share(zero)));
    if (share(clipped) > 0.5)
        refuse(fmt::format("has the max code in {:.0f} % of its bins: it is saturated", 100 * share(clipped)));
}

/** Selects fields instead of energies, with a beam and a pulse that neighbours share. */
void prepare(const CodedPing& recorded, FitChain& chain) {
    sonar::SonarConfig& sonar = chain.sonar;
    if (!sonar.frequency_khz)
        throw types::ConfigError(recorded.file, "", "states no frequency; give the deployment's sonar frequency_khz");
    sonar.speckle.emplace().coherent = true;
    chain.noise.speckle.reset();
    chain.noise.additive.reset();
    chain.noise.filter.reset();
    if (!sonar.pulse) sonar.pulse.emplace().bandwidth_khz = sonar.speedOfSound() / (2 * recorded.resolution) * 1e-3;
    if (chain.isSideScan()) {
        sonar.pulse->window = acoustics::PulseWindow::Hann;  // a sinc reaches over all bins
        return;
    }
    auto& azimuth =
        sonar.beam_pattern ? sonar.beam_pattern->receive.azimuth : sonar.beam_pattern.emplace().receive.azimuth;
    if (!azimuth) azimuth.emplace().weighting = acoustics::Weighting::Taylor;
    if (!azimuth->width_deg) azimuth->width_deg = 2 * *sonar.beam_width_deg;
    azimuth->aperture_m.reset();
    if (!azimuth->weighting) azimuth->weighting = acoustics::Weighting::Uniform;
}

/** Scales bandwidth or duration; both determine the length of the pulse. */
double pulseLength(const acoustics::PulseConfig& pulse, double c) { return acoustics::Pulse(pulse, c).resolution(); }

void setPulseLength(double length, double c, acoustics::PulseConfig& pulse) {
    const double factor = length / pulseLength(pulse, c);
    if (pulse.duration_us)
        *pulse.duration_us *= factor;
    else
        *pulse.bandwidth_khz /= factor;
}

/** Returns the square of an integral over the integral of the square, of a cell's weight. */
double effectiveWidth(double reach, const auto& weight) {
    constexpr int steps = 4000;
    double sum = 0, squares = 0;
    for (int i = 0; i < steps; ++i) {
        const double w = weight(-reach + (i + 0.5) * 2 * reach / steps);
        sum += w, squares += w * w;
    }
    return sum * sum / squares * 2 * reach / steps;
}

/** Returns the area of a resolution cell, seen flat, per metre of range [m]. */
double cellPerMetre(const FitChain& chain) {
    const sonar::SonarConfig& sonar = chain.sonar;
    const acoustics::Pulse pulse(*sonar.pulse, sonar.speedOfSound());
    if (chain.isSideScan())
        return types::radians(sonar.beam_height_deg) *
               effectiveWidth(6 * pulse.resolution(), [&](double r) { return pulse.response(r); });
    const acoustics::BeamLaw& law = *sonar.beam_pattern->receive.azimuth;
    const acoustics::BeamPattern beam(law);
    return effectiveWidth(std::min(1.5, 6 * types::radians(*law.width_deg)), [&](double a) { return beam.power(a); }) *
           effectiveWidth(6 * pulse.resolution(), [&](double r) { return pulse.response(r); });
}

/** Properties of the device that determine speckle, moved until simulated and recorded statistics agree. */
class SpeckleFit {
public:
    SpeckleFit(const CodedPing& recorded, FitChain& chain)
        : chain_(chain),
          c_(chain.sonar.speedOfSound()),
          bin_(recorded.resolution),
          spacing_(types::radians(*chain.sonar.beam_width_deg)),
          width_before_(chain.isSideScan() ? 0 : azimuth().width_deg.value()),
          length_before_(pulseLength(*chain.sonar.pulse, c_)) {}

    /** Makes the first estimate, by theory. */
    void begin(const SpeckleMoments& recorded) {
        recorded_ = recorded;
        beams_ = recorded.echo_beams.value, bins_ = recorded.echo_bins.value;
        noise_beams_ = recorded.noise_beams.value, noise_bins_ = recorded.noise_bins.value;
        inverse_ = recorded.texture.isKnown() ? std::max(0.0, recorded.texture.value * areaAt(recorded)) : 0;
        apply();
    }
    /** Improves the estimate: moves the targets by the error of the simulated statistics. */
    void improve(const SpeckleMoments& recorded, const SpeckleMoments& simulated) {
        recorded_ = recorded;
        const auto move = [](double& target, const Measured& real, const Measured& made) {
            if (real.isKnown() && made.isKnown()) target += real.value - made.value;
        };
        move(beams_, recorded.echo_beams, simulated.echo_beams);
        move(bins_, recorded.echo_bins, simulated.echo_bins);
        move(noise_beams_, recorded.noise_beams, simulated.noise_beams);
        move(noise_bins_, recorded.noise_bins, simulated.noise_bins);
        if (recorded.texture.isKnown() && simulated.texture.isKnown())
            improveTexture(recorded, simulated.texture.value);
        apply();
    }

    /** Takes the statistics of the fitted device, whose rest of the error widens intervals. */
    void end(const SpeckleMoments& simulated) {
        if (recorded_.texture.isKnown() && simulated.texture.isKnown())
            rest_ = recorded_.texture.value - simulated.texture.value;
    }
    void addTo(std::vector<Finding>& findings) const;

private:
    acoustics::BeamLaw& azimuth() const { return *chain_.sonar.beam_pattern->receive.azimuth; }
    /** Returns 1 / shape of the echoes' K law at the measured range; see isTextured() for its significance. */
    double texture() const { return inverse_ / areaAt(recorded_); }
    /** In side-scans the statistic has errors beyond the jackknife: fits of known side-scans (SIDE_SCANS.md) are
     * covered only with the rest of the last step, at the slope with which the statistic follows the texture. */
    double textureInterval() const {
        const double off = z_95 * recorded_.texture.error * std::sqrt(1 + 1.0 / simulations);
        return chain_.isSideScan() ? (off + std::abs(rest_)) / slope_ : off;
    }
    bool isTextured() const { return recorded_.texture.isKnown() && texture() > textureInterval(); }
    double areaAt(const SpeckleMoments& moments) const {
        return cellPerMetre(chain_) * moments.range / (moments.echo_share * moments.echo_share);
    }
    double widthAt(double correlation) const {
        acoustics::BeamLaw law = azimuth();
        return argumentAt(correlation, types::degrees(0.3 * spacing_), types::degrees(30 * spacing_),
                          [&](double width) {
                              law.width_deg = width;
                              return beamCorrelation(law, spacing_);
                          });
    }
    double lengthAt(double correlation) const {
        acoustics::PulseConfig pulse = *chain_.sonar.pulse;
        return argumentAt(correlation, 0.5 * bin_, 30 * bin_, [&](double length) {
            setPulseLength(length, c_, pulse);
            return binCorrelation(pulse, bin_, c_);
        });
    }
    static std::optional<double> filterAt(const Measured& recorded, double correlation) {
        if (!recorded.isMoreThanChance() || correlation < 0.005) return std::nullopt;
        return std::clamp(1 / std::sqrt(-std::log(std::min(correlation, 0.99))), 0.3, 16.0);
    }
    /** Moves the texture to the mean of what all rounds but the first suggest, because each round's statistic has an
     *  error of its own. Patches of one kind show less texture than there is. */
    void improveTexture(const SpeckleMoments& recorded, double made) {
        const double area = areaAt(recorded), here = inverse_ / area;
        rounds_.push_back({here, made});
        const double slope = textureSlope();
        slope_ = std::min(slope, typical_slope);
        double there = 0, count = 0;
        for (size_t i = std::min<size_t>(1, rounds_.size() - 1); i < rounds_.size(); ++i)
            there += rounds_[i].texture + (recorded.texture.value - rounds_[i].made) / slope, ++count;
        inverse_ = area * std::max(here > 0 ? 0.2 * here : 0.0, there / count);
    }
    /** Returns the change of the statistic with the texture, by least squares over all rounds. */
    double textureSlope() const {
        double texture = 0, made = 0, squares = 0, products = 0;
        for (const Round& round : rounds_) texture += round.texture, made += round.made;
        const auto count = static_cast<double>(rounds_.size());
        for (const Round& round : rounds_) {
            const double off = round.texture - texture / count;
            squares += off * off, products += off * (round.made - made / count);
        }
        return squares > 1e-6 ? std::clamp(products / squares, 0.3, 1.2) : typical_slope;
    }
    void apply() {
        if (!chain_.isSideScan())
            azimuth().width_deg = recorded_.echo_beams.isMoreThanChance() ? widthAt(beams_) : width_before_;
        setPulseLength(recorded_.echo_bins.isMoreThanChance() ? lengthAt(bins_) : length_before_, c_,
                       *chain_.sonar.pulse);
        chain_.sonar.speckle->scatterers_per_m2.reset();
        if (inverse_ > 0) chain_.sonar.speckle->scatterers_per_m2 = std::clamp(1 / inverse_, 1e-6, 1e9);
        noise::FilterConfig filter;
        if (!chain_.isSideScan()) filter.correlation_beams = filterAt(recorded_.noise_beams, noise_beams_);
        filter.correlation_bins = filterAt(recorded_.noise_bins, noise_bins_);
        chain_.noise.filter.reset();
        if (filter.correlation_beams || filter.correlation_bins) chain_.noise.filter = filter;
    }
    /** Returns an interval from those of the recorded and simulated statistics. */
    static Fitted interval(double value, double statistic, const Measured& recorded, const auto& at) {
        const double off = z_95 * recorded.error * std::sqrt(1 + 1.0 / simulations);
        const double a = at(statistic - off), b = at(statistic + off);
        return {value, std::min(a, b), std::max(a, b)};
    }

    FitChain& chain_;
    double c_, bin_, spacing_, width_before_, length_before_;  // [m/s, m, rad, deg, m]
    SpeckleMoments recorded_;
    double beams_ = 0, bins_ = 0, noise_beams_ = 0, noise_bins_ = 0;  ///< Target statistics of the theory [1].
    struct Round {
        double texture, made;  ///< 1 / shape, and the statistic of pings that were simulated with it [1].
    };
    std::vector<Round> rounds_;
    double inverse_ = 0;                          ///< 1 / scatterers per area [m^2].
    static constexpr double typical_slope = 0.6;  ///< Change of the statistic with the texture [1].
    double slope_ = typical_slope;                ///< At most the typical slope, as steps are noisy [1].
    double rest_ = 0;                             ///< Recorded less simulated texture of the fitted device [1].
};

bool isWithin(const Fitted& fitted, double share) { return fitted.half() <= share * std::abs(fitted.value); }

void SpeckleFit::addTo(std::vector<Finding>& findings) const {
    const auto add = [&](const char* name, const char* unit, const Measured& measured, Fitted found, double share,
                         const char* note, const char* why_not) {
        const bool is_determined = measured.isMoreThanChance() && isWithin(found, share);
        findings.push_back({name, unit, found, is_determined, is_determined ? note : why_not});
    };
    const double length = pulseLength(*chain_.sonar.pulse, c_);
    if (chain_.isSideScan())
        findings.push_back(
            {"beam width", "deg", {}, false, "the lines of a side-scan are apart, so they share no speckle"});
    else
        add("beam width", "deg", recorded_.echo_beams,
            interval(*azimuth().width_deg, beams_, recorded_.echo_beams, [&](double at) { return widthAt(at); }), 0.25,
            "of the receiver in azimuth, from the correlation of speckle of neighbouring beams",
            "neighbouring beams share no more speckle than chance, or too few bins show echoes without clipping");
    add("pulse length", "m", recorded_.echo_bins,
        interval(length, bins_, recorded_.echo_bins, [&](double at) { return lengthAt(at); }), 0.25,
        "range resolution at -3 dB, from the correlation of speckle of neighbouring bins",
        "neighbouring bins share no more speckle than chance: the pulse is shorter than a bin, or no bins show it");
    const double off = textureInterval();
    const Fitted shapes{1 / texture(), 1 / (texture() + off), texture() > off ? 1 / (texture() - off) : 1e9};
    findings.push_back({"scatterers per cell", "1", shapes, isTextured() && isWithin(shapes, 0.5),
                        isTextured() ? fmt::format("shape of the K law at {:.3g} m", recorded_.range)
                                     : "speckle is Rayleigh's within its error: more than can be counted"});
    const auto noiseWidth = [&](const char* name, const Measured& measured, double statistic) {
        const std::optional<double> found = filterAt(measured, statistic);
        const auto at = [](double c) { return 1 / std::sqrt(-std::log(std::clamp(c, 1e-4, 0.99))); };
        add(name, "1", measured, interval(found.value_or(0), statistic, measured, at), 0.5,
            "of noise: where its correlation is 1/e",
            measured.isKnown() ? "noise is independent from one to the next" : "too few bins show noise alone");
    };
    if (!chain_.isSideScan()) noiseWidth("noise over beams", recorded_.noise_beams, noise_beams_);
    noiseWidth("noise over bins", recorded_.noise_bins, noise_bins_);
}

/** Adds the sonar's attitude over a rough scene. */
void addLook(const LevelFit& fit, const FitChain& before, double range, std::vector<Finding>& findings) {
    const auto add = [&](const char* name, const char* unit, const Fitted& found, bool is_determined, const char* note,
                         const char* why_not) {
        findings.push_back({name, unit, found, is_determined, is_determined ? note : why_not});
    };
    const Fitted &pitch = *fit.pitch_deg, &width = *fit.elevation_deg;
    if (before.looks_abeam) {
        const double depression = 90 - std::abs(before.sonar.bearings_deg.front());
        add("depression", "deg", {depression + pitch.value, depression + pitch.low, depression + pitch.high},
            pitch.half() <= 5, "of each beam's axis below the horizontal", "the width of the beam has the same effect");
        add("elevation width", "deg", width, isWithin(width, 0.5), "of a beam across the track, two-way, at -3 dB",
            "the depression has the same effect");
        return;
    }
    add("pitch", "deg", pitch, pitch.half() <= 5, "added to the mount, down is positive",
        "height and elevation have the same effect");
    add("height", "m", *fit.height_m, fit.height_m->half() <= 0.15 * range, "added to the sonar's position",
        "pitch and elevation have the same effect");
    add("elevation width", "deg", width, isWithin(width, 0.5), "one way, of the transmitter",
        "height and pitch have the same effect");
}

void addLevels(const LevelFit& fit, const FitChain& before, double range, std::vector<Finding>& findings) {
    const auto add = [&](const char* name, const char* unit, const Fitted& found, double useful, const char* note,
                         const char* why_not) {
        const bool is_determined = found.half() <= useful;
        findings.push_back({name, unit, found, is_determined, is_determined ? note : why_not});
    };
    const auto positive = [](const Fitted& found) {
        return Fitted{std::max(0.0, found.value), std::max(0.0, found.low), std::max(0.0, found.high)};
    };
    add("full scale", "dB", fit.full_scale_db, 3, "level of the max code with all gain, for the scene's sediment",
        "no echo is bright enough, or the gain over range has the same effect");
    add("noise", "dB", fit.noise_db, 3, "mean intensity in a bin, relative to the source",
        "no range shows noise by itself");
    add("TVG logarithm", "dB", positive(fit.log_coefficient), 5, "per decade of range",
        "the range is too short to separate it from the TVG slope; the gain over the whole range may be known");
    add("TVG slope", "dB/m", positive(fit.db_per_m), 2.5 / range, "one way",
        "the range is too short to separate it from the TVG logarithm; the gain over the whole range may be known");
    add("TVG span", "dB", fit.tvg_span_db, 3, "gain at the end of the range above that at its tenth",
        "echoes and noise over range are explained by several gains");
    add("absorption", "dB/m", positive(fit.absorption_db_per_m), 1.5 / range, "one way",
        "only echoes and noise, both at several ranges, separate it from the TVG");
    if (fit.water_db)
        add("water", "dB re 1/m", *fit.water_db, 6, "volume backscattering strength, for the scene's sediment",
            "no range shows the water by itself, or noise has the same effect");
    if (fit.pitch_deg) addLook(fit, before, range, findings);
    Finding source{
        "source level", "dB", {}, false, "only its sum with the sediment's strength and the gain is in the codes"};
    if (const auto& ambient = before.noise.ambient; ambient && ambient->wind_m_s && ambient->bandwidth_khz) {
        noise::AmbientConfig at_0 = *ambient;
        at_0.source_level_db = 0;
        const double level = 10 * std::log10(noise::ambientIntensity(at_0)) - fit.noise_db.value;
        source.found = {level, level - fit.noise_db.half(), level + fit.noise_db.half()};
        source.note += fmt::format("; with the scene's sediment and the configured sea {:.1f} dB re 1 uPa m", level);
    }
    findings.push_back(source);
    findings.push_back({"sediment",
                        "dB",
                        {},
                        false,
                        "only its sum with the source level and the gain is in the codes; the scene's is kept"});
}

/** Fits the sidelobes of the beam by a Taylor weighting. */
void addSidelobes(const std::vector<CodedPing>& recorded, FitChain& chain, std::vector<Finding>& findings) {
    constexpr double useful_db = 3;
    acoustics::BeamLaw& law = *chain.sonar.beam_pattern->receive.azimuth;
    const Measured level = sidelobes(recorded, *law.width_deg / *chain.sonar.beam_width_deg);
    const double off = z_95 * level.error;
    const bool is_determined = level.isKnown() && off <= useful_db;
    findings.push_back({"sidelobe level",
                        "dB",
                        {level.value, level.value - off, level.value + off},
                        is_determined,
                        is_determined ? "highest of a beam, next to isolated targets"
                                      : "no target is far enough above its surroundings"});
    if (is_determined && law.weighting == acoustics::Weighting::Taylor)
        law.sidelobe_db = std::clamp(level.value, -60.0, -14.0);
}

/** Keeps the renderer's data of the scene alive, which all renderers of the scene share. */
class SceneTrees {
public:
    explicit SceneTrees(const FitChain& chain) : renderer_(plain(chain.sonar), chain.snapshot.geometry) {
        types::Sonar ping;
        renderer_.render(chain.snapshot, ping);
    }

private:
    static sonar::SonarConfig plain(sonar::SonarConfig config) {
        config.speckle.reset();
        return config;
    }
    sonar::SonarRenderer renderer_;
};

/** Returns the range up to which nearly all lines or beams have the max code from their own transmitter [m]; 0:
 *  none. */
double ringingRange(const std::vector<CodedPing>& recorded) {
    constexpr double nearly_all = 0.9;
    constexpr float maximum = 0.99f;
    const CodedPing& first = recorded.front();
    size_t bin = 0;
    for (; bin < first.bin_count / 16; ++bin) {
        double clipped = 0, all = 0;
        for (const CodedPing& ping : recorded)
            for (size_t beam = 0; beam < ping.beam_count; ++beam) ++all, clipped += ping.code(beam, bin) >= maximum;
        if (clipped < nearly_all * all) break;
    }
    return first.resolution * static_cast<double>(bin);
}

/** Adds the transmitter's ring-down at full scale up to this range, with a steep decay from there. */
void ring(double range, double bin, FitChain& chain) {
    constexpr double steepest = 1000, margin_db = 15, whole_fall_db = 200;
    if (range <= 0) return;
    const double decay = std::min(steepest, whole_fall_db / range);
    const double gain = receiver::tvgDb(*chain.receiver.tvg, range);
    chain.sonar.pulse->ring_down.emplace() = {
        .level_db = std::min(300.0, chain.code().full_scale_db - chain.receiver.gain_db - gain + margin_db +
                                        decay * (range - 0.5 * bin)),
        .decay_db_per_m = decay};
}

/** Corrects recorded levels by the error of the level model in simulated pings, by slices of mostly echoes: clipping of
 *  codes removes more of speckle with few scatterers than of the model's exponential law. */
LevelBlocks corrected(LevelBlocks recorded, const std::vector<CodedPing>& simulated, const LevelFit& fit) {
    constexpr double mostly_echo = 0.5;
    constexpr size_t smoothed = 2;  ///< Slices on either side.
    std::vector<LevelBlocks> each;
    for (const CodedPing& ping : simulated) each.push_back(makeBlocks(ping));
    const LevelBlocks made = computeMean(each);
    std::vector<double> sums(recorded.slices), counts(recorded.slices);
    for (size_t block = 0; block < recorded.beam_blocks; ++block)
        for (size_t slice = 0; slice < recorded.slices; ++slice) {
            const double level = fit.modelled.at(block, slice);
            if (fit.echoShare(level, recorded.ranges[slice]) < mostly_echo) continue;
            sums[slice] += made.at(block, slice) - level, ++counts[slice];
        }
    for (size_t slice = 0; slice < recorded.slices; ++slice) {
        double sum = 0, count = 0;
        for (size_t i = slice - std::min(slice, smoothed); i <= std::min(slice + smoothed, recorded.slices - 1); ++i)
            sum += sums[i], count += counts[i];
        if (counts[slice] == 0) continue;
        for (size_t block = 0; block < recorded.beam_blocks; ++block)
            recorded.level[block * recorded.slices + slice] -= std::clamp(sum / count, -3.0, 3.0);
    }
    return recorded;
}

}  // namespace

bool AveragedSpeckle::isIn(const SpeckleMoments& recorded) {
    return recorded.texture.isKnown() && recorded.texture.value < one_look;
}

void AveragedSpeckle::begin(const SpeckleMoments& recorded) {
    recorded_ = recorded;
    take(1 + recorded.texture.value);
    bins_ = recorded.echo_bins.value;
    chain_.sonar.speckle.reset();
    apply();
}

void AveragedSpeckle::improve(const SpeckleMoments& recorded, const SpeckleMoments& simulated) {
    recorded_ = recorded;
    if (recorded.texture.isKnown() && simulated.texture.isKnown())
        take(1.0 / looks_ + inverse_ + recorded.texture.value - simulated.texture.value);
    if (recorded.echo_bins.isKnown() && simulated.echo_bins.isKnown())
        bins_ += recorded.echo_bins.value - simulated.echo_bins.value;
    apply();
}

void AveragedSpeckle::take(double both) {
    looks_ = std::clamp(static_cast<int>(std::ceil(1 / std::max(1e-3, both))), 2, 256);
    inverse_ = std::max(0.0, both - 1.0 / looks_);
}

void AveragedSpeckle::apply() {
    noise::SpeckleConfig& speckle = chain_.noise.speckle.emplace();
    if (inverse_ > min_texture) speckle.law = noise::SpeckleLaw::K, speckle.shape = std::clamp(1 / inverse_, 0.1, 1e6);
    noise::FilterConfig& filter = chain_.noise.filter.emplace();
    filter.looks = looks_;
    if (recorded_.echo_bins.isMoreThanChance() && bins_ > computeCorrelation(min_width))
        filter.correlation_bins = argumentAt(bins_, min_width, max_width, computeCorrelation);
}

bool AveragedSpeckle::isTextured() const {
    return recorded_.texture.isKnown() && inverse_ > min_texture && inverse_ > z_95 * recorded_.texture.error;
}

void AveragedSpeckle::addTo(std::vector<Finding>& findings) const {
    findings.push_back(
        {"beam width", "deg", {}, false, "the lines of a side-scan are apart, so they share no speckle"});
    findings.push_back({"pulse length",
                        "m",
                        {},
                        false,
                        "the device averages looks: what neighbouring bins share is its averaging, not the pulse"});
    const double both = 1 + recorded_.texture.value, off = z_95 * recorded_.texture.error;
    findings.push_back({"looks",
                        "1",
                        {static_cast<double>(looks_), std::ceil(1 / (both + off)), 1e9},
                        true,
                        "averaged in each bin: the min number that explains the small variation of intensities"});
    const Fitted shape{1 / inverse_, 1 / (inverse_ + off), inverse_ > off ? 1 / (inverse_ - off) : 1e9};
    findings.push_back({"shape of K", "1", shape, isTextured() && shape.half() <= 0.5 * shape.value,
                        isTextured() ? fmt::format("of the texture beneath these looks, at {:.3g} m", recorded_.range)
                                     : "looks alone explain the speckle within its error"});
    const auto& width = chain_.noise.filter->correlation_bins;
    const double slack = z_95 * recorded_.echo_bins.error;
    const auto at = [](double sum) {
        return argumentAt(std::max(sum, computeCorrelation(min_width)), min_width, max_width, computeCorrelation);
    };
    findings.push_back({"speckle over bins", "1",
                        width ? Fitted{*width, at(bins_ - slack), at(bins_ + slack)} : Fitted{}, width.has_value(),
                        width ? "where its correlation is 1/e" : "neighbouring bins share no more than chance"});
}

std::string Finding::text() const {
    if (is_determined)
        return fmt::format("{:.4g} ({:.4g} to {:.4g}) {}: {}", found.value, found.low, found.high, unit, note);
    const bool has_interval = std::isfinite(found.low) && found.low < found.high;
    const std::string interval = has_interval ? fmt::format(" ({:.4g} to {:.4g} {})", found.low, found.high, unit) : "";
    return "not determined by this recording" + interval + ": " + note;
}

const Finding* RecordingFit::finding(const std::string& name) const {
    const auto at = std::ranges::find(findings, name, &Finding::name);
    return at == findings.end() ? nullptr : &*at;
}

RecordingFit fitRecording(const std::vector<CodedPing>& recorded, FitChain chain, bool rough,
                          const std::function<void(const std::string&)>& progress) {
    refuseUnusable(recorded);
    if (recorded.front().is_waterfall != chain.looks_abeam)
        throw types::ConfigError(recorded.front().file, "",
                                 chain.looks_abeam ? "is not a recording of a side-scan, but the deployment has one"
                                                   : "is a recording of a side-scan, but the deployment has none");
    copyShape(recorded.front(), chain);
    if (chain.looks_abeam) layLines(recorded.front(), chain);
    const FitChain before = chain;
    prepare(recorded.front(), chain);
    const types::Sonar echoes = meanEchoes(chain);
    const SceneTrees held(chain);
    if (std::ranges::none_of(echoes.bins, [](float bin) { return bin > 0; }))
        throw types::ConfigError("", "scene", "gives the deployment's sonar no echo in the range of the recording");
    std::vector<LevelBlocks> blocks;
    for (const CodedPing& ping : recorded) blocks.push_back(makeBlocks(ping));
    const LevelBlocks measured = computeMean(blocks);
    LevelBlocks levels = measured;
    const double range = recorded.front().resolution * static_cast<double>(recorded.front().bin_count);

    const double ringing = ringingRange(recorded);

    RecordingFit fit;
    std::optional<Fitted> pitch, height, elevation;
    SpeckleFit speckle(recorded.front(), chain);
    std::optional<AveragedSpeckle> averaged;
    for (size_t round = 0; round < rounds; ++round) {
        const auto show = [&] { progress(fmt::format("round {} of {}: levels", round + 1, rounds)); };
        fit.levels = fitLevels(levels, recorded.front(), chain,
                               {.rough = rough, .water = findMinimum(blocks), .fits_scene = rough && round == 0}, show);
        if (round == 0)
            pitch = fit.levels.pitch_deg, height = fit.levels.height_m, elevation = fit.levels.elevation_deg;
        chain = fit.levels.applied(chain);
        ring(ringing, recorded.front().resolution, chain);
        fit.recorded = computeMoments(recorded, fit.levels, round + 2 == rounds);
        if (round == 0 && chain.isSideScan() && AveragedSpeckle::isIn(fit.recorded)) averaged.emplace(chain);
        if (round == 0) averaged ? averaged->begin(fit.recorded) : speckle.begin(fit.recorded);
        progress(fmt::format("round {} of {}: speckle", round + 1, rounds));
        fit.simulated_pings = simulatedPings(chain, simulations);
        fit.simulated = computeMoments(fit.simulated_pings, fit.levels, false);
        levels = corrected(measured, fit.simulated_pings, fit.levels);
        if (round + 1 < rounds)
            averaged ? averaged->improve(fit.recorded, fit.simulated) : speckle.improve(fit.recorded, fit.simulated);
    }
    speckle.end(fit.simulated);
    fit.chain = chain;
    fit.levels.pitch_deg = pitch, fit.levels.height_m = height, fit.levels.elevation_deg = elevation;
    addLevels(fit.levels, before, range, fit.findings);
    if (ringing > 0)
        fit.findings.push_back({"transmitter", "m", {ringing, ringing, ringing}, true, "range up to which it rings"});
    averaged ? averaged->addTo(fit.findings) : speckle.addTo(fit.findings);
    if (!chain.isSideScan()) addSidelobes(recorded, fit.chain, fit.findings);
    return fit;
}

}  // namespace insonify::study
