#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/renderer/Metrics.hpp"
#include "components/study/StudyScene.hpp"

namespace insonify::study {

/** Effects that a study of the error adds to a plain scene, one at a time. */
enum class Effect { PatternAndPulse, Seabed, Volume, Multipath, Coherent };
inline constexpr Effect effects[] = {Effect::PatternAndPulse, Effect::Seabed, Effect::Volume, Effect::Multipath,
                                     Effect::Coherent};

/** Returns a scene with one effect. Its name is the plain scene's, followed by "_pattern_and_pulse", "_seabed",
 *  "_volume", "_multipath" or "_coherent"; its reference must be computed.
 *
 *  Pattern and pulse have the proportions of deploy/harbour_recording.yml: a Taylor beam of -25 dB, 4 beams wide,
 *  transmitted slightly wider than the fan, and a chirp, weighted by Hann, whose c / 2B is 0.6 bins. Seabeds follow
 *  APL-UW TR 9407 at 100 kHz, with medium sand if a scene has none. Water scatters -50 dB re 1/m. The surface is the
 *  scene's, or 3 m above the sonar. Coherent speckle adds neither pattern nor pulse. */
StudyScene withEffect(const StudyScene& plain, Effect effect);

using sonar::compare, sonar::Layout, sonar::Metrics;

/** The way to estimate energies; see sonar::Estimator. `Published`: nearest bin on one wide frustum with rounded
 *  columns. */
enum class Method { Footprint, Nearest, NearestJitter, Published, Embree };
inline constexpr Method methods[] = {Method::Footprint, Method::Nearest, Method::NearestJitter, Method::Published,
                                     Method::Embree};
/** Returns "footprint", "nearest", "nearest_jitter", "published" or "embree". */
const char* getName(Method method);

/** One point of a work-precision diagram. */
struct Measurement {
    std::string scene;
    Method method = Method::Footprint;
    int rows = 0, columns_per_beam = 0;  ///< [1]
    int merged = 1;  ///< Max number of neighbouring samples of one plane that form one cell (ACOUSTICS.md 4.4) [1].
    Metrics metrics;
    double kappa_max = 0;                          ///< Bins that the longest cell covers; 0: unknown [1].
    double median_ms = 0, p99_ms = 0, cpu_ms = 0;  ///< Times of one ping: wall time, and processor time of the process.
    double samples() const { return static_cast<double>(rows) * columns_per_beam; }  ///< Per beam.
    double cells() const { return samples() / merged; }  ///< Per beam, if one plane fills it.
};

/** Factor by which a reference must be more accurate than every point that is compared with it [1]. */
constexpr double reference_margin = 10;

/** The origin of a scene's reference. */
struct Reference {
    std::string scene, source;  ///< "closed form", or the way it was computed.
    double error = 0;           ///< Its own rel_l2, estimated from two independent halves; 0: exact to rounding.
    double error_tvg = 0;       ///< Its own rel_l2_tvg, likewise.
    double rays = 0;            ///< Numbers of rays traced and points drawn for it; 0: none [1].
};

/** The quality that `quality: {target_error}` chose for a scene, and its measured error; errors are rel_l2_tvg. */
struct Prediction {
    std::string scene;
    int rows, columns_per_beam;                   ///< [1]
    double target_error, predicted_error, error;  ///< [1]
};

struct ErrorResult {
    std::vector<Measurement> measurements;
    std::vector<Prediction> predictions;  ///< One for each scene.
    std::vector<Reference> references;
    std::string device;  ///< Name of the OpenGL renderer.
};

struct ErrorOptions {
    int pings = 30;  ///< Pings timed for each point, after a warm-up [1].
    std::optional<int>
        levels;  ///< Number of doublings of rows and columns, plus one; 5, or 4 without a closed form [1].
    double reference_rays = 2e9;  ///< Max number of rays and points for the finest reference without a closed form [1].
    int coherent_poses = 64;      ///< Number of poses over which pings with coherent speckle are averaged [1].
    std::function<void(const std::string&)> progress = [](const std::string&) {};
};

/** Measures all methods on all scenes. Rows and columns are doubled together from 64 rows on; footprints also with rows
 *  alone (2 columns per beam). A scene without truth gets a brute-force reference (PointTracer) of two independent
 *  halves. It is refined until their mean is ten times more accurate than every point, or the rays are used up. */
ErrorResult studyError(const std::vector<StudyScene>& scenes, const ErrorOptions& options);

/** Measures the error of pings with coherent speckle against energies: of their mean over many poses, for each of at
 *  most three qualities.
 *
 *  A single ping differs by its speckle, which is not an error. So the poses are divided into two halves with
 *  independent speckle. Their means are A and B, those of the energies R and S. The squared error is (A - R)(B - S) /
 *  (R S), summed over bins; the mean contribution of speckle to it is zero. Its random contribution, the root of the
 *  sum of the squared products, is reported as the reference's own error. Smaller errors are reported as that. */
void studyCoherent(const StudyScene& scene, const ErrorOptions& options, int min_rows, int base_columns,
                   ErrorResult& result);

}  // namespace insonify::study
