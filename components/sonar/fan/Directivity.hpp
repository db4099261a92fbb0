#pragma once
#include <algorithm>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "components/acoustics/BeamPattern.hpp"
#include "components/acoustics/ElementField.hpp"
#include "components/sonar/fan/BeamFan.hpp"
#include "components/sonar/plan/SonarConfig.hpp"

namespace insonify::sonar {

/** Where a sonar sends and hears: the two-way power pattern of its `beam_pattern`, transmit times receive, each the
 *  product of a law in azimuth and one in elevation (ACOUSTICS.md 5.9). What has no law is 1 in all directions. */
class Directivity {
public:
    /** @throws types::ConfigError for a measured table that cannot be read, or an aperture without a frequency. */
    explicit Directivity(const SonarConfig& config);

    bool hasAzimuth() const { return transmit_azimuth_ || receive_azimuth_; }
    bool hasElevation() const { return transmit_elevation_ || receive_elevation_; }
    /** Of a beam of a bearing, at an azimuth from the sonar's axis [rad]. A conical fan is a straight array, whose
     *  beams widen as they are steered; the beams of a planar one are alike. */
    double azimuth(double azimuth, double bearing) const { return this->azimuth(azimuth, bearing, lastZone()); }
    double azimuth(double azimuth, double bearing, size_t zone) const;
    double elevation(double angle) const;
    /** The same of the field, of which the power is the square, with the signs of its sidelobes, or their phases [1].
     */
    std::complex<double> azimuthField(double azimuth, double bearing, size_t zone) const {
        return sentAmplitude(azimuth) * heardField(azimuth, bearing, zone);
    }
    double sentAmplitude(double azimuth) const;
    std::complex<double> heardField(double azimuth, double bearing, size_t zone) const;
    /** The same of one way [rad]. */
    double sentAzimuth(double azimuth) const;
    double heardAzimuth(double azimuth, double bearing, size_t zone) const;
    double sentElevation(double angle) const;
    double heardElevation(double angle) const;
    /** Zones of range, from the nearest on, in each of which the receiving array has one pattern: one zone, but where
     * it has a fixed focus. */
    size_t zoneCount() const { return std::max<size_t>(1, zones_.size()); }
    size_t lastZone() const { return zoneCount() - 1; }
    double zoneEnd(size_t zone) const;  ///< Slant range to which it reaches; of the last one infinity [m].
    size_t zoneAt(double range) const;  ///< That of a slant range [m].
    bool isComplex() const { return !zones_.empty(); }  ///< Whether fields have phases, and not signs alone.

    double floor() const { return floor_; }  ///< Below it a pattern is not drawn [1].

    /** Elevation to either side beyond which it stays below the floor [rad], at most pi/2. */
    double elevationReach() const;
    /** Azimuths of a fan between which any beam is above the floor, at most a whole turn from the fan's seam [rad]. */
    struct Span {
        double low, high;
    };
    Span azimuthSpan(const Fan& beams) const;
    /** Between the half-power points of a beam straight ahead, two way [rad]. */
    double halfPowerAzimuth() const;
    /** To either side of its bearing, within which a beam weighs each cell: all of the main lobe and the sidelobes that
     *  stand out [rad]. */
    double nearAzimuth() const { return 10 * halfPowerAzimuth(); }
    double nearAzimuth(size_t zone) const;

private:
    using Law = std::optional<acoustics::BeamPattern>;
    /** A zone of range and what its focus and the errors of the elements add to the field of the law. */
    struct Zone {
        double end;    ///< [m]
        double phase;  ///< At the ends of the array, relative to its middle, out of focus [rad].
        acoustics::ElementField added;
    };
    double idealAzimuth(double azimuth, double bearing) const;
    void makeZones(const SonarConfig& config, std::optional<double> wavelength);
    const Zone& zoneOfPhase(double phase) const;

    std::vector<Zone> zones_;  ///< Empty for an ideal array.
    bool conical_;
    double floor_;
    Law transmit_azimuth_, receive_azimuth_, transmit_elevation_, receive_elevation_;
};

/** A sonar with a beam pattern as it is sampled: azimuth cells take the place of the beams, and cells and
 *  aperture go as far as the pattern is above its floor, in images at most as far as one shows. */
SonarConfig sampledConfig(const SonarConfig& config, const Directivity& directivity, bool casts_rays);

/** The azimuth cells of a sonar that is sampled so. With rays those that are far from all beams are as wide as
 *  sixteen others, for they are heard by sidelobes alone. */
Fan azimuthCells(const SonarConfig& sampled, const Fan& beams, const Directivity& directivity, bool casts_rays);

/** Why the cells of a sonar would take more memory than there may be; empty where they do not.
 *  @throws types::ConfigError as Directivity does. */
std::string whyTooLarge(const SonarConfig& config);

}  // namespace insonify::sonar
