#include "components/study/error/ErrorAnalysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "components/sonar/renderer/Quality.hpp"

namespace insonify::study {
namespace {

bool has(const ErrorResult& result, const std::string& scene) {
    return std::ranges::find(result.references, scene, &Reference::scene) != result.references.end();
}

const Measurement* find(const ErrorResult& result, const std::string& scene, Method method, int rows, int columns) {
    const auto found = std::ranges::find_if(result.measurements, [&](const Measurement& m) {
        return m.scene == scene && m.method == method && m.rows == rows && m.columns_per_beam == columns;
    });
    return found == result.measurements.end() ? nullptr : &*found;
}

constexpr size_t slope_points = 4;  ///< With fewer points a slope, or an extrapolated time, is open [1].
/** Max time of a ping of 1 % error over that of the ray tracer. Both trace rays, and clocks are noisy [1]. */
constexpr double as_fast_as_rays = 1.25;
constexpr double farthest_extension = 30;  ///< Relative to the finest point's time; beyond it is "never" [1].

/** Returns a remark if one of two compared times was not measured. */
std::string marked(const ReachTime& a, const ReachTime& b) {
    const auto is = [&](ReachTime::Kind kind) { return a.kind == kind || b.kind == kind; };
    return is(ReachTime::Kind::Extrapolated) ? " (extrapolated)" : is(ReachTime::Kind::AtMost) ? " (a bound)" : "";
}

double onLine(double x, double x1, double y1, double x2, double y2) {
    return std::exp(std::log(y1) +
                    (std::log(x) - std::log(x1)) * (std::log(y2) - std::log(y1)) / (std::log(x2) - std::log(x1)));
}

void evaluateFlatBottom(const ErrorResult& result, std::vector<Claim>& all) {
    if (const Measurement* m = find(result, "flat_bottom", Method::Footprint, 512, 2))
        all.push_back({"flat bottom, 512 rows: mean relative L2 of footprints", m->metrics.mean_rel_l2, 5e-4, true});
    if (const Measurement* m = find(result, "flat_bottom_edge", Method::Footprint, 512, 2))
        all.push_back({"flat bottom with the aperture's edge, 512 rows: mean relative L2 of footprints",
                       m->metrics.mean_rel_l2, 3e-3, true});
    if (const Measurement* m = find(result, "pitched_bottom_pattern", Method::Footprint, 512, 2))
        all.push_back({"pitched bottom with a pattern in elevation, 512 rows: relative L2 of footprints",
                       m->metrics.rel_l2, 0.01, true});
    const auto footprint = ladder(result, "flat_bottom", Method::Footprint),
               nearest = ladder(result, "flat_bottom", Method::Nearest);
    if (footprint.empty() || nearest.empty()) return;
    const auto slow = timeTo(0.01, nearest, without_gain), fast = timeTo(0.01, footprint, without_gain);
    if (slow && fast)
        all.push_back({"flat bottom, error of 1 % without gain: time of nearest bin over that of footprints" +
                           marked(*slow, *fast),
                       slow->ms / fast->ms, 30, false,
                       marked(*slow, *fast).empty() || std::min(nearest.size(), footprint.size()) >= slope_points,
                       true});
    const double ms = std::min(nearest.back().median_ms, footprint.back().median_ms);
    all.push_back({fmt::format("flat bottom, {:.3g} ms: error without gain of nearest bin over that of footprints", ms),
                   *errorAt(ms, nearest) / *errorAt(ms, footprint), 20, false, true, true});
}

void evaluateSlopes(const ErrorResult& result, std::vector<Claim>& all) {
    for (const char* scene : slope_scenes) {
        if (!has(result, scene)) continue;
        const double error = referenceError(result, scene);
        const auto footprint = ladder(result, scene, Method::Footprint),
                   nearest = ladder(result, scene, Method::Nearest);
        if (const auto s = slope(footprint, error))
            all.push_back({fmt::format("{}: slope of footprints over cells", scene), *s, -0.85, true,
                           footprint.size() >= slope_points});
        if (const auto s = slope(nearest, error)) {
            all.push_back({fmt::format("{}: slope of nearest bin over cells, at most", scene), *s, -0.6, true,
                           nearest.size() >= slope_points});
            all.push_back({fmt::format("{}: slope of nearest bin over cells, at least", scene), *s, -1.0, false,
                           nearest.size() >= slope_points});
        }
    }
}

void evaluateComputed(const ErrorResult& result, std::vector<Claim>& all) {
    for (const Reference& reference : result.references) {
        if (!(reference.error > 0)) continue;
        double minimum = std::numeric_limits<double>::infinity();
        for (const Measurement& m : result.measurements)
            if (m.scene == reference.scene) minimum = std::min(minimum, m.metrics.rel_l2);
        all.push_back({fmt::format("{}: smallest error over that of the reference ({:.2g} rays)", reference.scene,
                                   reference.rays),
                       minimum / reference.error, reference_margin, false, false});
        const auto traced = ladder(result, reference.scene, Method::Embree);
        const auto rays = timeTo(0.01, traced, with_gain),
                   drawn = timeTo(0.01, ladder(result, reference.scene, Method::Footprint), with_gain);
        if (!rays || !drawn || rays->kind == ReachTime::Kind::AtMost) continue;
        const bool settled = reference.error_tvg * reference_margin <= 0.01 && marked(*rays, *drawn).empty();
        all.push_back({fmt::format("{}, error of 1 %: time of rays (Embree) over that of footprints{}", reference.scene,
                                   marked(*rays, *drawn)),
                       rays->ms / drawn->ms, 1 / as_fast_as_rays, false, settled, true});
    }
}

/** Checks predictions. In scenes with a closed form, the coarsest available quality may be better than required. */
void evaluatePredictions(const ErrorResult& result, std::vector<Claim>& all) {
    for (const Prediction& p : result.predictions) {
        const auto reference = std::ranges::find(result.references, p.scene, &Reference::scene);
        if (reference == result.references.end()) continue;
        const bool settled = reference->error_tvg * reference_margin <= p.target_error;
        // Where the finest samples miss the target, the promise is what the sonar predicts for them, and reports.
        const bool is_reached = p.predicted_error <= p.target_error;
        const std::string text =
            fmt::format("{}, target_error {}: error over {}, {} rows, {} columns per beam", p.scene, p.target_error,
                        is_reached ? "target" : "what is predicted and reported", p.rows, p.columns_per_beam);
        all.push_back({text, p.error / std::max(p.target_error, p.predicted_error), 1, true, settled});
        const bool is_coarsest = sonar::Quality{p.rows, p.columns_per_beam} == sonar::Quality();
        if (reference->rays == 0 && !is_coarsest)
            all.push_back({text, p.error / p.target_error, 0.1, false});  // not wasteful either
    }
}

using Out = std::back_insert_iterator<std::string>;

void addReferences(Out out, const ErrorResult& result) {
    fmt::format_to(out,
                   "## References\n\n| scene | reference | its own error | with TVG |\n| --- | --- | --- | --- |\n");
    for (const Reference& r : result.references)
        fmt::format_to(out, "| {} | {} | {:.1e} | {:.1e} |\n", r.scene, r.source, r.error, r.error_tvg);
}

void addTimes(Out out, const ErrorResult& result) {
    fmt::format_to(out,
                   "\n## Time of a ping to an error\n\nErrors after a gain of 50 log10(range), in brackets without "
                   "it.\n\n| scene | method");
    for (const double goal : goals) fmt::format_to(out, " | {:g} % [ms]", 100 * goal);
    fmt::format_to(out, " | error without gain falls as cells to the |\n| --- | --- | --- | --- | --- | --- | --- |\n");
    for (const Reference& reference : result.references)
        for (const Method method : methods) {
            const auto points = ladder(result, reference.scene, method);
            if (points.empty()) continue;
            fmt::format_to(out, "| {} | {}", reference.scene, getName(method));
            const auto text = [&](double goal, Measure measure) {
                const auto time = timeTo(goal, points, measure);
                return (time ? time->text() : "never") +
                       (goal < blurred * referenceError(result, reference.scene, measure) ? " (open)" : "");
            };
            for (const double goal : goals)
                fmt::format_to(out, " | {} [{}]", text(goal, with_gain), text(goal, without_gain));
            const auto power = slope(points, reference.error);
            fmt::format_to(out, " | {} |\n", power ? fmt::format("{:.2f}", *power) : "");
        }
    fmt::format_to(out,
                   "\nTimes are on the line between two points. At most: the coarsest point is good enough. "
                   "Extrapolated: beyond the finest point, along the last two. Never: more than 30 times the finest "
                   "point's time. Open: the reference's own error is too near.\n");
}

void addPredictions(Out out, const ErrorResult& result) {
    fmt::format_to(
        out,
        "\n## Error as a control\n\n| scene | target | rows | columns | predicted | error, with TVG |\n| --- "
        "| --- | --- | --- | --- | --- |\n");
    for (const Prediction& p : result.predictions)
        fmt::format_to(out, "| {} | {} | {} | {} | {:.2g} | {:.2g} |\n", p.scene, p.target_error, p.rows,
                       p.columns_per_beam, p.predicted_error, p.error);
}

void addClaims(Out out, const ErrorResult& result) {
    fmt::format_to(out, "\n## Claims\n\n| claim | measured | bound | verdict |\n| --- | --- | --- | --- |\n");
    for (const Claim& c : claims(result))
        fmt::format_to(out, "| {} | {:.4g} | {} {:.4g} | {} |\n", c.text, c.measured,
                       c.at_most ? "at most" : "at least", c.bound, c.verdict());
    fmt::format_to(out,
                   "\nOpen: the reference, or the levels that were asked for, are too coarse to decide the claim.\n");
}

void addPoints(Out out, const ErrorResult& result) {
    fmt::format_to(out,
                   "\n## Every point\n\n| scene | method | rows | columns | rel. L2 | with TVG | dB rmse | missing | "
                   "ghosts | bias | ripple | kappa | median ms | p99 ms | CPU ms |\n| --- | --- | --- | --- | --- | "
                   "--- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (const Measurement& m : result.measurements) {
        const Metrics& e = m.metrics;
        fmt::format_to(out,
                       "| {} | {} | {} | {} | {:.2e} | {:.2e} | {:.3f} | {} | {} | {:.1e} | {:.1e} | {:.1f} | {:.3f} | "
                       "{:.3f} | {:.3f} |\n",
                       m.scene, getName(m.method), m.rows, m.columns_per_beam, e.rel_l2, e.rel_l2_tvg, e.db_rmse,
                       e.missing_bins, e.ghost_bins, e.energy_bias, e.ripple, m.kappa_max, m.median_ms, m.p99_ms,
                       m.cpu_ms);
    }
}

}  // namespace

double referenceError(const ErrorResult& result, const std::string& scene, Measure measure) {
    const auto found = std::ranges::find(result.references, scene, &Reference::scene);
    if (found == result.references.end()) return 0;
    return measure == with_gain ? found->error_tvg : found->error;
}

std::vector<Measurement> ladder(const ErrorResult& result, const std::string& scene, Method method) {
    std::vector<Measurement> points;
    for (const Measurement& m : result.measurements) {
        if (m.scene != scene || m.method != method) continue;
        if (points.empty() ||
            (m.rows == 2 * points.back().rows && m.columns_per_beam == 2 * points.back().columns_per_beam))
            points.push_back(m);
    }
    return points;
}

std::optional<double> slope(const std::vector<Measurement>& points, double reference_error) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Measurement& m : points) {
        if (!(m.metrics.rel_l2 < 0.5) || m.metrics.rel_l2 < 10 * reference_error) continue;
        const double a = std::log(m.cells()), b = std::log(m.metrics.rel_l2);
        n += 1, x += a, y += b, xx += a * a, xy += a * b;
    }
    const double spread = n * xx - x * x;
    if (n < 2 || !(spread > 1e-9 * n * xx)) return std::nullopt;  // also if merging leaves cells unchanged
    return (n * xy - x * y) / spread;
}

const char* getName(ReachTime::Kind kind) {
    switch (kind) {
        case ReachTime::Kind::Interpolated: return "interpolated";
        case ReachTime::Kind::AtMost: return "at_most";
        case ReachTime::Kind::Extrapolated: return "extrapolated";
    }
    return "";
}

std::string ReachTime::text() const {
    switch (kind) {
        case Kind::Interpolated: return fmt::format("{:.3g}", ms);
        case Kind::AtMost: return fmt::format("at most {:.3g}", ms);
        case Kind::Extrapolated: return fmt::format("{:.3g} (extrapolated, {:.2g} x the finest)", ms, beyond);
    }
    return "";
}

std::optional<ReachTime> timeTo(double error, const std::vector<Measurement>& points, Measure measure) {
    if (points.empty()) return std::nullopt;
    if (points.front().metrics.*measure <= error) return ReachTime{points.front().median_ms, ReachTime::Kind::AtMost};
    for (size_t i = 1; i < points.size(); ++i) {
        const Measurement &coarse = points[i - 1], &fine = points[i];
        const double before = coarse.metrics.*measure, after = fine.metrics.*measure;
        if (after > error && i + 1 < points.size()) continue;
        if (after >= before) return std::nullopt;
        const double ms = onLine(error, before, coarse.median_ms, after, fine.median_ms);
        if (!(ms < farthest_extension * fine.median_ms)) return std::nullopt;
        if (after > error) return ReachTime{ms, ReachTime::Kind::Extrapolated, ms / fine.median_ms};
        return ReachTime{ms, ReachTime::Kind::Interpolated};
    }
    return std::nullopt;
}

std::optional<double> errorAt(double ms, const std::vector<Measurement>& points) {
    if (points.empty()) return std::nullopt;
    if (ms <= points.front().median_ms) return points.front().metrics.rel_l2;
    for (size_t i = 1; i < points.size(); ++i)
        if (points[i].median_ms >= ms)
            return onLine(ms, points[i - 1].median_ms, points[i - 1].metrics.rel_l2, points[i].median_ms,
                          points[i].metrics.rel_l2);
    return points.back().metrics.rel_l2;
}

bool onParetoFront(const Measurement& point, const ErrorResult& result) {
    return std::ranges::none_of(result.measurements, [&](const Measurement& other) {
        return other.scene == point.scene && other.median_ms < point.median_ms &&
               other.metrics.rel_l2_tvg < point.metrics.rel_l2_tvg;
    });
}

std::vector<Claim> claims(const ErrorResult& result) {
    std::vector<Claim> all;
    evaluateFlatBottom(result, all);
    evaluateSlopes(result, all);
    evaluateComputed(result, all);
    evaluatePredictions(result, all);
    return all;
}

std::string makeSheet(const ErrorResult& result) {
    std::string text = "# Error against run time\n\n";
    const Out out(text);
    addReferences(out, result);
    addTimes(out, result);
    addPredictions(out, result);
    addClaims(out, result);
    addPoints(out, result);
    return text;
}

}  // namespace insonify::study
