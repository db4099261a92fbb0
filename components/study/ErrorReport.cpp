#include "components/study/ErrorReport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <utility>

#include "components/study/Plot.hpp"

namespace insonify::study {
namespace {

constexpr std::array<const char*, 5> colours = {"#0b6e99", "#d1495b", "#edae49", "#8d6a9f", "#5b8c5a"};
constexpr double blurred = 3;  ///< Times the reference's error: below, that adds more than 5 % to what is measured [1].
constexpr std::array<double, 3> goals = {0.1, 0.01, 0.001};

using Out = std::back_insert_iterator<std::string>;

/** A number, or what stands for none. */
std::string orNone(const std::optional<double>& value, const char* format, const char* none) {
    return value ? fmt::format(fmt::runtime(format), *value) : none;
}

/** Calls with scene and method wherever there are points. */
template <class F>
void forEachLadder(const ErrorResult& result, const F& f) {
    for (const Reference& reference : result.references)
        for (const Method method : methods)
            if (const auto points = ladder(result, reference.scene, method); !points.empty())
                f(reference.scene, method, points);
}

void addTable(Out out, const ErrorResult& result) {
    fmt::format_to(out,
                   "<h2>Time to an error</h2>\n<table><tr><th>scene<th>method<th>slope<th>10 % [ms]<th>1 % [ms]<th>0.1 "
                   "% [ms]</tr>\n");
    forEachLadder(result, [&](const std::string& scene, Method method, const std::vector<Measurement>& points) {
        fmt::format_to(out, "<tr><td>{}<td>{}<td>{}", scene, nameOf(method),
                       orNone(slope(points, referenceError(result, scene)), "{:.2f}", "-"));
        for (const double goal : goals) {
            const auto time = timeTo(goal, points);
            fmt::format_to(out, "<td>{}{}", time ? time->text() : "never",
                           goal < blurred * referenceError(result, scene) ? " (open)" : "");
        }
        fmt::format_to(out, "</tr>\n");
    });
    fmt::format_to(
        out,
        "</table>\n<p>Times lie on the line between two points; <i>at most</i>: the coarsest point is good "
        "enough; <i>extrapolated</i>: beyond the finest point, along the last two; <i>open</i>: the reference's "
        "own error is too near.</p>\n");
}

void addVerdicts(Out out, const ErrorResult& result) {
    fmt::format_to(out, "<h2>Claims</h2>\n<table><tr><th>claim<th>measured<th>bound<th>verdict</tr>\n");
    for (const Claim& v : claims(result))
        fmt::format_to(out, "<tr><td>{}<td>{:.4g}<td>{} {:.4g}<td>{}</tr>\n", v.text, v.measured,
                       v.at_most ? "at most" : "at least", v.bound, v.fails() ? "<b>FAIL</b>" : v.verdict());
    fmt::format_to(
        out,
        "</table>\n<p>Bounds are what is promised. <i>open</i>: the reference, or the levels that were asked "
        "for, are too coarse to tell; that is this study's limit, and nothing is wrong with the scene.</p>\n");
}

void addPoints(Out out, const ErrorResult& result) {
    fmt::format_to(
        out,
        "<h2>Every point</h2>\n<table><tr><th>scene<th>method<th>rows<th>columns<th>slabs<th>rel L2<th>with TVG<th>dB "
        "rmse<th>missing<th>ghosts<th>bias<th>ripple<th>kappa<th>median ms<th>p99 ms<th>CPU ms</tr>\n");
    for (const Measurement& m : result.measurements) {
        const Metrics& e = m.metrics;
        fmt::format_to(out,
                       "<tr><td>{}<td>{}<td>{}<td>{}<td>{}<td>{:.2e}<td>{:.2e}<td>{:.3f}<td>{}<td>{}<td>{:.1e}<td>{:."
                       "1e}<td>{:.1f}<td>{:.3f}<td>{:.3f}<td>{:.3f}</tr>\n",
                       m.scene, nameOf(m.method), m.rows, m.columns_per_beam, m.slabs, e.rel_l2, e.rel_l2_tvg,
                       e.db_rmse, e.missing_bins, e.ghost_bins, e.energy_bias, e.ripple, m.kappa_max, m.median_ms,
                       m.p99_ms, m.cpu_ms);
    }
    fmt::format_to(out, "</table>\n");
}

void addPredictions(Out out, const ErrorResult& result) {
    fmt::format_to(out,
                   "<h2>Error as a control</h2>\n<table><tr><th>scene<th>target<th>rows<th>columns<th>predicted"
                   "<th>error, with TVG</tr>\n");
    for (const Prediction& p : result.predictions)
        fmt::format_to(out, "<tr><td>{}<td>{}<td>{}<td>{}<td>{:.2g}<td>{:.2g}</tr>\n", p.scene, p.target_error, p.rows,
                       p.columns_per_beam, p.predicted_error, p.error);
    fmt::format_to(out,
                   "</table>\n<p>What a prediction makes of the change between two qualities was set by looking at the "
                   "scenes with a closed form: the others are its test.</p>\n");
}

/** Without what JSON and HTML would have to quote. */
std::string plain(std::string text) {
    std::erase_if(text, [](char c) {
        return c == '"' || c == '\\' || c == '<' || c == '&' || static_cast<unsigned char>(c) < ' ';
    });
    return text;
}

std::string processorName() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name") && line.size() > line.find(':') + 2)
            return plain(line.substr(line.find(':') + 2));
    return "unknown processor";
}

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    if (!file.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", path.string()));
}

}  // namespace

std::string csvOf(const ErrorResult& result) {
    std::string text =
        "scene,method,rows,columns_per_beam,samples_per_pixel,slabs,rel_l2,rel_l2_tvg,db_rmse,db_p95,missing_bins,"
        "ghost_bins,"
        "first_return_bins,shadow_bins,energy_bias,ripple,kappa_max,hash,median_ms,p99_ms,cpu_ms\n";
    for (const Measurement& m : result.measurements) {
        const Metrics& e = m.metrics;
        fmt::format_to(Out(text),
                       "{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:016x},"
                       "{:.6g},{:.6g},{:.6g}\n",
                       m.scene, nameOf(m.method), m.rows, m.columns_per_beam, m.samples_per_pixel, m.slabs, e.rel_l2,
                       e.rel_l2_tvg, e.db_rmse, e.db_p95, e.missing_bins, e.ghost_bins, e.first_return_bins,
                       e.shadow_bins, e.energy_bias, e.ripple, m.kappa_max, e.hash, m.median_ms, m.p99_ms, m.cpu_ms);
    }
    return text;
}

std::string jsonOf(const ErrorResult& result) {
    std::string text = fmt::format("{{\"device\": \"{}\", \"processor\": \"{}\", \"cores\": {},\n\"references\": [",
                                   plain(result.device), processorName(), std::thread::hardware_concurrency());
    Out out(text);
    const char* comma = "\n";
    const auto next = [&] { return std::exchange(comma, ",\n"); };
    for (const Reference& r : result.references)
        fmt::format_to(
            out,
            "{}{{\"scene\": \"{}\", \"source\": \"{}\", \"rays\": {:.6g}, \"error\": {:.6g}, \"error_tvg\": {:.6g}}}",
            next(), r.scene, r.source, r.rays, r.error, r.error_tvg);
    fmt::format_to(out, "],\n\"methods\": [");
    comma = "\n";
    forEachLadder(result, [&](const std::string& scene, Method method, const std::vector<Measurement>& points) {
        fmt::format_to(out, "{}{{\"scene\": \"{}\", \"method\": \"{}\", \"slope\": {}", next(), scene, nameOf(method),
                       orNone(slope(points, referenceError(result, scene)), "{:.6g}", "null"));
        for (const double goal : goals) {
            const auto time = timeTo(goal, points);
            fmt::format_to(out, ", \"ms_to_{0:g}_percent\": {1}, \"ms_to_{0:g}_percent_is\": {2}", 100 * goal,
                           time ? fmt::format("{:.6g}", time->ms) : "null",
                           time ? fmt::format("\"{}\"", nameOf(time->kind)) : "null");
        }
        fmt::format_to(out, "}}");
    });
    fmt::format_to(out, "],\n\"predictions\": [");
    comma = "\n";
    for (const Prediction& p : result.predictions)
        fmt::format_to(out,
                       "{}{{\"scene\": \"{}\", \"target_error\": {}, \"rows\": {}, \"columns_per_beam\": {}, "
                       "\"predicted_error\": {:.6g}, \"rel_l2_tvg\": {:.6g}}}",
                       next(), p.scene, p.target_error, p.rows, p.columns_per_beam, p.predicted_error, p.error);
    fmt::format_to(out, "],\n\"verdicts\": [");
    comma = "\n";
    for (const Claim& v : claims(result))
        fmt::format_to(
            out,
            "{}{{\"claim\": \"{}\", \"measured\": {:.6g}, \"bound\": {:.6g}, \"at_most\": {}, \"verdict\": \"{}\"}}",
            next(), v.text, v.measured, v.bound, v.at_most, v.verdict());
    fmt::format_to(out, "],\n\"points\": [");
    comma = "\n";
    for (const Measurement& m : result.measurements)
        fmt::format_to(out,
                       "{}{{\"scene\": \"{}\", \"method\": \"{}\", \"rows\": {}, \"columns_per_beam\": {}, \"slabs\": "
                       "{}, \"rel_l2\": {:.6g}, \"rel_l2_tvg\": {:.6g}, \"median_ms\": {:.6g}, \"pareto\": {}}}",
                       next(), m.scene, nameOf(m.method), m.rows, m.columns_per_beam, m.slabs, m.metrics.rel_l2,
                       m.metrics.rel_l2_tvg, m.median_ms, onParetoFront(m, result));
    return text + "]}\n";
}

std::string diagramOf(const ErrorResult& result, const std::string& scene) {
    std::vector<Curve> curves;
    for (const Method method : methods) {
        const auto points = ladder(result, scene, method);
        if (points.empty()) continue;
        const auto fitted = slope(points, referenceError(result, scene));
        Curve curve{fmt::format("{} {}", nameOf(method), orNone(fitted, "N^{:.2f}", "")),
                    colours[static_cast<size_t>(method)],
                    {}};
        for (const Measurement& m : points)
            if (m.metrics.rel_l2 > 0) curve.points.push_back({m.median_ms, m.metrics.rel_l2, onParetoFront(m, result)});
        curves.push_back(curve);
    }
    const double own = referenceError(result, scene);
    return logLogPlot(scene, "time of a ping, median [ms]", "relative L2 error of bin energies", curves,
                      own > 0 ? std::vector<Level>{{"error of the reference", own}} : std::vector<Level>{});
}

std::string pageOf(const ErrorResult& result) {
    std::string text =
        "<!doctype html><html lang='en'><head><meta charset='utf-8'><title>Error against run time</title><style>"
        "body{font-family:sans-serif;margin:2em;max-width:90em}table{border-collapse:collapse;font-size:13px}"
        "td,th{padding:2px 8px;white-space:nowrap;border-bottom:1px solid "
        "#dde;text-align:left}</style></head><body>\n<h1>Error against "
        "run time</h1>\n";
    Out out(text);
    fmt::format_to(
        out, "<p>{}; {} cores, {}. Errors are of noiseless energies; lines double rows and columns together.</p>\n",
        plain(result.device), std::thread::hardware_concurrency(), processorName());
    for (const Reference& reference : result.references) {
        text += diagramOf(result, reference.scene);
        fmt::format_to(out, "<p>{}: reference {}{}</p>\n", reference.scene, reference.source,
                       reference.rays > 0
                           ? fmt::format(", its own error, by what tells the halves apart: {:.1e}, with TVG "
                                         "{:.1e}",
                                         reference.error, reference.error_tvg)
                           : "");
    }
    addTable(out, result);
    addPredictions(out, result);
    addVerdicts(out, result);
    addPoints(out, result);
    return text + "</body></html>\n";
}

void writeReport(const ErrorResult& result, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    write(folder / "error_time.csv", csvOf(result));
    write(folder / "error_time.json", jsonOf(result));
    write(folder / "index.html", pageOf(result));
    for (const Reference& reference : result.references)
        write(folder / (reference.scene + ".svg"), diagramOf(result, reference.scene));
}

}  // namespace insonify::study
