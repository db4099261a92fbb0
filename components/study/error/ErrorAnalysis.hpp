#pragma once
#include <optional>
#include <string>

#include "components/study/error/ErrorStudy.hpp"

namespace insonify::study {

/** Scenes with planes that fill the view; their error falls as a power of the number of cells. */
inline constexpr const char* slope_scenes[] = {"flat_bottom",  "flat_bottom_edge",       "flat_bottom_pitched",
                                               "tilted_plane", "pitched_bottom_pattern", "wall"};

/** A measure of error (ACOUSTICS.md 10.1). After a gain of 50 log10(r) far bins count as near bins do, as in the
 *  picture that a sonar shows and in its own target; without it the nearest bins decide. */
using Measure = double sonar::Metrics::*;
inline constexpr Measure with_gain = &sonar::Metrics::rel_l2_tvg, without_gain = &sonar::Metrics::rel_l2;

/** Returns the error of a scene's reference; 0 if it is exact. */
double referenceError(const ErrorResult& result, const std::string& scene, Measure measure = without_gain);

/** Returns the points of a scene and method in which rows and columns are doubled together, coarsest first. */
std::vector<Measurement> ladder(const ErrorResult& result, const std::string& scene, Method method);

/** Returns the slope of ln(rel_l2) over ln(cells), fitted through the points with an error below one half and above 10
 *  times that of the reference; none for fewer than two points. */
std::optional<double> slope(const std::vector<Measurement>& points, double reference_error);

/** A time that is derived from measured times. */
struct ReachTime {
    enum class Kind {
        Interpolated,  ///< Between two points.
        AtMost,        ///< The coarsest point's time: its error is small enough.
        Extrapolated,  ///< On the line through the last two points, beyond the finest point.
    };
    double ms;
    Kind kind;
    double beyond = 1;  ///< If extrapolated: relative to the finest point's time [1].

    /** Returns "24", "at most 3.1" or "103 (extrapolated, 4.2 x the finest)". */
    std::string text() const;
};
/** Returns "interpolated", "at_most" or "extrapolated". */
const char* getName(ReachTime::Kind kind);

/** Returns the time to reach an error, from the line through the two neighbouring points on logarithmic scales. If the
 *  finest point's error is too large, the line through the last two points is extended. None if they hardly fall, or
 *  beyond 30 times the finest point's time. */
std::optional<ReachTime> timeTo(double error, const std::vector<Measurement>& points, Measure measure);

/** Returns the error that is reached in a time, likewise; beyond the ends that of the nearest point. */
std::optional<double> errorAt(double ms, const std::vector<Measurement>& points);

/** Returns whether no other point of the scene is both faster and more accurate. */
bool onParetoFront(const Measurement& point, const ErrorResult& result);

/** A claim, its measured value, and whether it holds. Bounds are promises, set before the measurement. */
struct Claim {
    std::string text;
    double measured, bound;
    bool at_most;         ///< The bound is an upper bound, else a lower bound.
    bool settled = true;  ///< False: it is about the study itself, or its reference or levels are too coarse to decide.
    bool timed = false;   ///< It compares run times, which a busy machine may change.
    bool holds() const { return at_most ? measured <= bound : measured >= bound; }
    bool fails() const { return settled && !holds(); }
    /** Returns "pass", "FAIL", or "open": it does not hold, but because of the study's limits, not the scene. */
    const char* verdict() const { return holds() ? "pass" : fails() ? "FAIL" : "open"; }
};

/** Returns every claim that the result's scenes can decide. */
std::vector<Claim> claims(const ErrorResult& result);

/** Errors for which times are reported [1]. */
inline constexpr double goals[] = {0.1, 0.01, 0.003, 0.001};
/** Below this multiple of its own error, a reference adds more than 5 % to the measured error [1]. */
inline constexpr double blurred = 3;

/** Returns tables in Markdown: references, times to an error, chosen qualities, claims, every point. */
std::string makeSheet(const ErrorResult& result);

}  // namespace insonify::study
