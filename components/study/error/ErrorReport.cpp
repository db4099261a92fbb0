#include "components/study/error/ErrorReport.hpp"

#include <fmt/format.h>

#include <iterator>

namespace insonify::study {
namespace {

using Out = std::back_insert_iterator<std::string>;

void addReferences(Out out, const ErrorResult& result) {
    fmt::format_to(out,
                   "## References\n\n| scene | reference | its own error | with TVG |\n| --- | --- | --- | --- |\n");
    for (const Reference& r : result.references)
        fmt::format_to(out, "| {} | {} | {:.1e} | {:.1e} |\n", r.scene, r.source, r.error, r.error_tvg);
}

void addTimes(Out out, const ErrorResult& result) {
    fmt::format_to(out,
                   "\n## Time of a ping to an error\n\n| scene | method | 10 % [ms] | 1 % [ms] | 0.1 % [ms] | error "
                   "falls as cells to the |\n| --- | --- | --- | --- | --- | --- |\n");
    for (const Reference& reference : result.references)
        for (const Method method : methods) {
            const auto points = ladder(result, reference.scene, method);
            if (points.empty()) continue;
            fmt::format_to(out, "| {} | {}", reference.scene, nameOf(method));
            for (const double goal : goals) {
                const auto time = timeTo(goal, points);
                fmt::format_to(out, " | {}{}", time ? time->text() : "never",
                               goal < blurred * reference.error ? " (open)" : "");
            }
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
                       m.scene, nameOf(m.method), m.rows, m.columns_per_beam, e.rel_l2, e.rel_l2_tvg, e.db_rmse,
                       e.missing_bins, e.ghost_bins, e.energy_bias, e.ripple, m.kappa_max, m.median_ms, m.p99_ms,
                       m.cpu_ms);
    }
}

}  // namespace

std::string sheetOf(const ErrorResult& result) {
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
