#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "types/Sonar.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::sonar {

/** The truth of a grid of beams, column by column: of each azimuth the sum over its elevations, and of each beam of the
 *  grid what its return shows.
 *
 *  A beam tells its strongest object and path in a bin, so that of what several beams hear together the shares are
 * those of each beam's strongest object. Elevations are those of the beams, within half their spacing. */
class GridTruth {
public:
    /** Gives the azimuths room in `ping`, whose grid is taken, and the beams of the grid in `returns`, a bin for each:
     *  row by row from the top, each from port to starboard. */
    static void shape(const types::Sonar& ping, size_t rows, types::SonarTruth& azimuths, types::SonarTruth& returns);
    /** Takes the truth of one azimuth, whose beams are its elevations from the lowest to the highest [rad], into beam
     *  `column` of the azimuths. */
    void addTo(const types::Sonar& fan, const types::SonarTruth& truth, size_t column, types::SonarTruth& azimuths);
    /** Tells in place `cell` of `returns` what bin `bin` of beam `beam` of an azimuth shows. */
    static void tellReturn(const types::SonarTruth& truth, size_t beam, size_t bin, size_t cell,
                           types::SonarTruth& returns);
    /** Makes a bin one that has heard nothing. */
    static void forget(size_t at, types::SonarTruth& truth);

private:
    /** What one object sends back to a bin by one path. */
    struct Echo {
        int32_t object;
        uint8_t path;
        double energy, elevation, grazing;  ///< Angles weighted by energy [rad].
    };
    void tellBin(size_t at, double energy, uint32_t hits, types::SonarTruth& azimuths) const;

    std::vector<Echo> echoes_;  ///< In one bin.
};

}  // namespace insonify::sonar
