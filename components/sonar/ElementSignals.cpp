#include "components/sonar/ElementSignals.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::sonar {
namespace {

/** Of the azimuth cells, as loud as they are sent at. */
ComplexRows sentField(const RenderPlan& plan, const EchoField& field) {
    ComplexRows rows(plan.cells.size(), field.response().samples());
    for (size_t cell = 0; cell < plan.cells.size(); ++cell) {
        const double azimuth = plan.cells[cell].centre;
        const auto sent = static_cast<float>(plan.directivity->azimuthAmplitude(azimuth, azimuth));
        const std::span<const float> numbers = field.cell(cell);
        const auto row = rows.row(cell);
        for (size_t i = 0; i < row.size(); ++i) row[i] = {sent * numbers[2 * i], sent * numbers[2 * i + 1]};
    }
    return rows;
}

}  // namespace

std::vector<Cone> conesOf(const std::vector<Beam>& beams) {
    std::vector<Cone> cones;
    for (const Beam& beam : beams) cones.push_back({std::sin(beam.low), std::sin(beam.high)});
    return cones;
}

LineArray lineArrayOf(const SonarConfig& config) {
    const double wavelength = config.speedOfSound() / (1e3 * *config.frequency_khz);
    const acoustics::BeamPattern pattern(*config.beam_pattern->receive.azimuth, wavelength);
    const ElementsConfig::Array array = config.elements->arrayOf(pattern.aperture() * wavelength, wavelength);
    return {array.count, array.spacing, wavelength, pattern.taper()};
}

void takeSignals(const RenderPlan& plan, const EchoField& field, const LineArray& array,
                 types::SonarElements& signals) {
    const ComplexRows heard = array.hear(sentField(plan, field), conesOf(plan.cells));
    signals.speed_of_sound = plan.grid.speed_of_sound;
    signals.wavelength = array.wavelength();
    signals.sample_spacing = field.response().sampleWidth();
    signals.first_range = 0.5 * signals.sample_spacing;
    signals.sample_count = static_cast<uint32_t>(heard.sample_count);
    signals.positions.clear();
    for (size_t m = 0; m < array.count(); ++m) signals.positions.push_back(array.position(m));
    signals.weights = array.weights();
    signals.in_phase.resize(heard.values.size());
    signals.quadrature.resize(heard.values.size());
    std::ranges::transform(heard.values, signals.in_phase.begin(), [](const auto& value) { return value.real(); });
    std::ranges::transform(heard.values, signals.quadrature.begin(), [](const auto& value) { return value.imag(); });
}

}  // namespace insonify::sonar
