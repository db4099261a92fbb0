#pragma once
#include <cstdint>
#include <vector>

#include "types/Sonar.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::sonar {

/** The truth of a grid of beams, column by column: for each azimuth the sum over its elevations, and for each beam of
 *  the grid what its return shows.
 *
 *  The truth of a beam has one object and path per bin, the strongest. So the shares of an azimuth count only the
 *  strongest object of each beam. Elevations are those of the beams, within half their spacing. */
class GridTruth {
public:
    /** Allocates the azimuths, with the grid of `ping`, and the beams of the grid in `returns`, one bin each: row by
     *  row from the top, each from port to starboard. */
    static void shape(const types::Sonar& ping, size_t rows, types::SonarTruth& azimuths, types::SonarTruth& returns);
    /** Adds the truth of one azimuth to beam `column` of the azimuths. The beams of `fan` are its elevations from the
     *  lowest to the highest [rad]. */
    void addTo(const types::Sonar& fan, const types::SonarTruth& truth, size_t column, types::SonarTruth& azimuths);
    /** Copies bin `bin` of beam `beam` of an azimuth's truth to index `cell` of `returns`. */
    static void copyReturn(const types::SonarTruth& truth, size_t beam, size_t bin, size_t cell,
                           types::SonarTruth& returns);
    /** Clears a bin: it has no echo. */
    static void forget(size_t at, types::SonarTruth& truth);

private:
    /** The echo of one object in a bin via one path. */
    struct Echo {
        int32_t object;
        uint8_t path;
        double energy, elevation, grazing;  ///< Angles weighted by energy [rad].
    };
    void fillBin(size_t at, double energy, uint32_t hits, types::SonarTruth& azimuths) const;

    std::vector<Echo> echoes_;  ///< Echoes in one bin.
};

}  // namespace insonify::sonar
