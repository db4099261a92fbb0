#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/quality/Metrics.hpp"
#include "components/study/StudyScene.hpp"

namespace insonify::study {

using sonar::compare, sonar::Layout, sonar::Metrics;

/** How energies are estimated; see sonar::Estimator. `Published`: nearest bin on one wide frustum with rounded columns.
 */
enum class Method { Footprint, Nearest, NearestJitter, Published, Embree };
inline constexpr Method methods[] = {Method::Footprint, Method::Nearest, Method::NearestJitter, Method::Published,
                                     Method::Embree};
/** "footprint", "nearest", "nearest_jitter", "published", "embree". */
const char* nameOf(Method method);

/** One point of a work-precision diagram. */
struct Measurement {
    std::string scene;
    Method method = Method::Footprint;
    int rows = 0, columns_per_beam = 0;  ///< [1]
    int merged = 1;  ///< Neighbouring samples of one plane that are one cell, at most (ACOUSTICS.md 4.4) [1].
    Metrics metrics;
    double kappa_max = 0;                          ///< Bins that the longest cell covers; 0: not known [1].
    double median_ms = 0, p99_ms = 0, cpu_ms = 0;  ///< Of one ping: wall time, and processor time of the process.
    double samples() const { return static_cast<double>(rows) * columns_per_beam; }  ///< Per beam.
    double cells() const { return samples() / merged; }  ///< Per beam, where one plane fills it.
};

/** What a reference is to be finer by than any point that is compared with it [1]. */
constexpr double reference_margin = 10;

/** Where the reference of a scene comes from. */
struct Reference {
    std::string scene, source;  ///< "closed form", or how it was computed.
    double error = 0;           ///< Its own rel_l2, estimated from two independent halves; 0: exact to rounding.
    double error_tvg = 0;       ///< Its own rel_l2_tvg, likewise.
    double rays = 0;            ///< Cast for it, and points drawn; 0: none [1].
};

/** What `quality: {target_error}` chose for a scene, and what became of it; errors are rel_l2_tvg. */
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
    int pings = 30;  ///< Timed for each point, after a warm-up [1].
    int levels = 5;  ///< Rows and columns are doubled together so often, less one; at most 4 without a closed form [1].
    double reference_rays = 2e9;  ///< And points, at most, for the finest reference that has no closed form [1].
    int coherent_poses = 64;      ///< Over which pings with coherent speckle are averaged [1].
    std::function<void(const std::string&)> progress = [](const std::string&) {};
};

/** Measures all methods on all scenes: rows and columns doubled together from 64 rows on; footprints also with rows
 *  alone (2 columns per beam). A scene without truth gets a reference by brute force (PointCaster):
 *  two independent halves, made finer until their mean is ten times finer than every point, or the rays are used up. */
ErrorResult studyError(const std::vector<StudyScene>& scenes, const ErrorOptions& options);

}  // namespace insonify::study
