#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "components/acoustics/BeamPattern.hpp"
#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/config/SonarConfig.hpp"

namespace insonify::sonar {

/** The two-way power pattern of a sonar's `beam_pattern`: transmit times receive, each the product of a law in azimuth
 *  and one in elevation (ACOUSTICS.md 5.9). Without a receive law in azimuth
 *  each beam receives its own box; any other absent law is 1 in all directions, beside a law of the other array. */
class Directivity {
public:
    /** @throws types::ConfigError for a measured table that cannot be read, or an aperture without a frequency. */
    explicit Directivity(const SonarConfig& config);

    bool hasAzimuth() const { return transmit_azimuth_ || receive_azimuth_; }
    /** Returns whether a transmit law in azimuth has no receive law beside it: each beam receives its own box, times
     * the transmit law. */
    bool hasBoxes() const { return transmit_azimuth_ && !receive_azimuth_; }
    double boxWidth() const { return 2 * half_box_; }  ///< [rad]
    bool hasElevation() const { return transmit_elevation_ || receive_elevation_; }
    /** Returns the pattern of the beam at a bearing, at an azimuth from the sonar's axis [rad]. A conical fan is a
     *  straight array, whose beams widen with electronic steering. The beams of a planar fan are alike. */
    double azimuth(double azimuth, double bearing) const { return this->azimuth(azimuth, bearing, lastZone()); }
    double azimuth(double azimuth, double bearing, size_t zone) const;
    double elevation(double angle) const;
    /** Returns the field, whose square is the power, with the signs or phases of its sidelobes [1]. */
    std::complex<double> azimuthField(double azimuth, double bearing, size_t zone) const {
        return sentAmplitude(azimuth) * receivedField(azimuth, bearing, zone);
    }
    double sentAmplitude(double azimuth) const;
    /** Returns the field of the law; 1 without a law, also outside of the beam's box. */
    std::complex<double> receivedField(double azimuth, double bearing, size_t zone) const;
    /** Return the one-way patterns at angles [rad]. */
    double sentAzimuth(double azimuth) const;
    double receivedAzimuth(double azimuth, double bearing, size_t zone) const;
    double sentElevation(double angle) const;
    double receivedElevation(double angle) const;
    /** Returns the number of range zones, from the nearest. The receiving array has one pattern in each: one zone,
     *  unless the array has a fixed focus. */
    size_t zoneCount() const { return std::max<size_t>(1, zones_.size()); }
    size_t lastZone() const { return zoneCount() - 1; }
    double zoneEnd(size_t zone) const;  ///< Far end of a zone in slant range; infinity for the last zone [m].
    size_t zoneAt(double range) const;  ///< Zone of a slant range [m].
    bool isComplex() const { return !zones_.empty(); }  ///< Whether fields have phases, not only signs.

    double floor() const { return floor_; }  ///< Level below which echoes are ignored [1].

    /** Returns the elevation to either side beyond which the pattern stays below the floor [rad], at most pi/2. */
    double elevationReach() const;
    /** Returns the density of rows that are traced at an elevation: the cube root of the pattern. It is optimal for
     * rows whose error falls as the square of their height: most are in the main lobe, and some in sidelobes [1]. */
    double rowDensity(double angle) const { return std::cbrt(std::max(elevation(angle), floor_)); }
    /** Returns the number of rows over the reach in elevation of which `in_main_lobe` are between the half-power
     * points: rows of rowDensity(), or even rows. At most the rows of an image. */
    int rowsFor(int in_main_lobe, bool even) const;
    /** Azimuths of a fan between which any beam is above the floor, at most a whole turn from the fan's seam [rad]. */
    struct Span {
        double low, high;
    };
    Span azimuthSpan(const Fan& beams) const;
    /** Returns the angle between the half-power points of a beam straight ahead, two way [rad]. */
    double halfPowerAzimuth() const;
    /** Returns the angle to either side of its bearing within which a beam weights each cell: the main lobe and the
     *  notable sidelobes [rad]. */
    double nearAzimuth() const { return 10 * halfPowerAzimuth(); }
    double nearAzimuth(size_t zone) const;

private:
    using Law = std::optional<acoustics::BeamPattern>;
    /** A zone of range, and what its focus and the errors of the elements add to the field of the law. */
    struct Zone {
        double end;    ///< [m]
        double phase;  ///< Defocus at the ends of the array, relative to its middle [rad].
        acoustics::ElementField added;
    };
    double idealAzimuth(double azimuth, double bearing) const;
    void makeZones(const SonarConfig& config, std::optional<double> wavelength);
    const Zone& zoneOfPhase(double phase) const;

    std::vector<Zone> zones_;  ///< Empty for an ideal array.
    bool conical_;
    double half_box_;  ///< Half the width of a beam without a receive law [rad].
    double floor_;
    Law transmit_azimuth_, receive_azimuth_, transmit_elevation_, receive_elevation_;
};

/** Returns the number of elements of a receiving array with a law in azimuth. */
size_t receivingElements(const SonarConfig& config);

/** Returns the configuration that a sonar with a beam pattern is sampled with: azimuth cells replace the beams. Cells
 *  and aperture extend as far as the pattern is above its floor, in images at most as far as an image shows. */
SonarConfig sampledConfig(const SonarConfig& config, const Directivity& directivity, bool traces_rays);

/** Returns the azimuth cells of a sampled configuration. With rays, cells far from all beams are sixteen times as wide,
 *  because only sidelobes receive their echoes. */
Fan azimuthCells(const SonarConfig& config, const SonarConfig& sampled, const Fan& beams,
                 const Directivity& directivity, bool traces_rays);

/** Returns why the cells of a sonar would exceed the max memory; empty where they do not.
 *  @throws types::ConfigError as Directivity does. */
std::string whyTooLarge(const SonarConfig& config);

}  // namespace insonify::sonar
