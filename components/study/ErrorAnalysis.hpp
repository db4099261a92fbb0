#pragma once
#include <optional>
#include <string>

#include "components/study/ErrorStudy.hpp"

namespace insonify::study {

/** Planes that fill the view, whose error falls by a power of the number of cells. */
inline constexpr const char* slope_scenes[] = {"flat_bottom",  "flat_bottom_edge",       "flat_bottom_pitched",
                                               "tilted_plane", "pitched_bottom_pattern", "wall"};

/** What the reference of a scene is wrong by; 0 when it is exact. */
double referenceError(const ErrorResult& result, const std::string& scene);

/** The points of a scene and method in which rows and columns are doubled together, coarsest first. */
std::vector<Measurement> ladder(const ErrorResult& result, const std::string& scene, Method method);

/** Slope of ln(rel_l2) over ln(cells), fitted through the points with an error below one half and above 10 times that
 *  of the reference; nothing with fewer than two of them. */
std::optional<double> slope(const std::vector<Measurement>& points, double reference_error);

/** A time that was not measured, but found from those that were. */
struct ReachTime {
    enum class Kind {
        Interpolated,  ///< Between two points.
        AtMost,        ///< The coarsest point's: it is good enough.
        Extrapolated,  ///< On the line through the last two points, beyond the finest.
    };
    double ms;
    Kind kind;
    double beyond = 1;  ///< Extrapolated: over the finest point's time [1].

    /** "24", "at most 3.1", "103 (extrapolated, 4.2 x the finest)". */
    std::string text() const;
};
/** "interpolated", "at_most", "extrapolated". */
const char* nameOf(ReachTime::Kind kind);

/** Time to reach an error, from the line through the two points about it on logarithmic scales. Finest point not good
 *  enough: extended from the last two, nothing when they hardly fall: further than 30 times the finest point's time. */
std::optional<ReachTime> timeTo(double error, const std::vector<Measurement>& points);

/** Error that is reached in a time, likewise; the nearest point's beyond the ends. */
std::optional<double> errorAt(double ms, const std::vector<Measurement>& points);

/** Whether no other point of the scene is both faster and more accurate. */
bool onParetoFront(const Measurement& point, const ErrorResult& result);

/** A claim, what came out, and whether it holds. Bounds are what is promised, set before anything is measured. */
struct Claim {
    std::string text;
    double measured, bound;
    bool at_most;         ///< The bound is an upper one, else a lower one.
    bool settled = true;  ///< False: it is about the study itself, or its reference or levels are too coarse to tell.
    bool timed = false;   ///< It compares run times, which a busy machine may change.
    bool holds() const { return at_most ? measured <= bound : measured >= bound; }
    bool fails() const { return settled && !holds(); }
    /** "pass", "FAIL", or "open": does not hold, but that is the study's limit and says nothing about the scene. */
    const char* verdict() const { return holds() ? "pass" : fails() ? "FAIL" : "open"; }
};

/** Every claim that the scenes at hand have something to say about. */
std::vector<Claim> claims(const ErrorResult& result);

}  // namespace insonify::study
