#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** The echo of one object via one kind of path, in one bin. */
struct SurfaceEcho {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    std::string path;           ///< "direct", "through a wall", ...
    std::string material, law;  ///< Of the strongest triangle, else of the object's first; "Lambert's law, -27.0 dB".
    /** Means over the echoes that belong into the bin, weighted by energy; unknown where the echo only arrives there
     *  through sidelobes, by the length of the pulse, or by errors of the device; the elevation also for a sum over all
     *  beams [rad]. */
    double grazing = unknown, elevation = unknown;
    double strength_db = unknown;  ///< Backscatter at that grazing angle; unknown for a law with a lobe [dB].
    /** Of its strongest echo in the bin, by the weights of the beam, else in any bin; unknown for a sum over all beams
     *  [rad, m]. */
    double bearing = unknown, range = unknown;
    bool is_in_beam = false;  ///< Whether the beam points at that echo in the bin: it is not of a sidelobe.
    std::vector<std::pair<uint32_t, double>>
        triangles;  ///< Number in the mesh, and share of the echo; strongest first.
};

/** A part of the intensity of a bin. */
struct BinPart {
    std::string name;                       ///< Of the object or the effect.
    double intensity = 0;                   ///< [1/m^2]
    std::optional<SurfaceEcho> of_surface;  ///< None: of an effect.
};

/** What made the intensity of one bin of a noiseless ping. */
struct BinExplanation {
    double near_edge = 0, far_edge = 0;  ///< Slant range [m].
    double intensity = 0;                ///< When rendered again: the ping's, or `is_mean` [1/m^2].
    bool is_mean = false;                ///< Echoes interfere: the intensity is the mean over all speckle.
    std::vector<BinPart> parts;          ///< Strongest first.
    std::string why_no_surface;          ///< Why no surface has an echo in the bin; empty: one has.
    bool depends_on_past = false;        ///< Rendered twice, the bin differs: an effect remembers pings. No parts.
};

/** Explains one bin of one beam, in the order of the ping; no beam: of the sum over all beams. Renders the scene once
 *  for all parts, and then with groups of objects and effects, until each part above a thousandth of the bin is alone.
 *  Parts below that are summed up in one. Rasterises or traces rays on one thread, as SonarRenderer, with the same
 *  requirements.
 *  @param config with the quality of the ping
 *  @throws std::out_of_range for a beam or bin that the sonar does not have, and as SonarRenderer does */
BinExplanation explainBin(const SonarConfig& config, const types::Snapshot& scene, std::optional<size_t> beam,
                          size_t bin);

/** Returns an explanation as lines of text. */
std::string text(const BinExplanation& explanation);

/** Returns "1.2e-05, -49.2 dB" for an intensity; "no echo" for 0. */
std::string intensityText(double intensity);

}  // namespace insonify::sonar
