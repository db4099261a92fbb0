#pragma once
#include <optional>

#include "components/study/ErrorStudy.hpp"

namespace insonify::study {

/** What the reference of a scene is wrong by; 0 when it is exact. */
double referenceError(const ErrorResult& result, const std::string& scene);

/** The points of a scene and method in which rows and columns are doubled together, coarsest first. */
std::vector<Measurement> ladder(const ErrorResult& result, const std::string& scene, Method method);

/** Slope of ln(rel_l2) over ln(samples), fitted through the points with an error below one half and above 10 times that
 * of the reference; nothing with fewer than two of them. */
std::optional<double> slope(const std::vector<Measurement>& points, double reference_error);

/** Time to reach an error [ms], from the line through the two points about it on logarithmic scales. Coarsest point
 * good enough: its time, an upper bound. Finest point not good enough: extended from the last two, nothing when they
 * hardly fall: further than 30 times the finest point's time. */
std::optional<double> timeTo(double error, const std::vector<Measurement>& points);

/** Error that is reached in a time, likewise; the nearest point's beyond the ends. */
std::optional<double> errorAt(double ms, const std::vector<Measurement>& points);

/** Whether no other point of the scene is both faster and more accurate. */
bool onParetoFront(const Measurement& point, const ErrorResult& result);

/** A claim, what came out, and whether it holds. */
struct Claim {
    std::string text;
    double measured, bound;
    bool at_most;  ///< The bound is an upper one, else a lower one.
    bool holds() const { return at_most ? measured <= bound : measured >= bound; }
};

/** Every claim that the scenes at hand can settle. */
std::vector<Claim> claims(const ErrorResult& result);

}  // namespace insonify::study
