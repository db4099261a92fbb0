#include "components/study/SpeckleStudy.hpp"

#include <algorithm>
#include <cmath>

#include "components/noise/Noise.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"

namespace insonify::study {
namespace {

constexpr double fewest_bins = 1024;  ///< Min bins of a slice: four patches.

double reported(const SpeckleField& field) {
    return static_cast<double>(std::ranges::count_if(field.relative, [](double x) { return !std::isnan(x); }));
}

SpeckleRow rowOf(const std::string& name, size_t loudest, const SpeckleField& field, const SpeckleField* next) {
    SpeckleRow row{.name = name, .loudest = loudest, .slices = {}};
    for (size_t slice = 0; slice < speckle_slices; ++slice) {
        const SpeckleField part = sliceOf(field, slice);
        if (reported(part) < fewest_bins) continue;
        row.slices.push_back({slice, figuresOf(part), {}});
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

const SpeckleSlice* SpeckleRow::loudestSlice() const {
    const auto found = std::ranges::find(slices, loudest, &SpeckleSlice::slice);
    return found == slices.end() ? nullptr : &*found;
}

SpeckleRow speckleRow(const CodedPing& ping, const CodedPing* next) {
    const SpeckleField field = overPatches(ping);
    if (!next) return rowOf(ping.name, loudestSlice(ping), field, nullptr);
    const SpeckleField after = overPatches(*next);
    return rowOf(ping.name, loudestSlice(ping), field, &after);
}

SpeckleRow speckleRow(const std::string& name, const types::Sonar& ping, const types::Sonar& next) {
    const SpeckleField field = overPatches(ping), after = overPatches(next);
    return rowOf(name, loudestSlice(ping), field, &after);
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
    const auto fieldOf = [&](const noise::SpeckleConfig& law) { return overMeans(withSpeckle(clean, law), clean); };
    const SpeckleField rayleigh = fieldOf({}), next = overMeans(withSpeckle(later(clean), {}), clean);
    const SpeckleFigures figures = figuresOf(rayleigh);
    const SpeckleFigures k = figuresOf(fieldOf({.law = noise::SpeckleLaw::K, .shape = shape}));
    const SpeckleFigures gamma = figuresOf(fieldOf({.law = noise::SpeckleLaw::Gamma, .looks = looks}));
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
