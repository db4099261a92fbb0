#include "components/noise/NoiseConfig.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "components/acoustics/AmbientNoise.hpp"

namespace insonify::noise {
namespace {

double powerOf(double decibels) { return std::pow(10.0, decibels / 10); }

}  // namespace

void AmbientConfig::check(types::Diagnostics& diagnostics) const {
    const std::pair<const char*, const std::optional<double>&> computed[] = {
        {"wind_m_s", wind_m_s}, {"bandwidth_khz", bandwidth_khz}, {"source_level_db", source_level_db}};
    if (!level_db && !wind_m_s && !bandwidth_khz && !source_level_db)
        return diagnostics.push_back(
            {"", "has no value; give level_db, or wind_m_s, bandwidth_khz and source_level_db"});
    for (const auto& [name, value] : computed) {
        if (level_db && value) diagnostics.push_back({name, "is given together with level_db; give one of the two"});
        if (!level_db && !value)
            diagnostics.push_back({"", std::string("has no ") + name + ", which is needed without level_db"});
    }
}

double ambientIntensity(const AmbientConfig& ambient) {
    if (ambient.level_db) return powerOf(*ambient.level_db);
    const double spectrum = acoustics::coatesSpectrumDb(ambient.frequency_khz, *ambient.wind_m_s, ambient.shipping);
    return powerOf(spectrum + 10 * std::log10(1e3 * *ambient.bandwidth_khz) - ambient.directivity_index_db -
                   *ambient.source_level_db);
}

}  // namespace insonify::noise
