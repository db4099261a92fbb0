#include "components/study/SpeckleStudy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "components/acoustics/BeamPattern.hpp"
#include "components/noise/Noise.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/SpeckleStatistics.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

constexpr double speed_of_sound = 1000, frequency_khz = 500, wavelength = 0.002;  // [m/s, kHz, m]
constexpr double beam_width_deg = 2, bin_width = 0.01, range = 12;                // [deg, m, m]
constexpr int beams = 64, bins = 1200;
constexpr double parts = 4;  ///< Bins per resolution cell, and beams per beam width lambda / L.

/** Returns the length of the aperture [wavelengths]. */
double aperture() {
    acoustics::BeamLaw law;
    law.weighting = acoustics::Weighting::Uniform;
    law.width_deg = beam_width_deg;
    return acoustics::BeamPattern(law).aperture();
}

/** Returns a sonar with an unweighted receiving line, a uniform transmitter, a chirp without window, and bins and beams
 *  four times denser than the resolution. */
sonar::SonarConfig denseFan() {
    sonar::SonarConfig config;
    config.speed_of_sound = speed_of_sound;
    config.frequency_khz = frequency_khz;
    config.range = range;
    config.bin_count = bins;
    config.beam_count = beams;
    config.field_of_view_deg = types::degrees(beams / (parts * aperture()));
    config.beam_height_deg = 60;
    auto& law = config.beam_pattern.emplace().receive.azimuth.emplace();
    law.weighting = acoustics::Weighting::Uniform;
    law.width_deg = beam_width_deg;
    config.beam_pattern->floor_db = -40;
    config.pulse.emplace().bandwidth_khz = speed_of_sound / (2 * parts * bin_width) * 1e-3;
    config.speckle.emplace().coherent = true;
    setSamples(config, 256, 2);
    return config;
}

types::Snapshot bottomFrom(const glm::dvec3& position) {
    static const types::GeometryPtr ground = [] {
        auto geometry = std::make_shared<types::Geometry>();
        geometry->materials = {{}};
        geometry->meshes = {levelGround(-2)};
        geometry->objects.push_back({"bottom", 0, glm::dmat4(1)});
        return geometry;
    }();
    return lookingAt(ground, position);
}

/** A sonar over the bottom, and the mean of its pings. */
class Bottom {
public:
    explicit Bottom(const sonar::SonarConfig& config) : renderer_(config, bottomFrom({}).geometry) {
        sonar::SonarConfig even = config;
        even.speckle.reset();
        sonar::SonarRenderer(even, bottomFrom({}).geometry).render(bottomFrom({}), means_);
    }
    /** Returns the bins of slant ranges [from, to). */
    SpeckleField received(const glm::dvec3& position, double from = 6, double to = range) {
        types::Sonar ping;
        renderer_.render(bottomFrom(position), ping);
        SpeckleField field = overMeans(ping, means_);
        for (size_t i = 0; i < field.relative.size(); ++i) {
            const double at = (static_cast<double>(i % field.bin_count) + 0.5) * bin_width;
            if (at < from || at >= to) field.relative[i] = NAN;
        }
        return field;
    }

private:
    sonar::SonarRenderer renderer_;
    types::Sonar means_;
};

double offBy(double value, double truth) { return std::abs(value / truth - 1); }

void addStillness(Bottom& bottom, std::vector<Claim>& claims) {
    const SpeckleField first = bottom.received({}), again = bottom.received({}),
                       elsewhere = bottom.received({0, 0.5, 0});
    claims.push_back(
        {"coherent: two pings of a still scene: correlation", likewise(first, again).intensities, 1 - 1e-12, false});
    claims.push_back(
        {"coherent: half a metre aside: correlation", std::abs(likewise(first, elsewhere).intensities), 0.1, true});
}

void addLaws(Bottom& bottom, std::vector<Claim>& claims) {
    const SpeckleFigures figures = computeFigures(bottom.received({}));
    claims.push_back({"coherent, many scatterers: distance of the exponential law, times root n",
                      figures.rayleigh_distance, rayleigh_distance_limit, true});
    claims.push_back({"coherent, many scatterers: scintillation index off 1 [errors]",
                      std::abs(figures.scintillation.value - 1) / figures.scintillation.error, 3, true});
    constexpr std::array<double, 3> shared{0, 0.811, 0.405};  // sinc^2 of a quarter and a half
    const char* parts_of[] = {"", "a quarter", "half"};
    for (const size_t lag : {size_t{1}, size_t{2}}) {
        claims.push_back(
            {std::string("coherent: correlation of bins ") + parts_of[lag] + " of the resolution apart, off theory by",
             std::abs(figures.along[lag] - shared[lag]), 0.05, true});
        claims.push_back(
            {std::string("coherent: correlation of beams ") + parts_of[lag] + " of lambda / L apart, off theory by",
             std::abs(figures.across[lag] - shared[lag]), 0.05, true});
    }
}

/** Measures the sideways distance at which the correlation is a half. Theory: the square of the autocorrelation of the
 *  aperture at twice the distance, (1 - 2 x / L)^2. */
void addLateral(Bottom& bottom, std::vector<Claim>& claims) {
    const double length = aperture() * wavelength, theory = 0.5 * length * (1 - std::sqrt(0.5));
    const SpeckleField still = bottom.received({});
    double before = 1, at = 0;
    for (int step = 1; step < 40; ++step) {
        at = 0.1 * step * theory;
        const double now = likewise(still, bottom.received({0, at, 0})).intensities;
        if (now < 0.5) {
            at -= 0.1 * theory * (0.5 - now) / (before - now);
            break;
        }
        before = now;
    }
    claims.push_back({"coherent: way aside that halves the correlation, off theory by", offBy(at, theory), 0.1, true});
}

/** Tests few scatterers per cell: their number is proportional to the range, and so is the shape. */
void addShapes(std::vector<Claim>& claims) {
    sonar::SonarConfig config = denseFan();
    config.speckle->scatterers_per_m2 = 400;
    Bottom bottom(config);
    double near = 0, far = 0;
    constexpr int places = 6;
    for (int i = 0; i < places; ++i) {
        const glm::dvec3 place(0, 20.0 * i, 0);
        near += computeFigures(bottom.received(place, 5, 6)).texture.value / places;
        far += computeFigures(bottom.received(place, 10, 12)).texture.value / places;
    }
    claims.push_back({"coherent, few scatterers: 1 / shape of K", near, 0.1, false});
    claims.push_back(
        {"coherent, few scatterers: shape at twice the range over shape, off 2 by", offBy(near / far, 2), 0.25, true});
}

using Out = std::back_insert_iterator<std::string>;
void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    if (!(file << text).flush()) throw std::runtime_error(path.string() + " cannot be written");
}

constexpr double fewest_bins = 1024;  ///< Min bins of a slice: four patches.

double reported(const SpeckleField& field) {
    return static_cast<double>(std::ranges::count_if(field.relative, [](double x) { return !std::isnan(x); }));
}

SpeckleRow getRow(const std::string& name, size_t loudest, const SpeckleField& field, const SpeckleField* next) {
    SpeckleRow row{.name = name, .loudest = loudest, .slices = {}};
    for (size_t slice = 0; slice < speckle_slices; ++slice) {
        const SpeckleField part = getSlice(field, slice);
        if (reported(part) < fewest_bins) continue;
        row.slices.push_back({slice, computeFigures(part), {}});
        if (next) row.slices.back().next = likewise(part, *next);
    }
    return row;
}

types::Sonar withSpeckle(const types::Sonar& ping, const noise::SpeckleConfig& law) {
    noise::NoiseConfig config;
    config.speckle = law;
    types::Sonar noisy;
    noise::Noise(config).add(ping, noisy);
    return noisy;
}

types::Sonar later(types::Sonar ping) {
    ping.time.microseconds += 100'000;
    return ping;
}

/** Returns a ping whose bins are all 1. */
types::Sonar items() {
    types::Sonar ping;
    ping.time.microseconds = 1;
    ping.beam_count = 256;
    ping.bin_count = 500;
    ping.bins.assign(size_t{ping.beam_count} * ping.bin_count, 1.0f);
    return ping;
}

/** Returns the deviation of an estimate in standard errors. */
double errorsOff(const Estimate& estimate, double truth) { return std::abs(estimate.value - truth) / estimate.error; }

}  // namespace

std::vector<Claim> coherentClaims() {
    std::vector<Claim> claims;
    Bottom bottom(denseFan());
    addStillness(bottom, claims);
    addLaws(bottom, claims);
    addLateral(bottom, claims);
    addShapes(claims);
    return claims;
}

std::vector<SpeckleFigure> computeFigures(const SpeckleSlice& slice) {
    const SpeckleFigures& figures = slice.figures;
    const Likewise next = slice.next.value_or(Likewise{NAN, NAN});
    return {{"bins", figures.bins},
            {"independent_bins", figures.independent},
            {"contrast", figures.contrast},
            {"scintillation_index", figures.scintillation.value},
            {"scintillation_error", figures.scintillation.error},
            {"inverse_k_shape", figures.texture.value},
            {"inverse_k_shape_error", figures.texture.error},
            {"rayleigh_distance", figures.rayleigh_distance},
            {"bin_correlation", figures.along[1]},
            {"beam_correlation", figures.across[1]},
            {"frozen", next.frozen()},
            {"noise_share", slice.next ? next.noiseShare() : NAN}};
}

std::string csv(const std::vector<SpeckleRow>& rows) {
    std::string text = "ping,slice,loudest";
    for (const SpeckleFigure& figure : computeFigures(SpeckleSlice{})) text += std::string(",") + figure.name;
    for (const SpeckleRow& row : rows)
        for (const SpeckleSlice& slice : row.slices) {
            fmt::format_to(Out(text), "\n{},{},{}", row.name, slice.slice, slice.slice == row.loudest ? 1 : 0);
            for (const SpeckleFigure& figure : computeFigures(slice))
                fmt::format_to(Out(text), ",{:.6g}", figure.value);
        }
    return text + "\n";
}

std::string lagsCsv(const std::vector<SpeckleRow>& rows) {
    std::string text = "ping,lag,bin_correlation,beam_correlation\n";
    for (const SpeckleRow& row : rows)
        if (const SpeckleSlice* loud = row.loudestSlice())
            for (size_t lag = 0; lag < speckle_lags; ++lag)
                fmt::format_to(Out(text), "{},{},{:.6g},{:.6g}\n", row.name, lag, loud->figures.along[lag],
                               loud->figures.across[lag]);
    return text;
}

void writeReport(const std::vector<SpeckleRow>& rows, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    write(folder / "speckle.csv", csv(rows));
    write(folder / "lags.csv", lagsCsv(rows));
}

const SpeckleSlice* SpeckleRow::loudestSlice() const {
    const auto found = std::ranges::find(slices, loudest, &SpeckleSlice::slice);
    return found == slices.end() ? nullptr : &*found;
}

SpeckleRow speckleRow(const CodedPing& ping, const CodedPing* next) {
    const SpeckleField field = overPatches(ping);
    if (!next) return getRow(ping.name, loudestSlice(ping), field, nullptr);
    const SpeckleField after = overPatches(*next);
    return getRow(ping.name, loudestSlice(ping), field, &after);
}

SpeckleRow speckleRow(const std::string& name, const types::Sonar& ping, const types::Sonar& next) {
    const SpeckleField field = overPatches(ping), after = overPatches(next);
    return getRow(name, loudestSlice(ping), field, &after);
}

std::vector<SpeckleRow> simulatedRows(const sonar::SonarConfig& config, const types::Snapshot& snapshot) {
    sonar::SonarRenderer renderer(config, snapshot.geometry);
    types::Sonar ping, next;
    renderer.render(snapshot, ping);
    types::Snapshot still = snapshot;
    still.time.microseconds += 100'000;
    renderer.render(still, next);
    sonar::SonarConfig energies = config;
    energies.speckle.reset();
    energies.elements.reset();
    types::Sonar mean;
    sonar::SonarRenderer(energies, snapshot.geometry).render(snapshot, mean);
    return {speckleRow("sonar", ping, next),
            speckleRow("law_rayleigh", withSpeckle(mean, {}), withSpeckle(later(mean), {}))};
}

std::vector<Claim> lawClaims() {
    constexpr double shape = 3, looks = 4;
    const types::Sonar clean = items();
    const auto getField = [&](const noise::SpeckleConfig& law) { return overMeans(withSpeckle(clean, law), clean); };
    const SpeckleField rayleigh = getField({}), next = overMeans(withSpeckle(later(clean), {}), clean);
    const SpeckleFigures figures = computeFigures(rayleigh);
    const SpeckleFigures k = computeFigures(getField({.law = noise::SpeckleLaw::K, .shape = shape}));
    const SpeckleFigures gamma = computeFigures(getField({.law = noise::SpeckleLaw::Gamma, .looks = looks}));
    return {{"law rayleigh: distance of the exponential law, times root n", figures.rayleigh_distance,
             rayleigh_distance_limit, true},
            {"law rayleigh: scintillation index off 1 [errors]", errorsOff(figures.scintillation, 1), 3, true},
            {"law rayleigh: correlation of neighbouring bins", std::abs(figures.along[1]), 0.02, true},
            {"law rayleigh: correlation of neighbouring beams", std::abs(figures.across[1]), 0.02, true},
            {"law rayleigh: correlation of two pings", std::abs(likewise(rayleigh, next).intensities), 0.02, true},
            {"law k of shape 3: 1 / shape off 1/3 [errors]", errorsOff(k.texture, 1 / shape), 3, true},
            {"law k of shape 3: distance of the exponential law, times root n", k.rayleigh_distance,
             rayleigh_distance_limit, false},
            {"law gamma of 4 looks: scintillation index off 1/4 [errors]", errorsOff(gamma.scintillation, 1 / looks), 3,
             true}};
}

std::vector<Claim> recordedClaims(const std::vector<SpeckleRow>& recorded) {
    std::vector<Claim> claims;
    for (const SpeckleRow& row : recorded)
        if (const SpeckleSlice* loud = row.loudestSlice(); loud && loud->next)
            claims.push_back({row.name + ", where it is loudest: frozen part of the speckle", loud->next->frozen(),
                              0.95, false, false});
    return claims;
}

}  // namespace insonify::study
