#pragma once
#include <array>
#include <functional>
#include <string>

#include "components/acoustics/Curve.hpp"

namespace insonify::acoustics {

/** A law of backscatter as what an echo needs of it: sigma_b / cos(theta) over cos(theta), with straight lines between
 *  256 entries; nearer than 0.001 deg to grazing that of 0.001 deg. ACOUSTICS.md 3.8. */
class BackscatterTable {
public:
    static constexpr int entries = 256;

    /** Of a cross section over the grazing angle [rad], m^2 at 1 m for each m^2. */
    explicit BackscatterTable(const std::function<double(double)>& section);

    /** Entry i is for cos(theta) = i / 255; the first for the sine of 0.001 deg. */
    const std::array<double, entries>& values() const { return values_; }

private:
    std::array<double, entries> values_;
};

/** A measured strength: levels [dB] over grazing angles [deg], from a CSV file with header grazing_deg,strength_db.
 *  @throws types::ConfigError with file, line and column of every diagnostic. */
Curve readBackscatter(const std::string& file);
/** Its cross section at a grazing angle [rad]: straight lines in decibels, the nearer end's beyond what was measured
 *  [m^2 at 1 m for each m^2]. */
double measuredSection(const Curve& measured, double grazing);

}  // namespace insonify::acoustics
