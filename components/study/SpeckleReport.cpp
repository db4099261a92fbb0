// Tables and diagrams of the study of speckle.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "components/study/Plot.hpp"
#include "components/study/SpeckleStudy.hpp"

namespace insonify::study {
namespace {

using Out = std::back_insert_iterator<std::string>;
constexpr const char* colours[] = {"#555555", "#8a8a8a", "#b5b5b5", "#0b6e99", "#d1495b", "#edae49", "#66a182"};

/** Grey for recordings, colours for what is simulated. */
std::string colourOf(const SpeckleRow& row, size_t place) {
    const bool recorded = row.name.starts_with("recorded");
    return colours[recorded ? place % 3 : 3 + place % 4];
}

Line frozenOf(const SpeckleRow& row, size_t place) {
    Line line{row.name, colourOf(row, place), {}};
    for (const SpeckleSlice& slice : row.slices)
        if (slice.next && !std::isnan(slice.next->frozen()))
            line.points.push_back({(static_cast<double>(slice.slice) + 0.5) / speckle_slices, slice.next->frozen()});
    return line;
}

Line curveOf(const SpeckleRow& row, size_t place, LagCurve SpeckleFigures::*curve) {
    Line line{row.name, colourOf(row, place), {}};
    const SpeckleSlice* loud = row.loudestSlice();
    for (size_t lag = 0; loud && lag < speckle_lags; ++lag)
        if (const double value = (loud->figures.*curve)[lag]; !std::isnan(value))
            line.points.push_back({static_cast<double>(lag), value});
    return line;
}

Diagram lagsOf(const char* title, const char* label) {
    return {title, label, "correlation of intensities", 0, speckle_lags - 1, 1, -0.2, 1, 0.2, {}};
}

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    if (!(file << text).flush()) throw std::runtime_error(path.string() + " cannot be written");
}

}  // namespace

std::vector<SpeckleFigure> figuresOf(const SpeckleSlice& slice) {
    const SpeckleFigures& figures = slice.figures;
    const Likewise next = slice.next.value_or(Likewise{NAN, NAN});
    return {{"bins", figures.bins},
            {"independent_bins", figures.independent},
            {"contrast", figures.contrast},
            {"scintillation_index", figures.scintillation.value},
            {"scintillation_error", figures.scintillation.error},
            {"inverse_k_shape", figures.texture.value},
            {"inverse_k_shape_error", figures.texture.error},
            {"rayleigh_distance", figures.rayleigh_distance},
            {"bin_correlation", figures.along[1]},
            {"beam_correlation", figures.across[1]},
            {"frozen", next.frozen()},
            {"noise_share", slice.next ? next.noiseShare() : NAN}};
}

std::string csvOf(const std::vector<SpeckleRow>& rows) {
    std::string text = "ping,slice,loudest";
    for (const SpeckleFigure& figure : figuresOf(SpeckleSlice{})) text += std::string(",") + figure.name;
    for (const SpeckleRow& row : rows)
        for (const SpeckleSlice& slice : row.slices) {
            fmt::format_to(Out(text), "\n{},{},{}", row.name, slice.slice, slice.slice == row.loudest ? 1 : 0);
            for (const SpeckleFigure& figure : figuresOf(slice)) fmt::format_to(Out(text), ",{:.6g}", figure.value);
        }
    return text + "\n";
}

std::string lagsCsvOf(const std::vector<SpeckleRow>& rows) {
    std::string text = "ping,lag,bin_correlation,beam_correlation\n";
    for (const SpeckleRow& row : rows)
        if (const SpeckleSlice* loud = row.loudestSlice())
            for (size_t lag = 0; lag < speckle_lags; ++lag)
                fmt::format_to(Out(text), "{},{},{:.6g},{:.6g}\n", row.name, lag, loud->figures.along[lag],
                               loud->figures.across[lag]);
    return text;
}

std::string plotOf(const std::vector<SpeckleRow>& rows) {
    Diagram frozen{"What two pings have in common",
                   "range over the farthest",
                   "correlation of amplitudes",
                   0,
                   1,
                   0.125,
                   -0.2,
                   1,
                   0.2,
                   {}};
    Diagram along = lagsOf("Speckle of bins one after the other, where a ping is loudest", "bins apart");
    Diagram across = lagsOf("Speckle of beams side by side, where a ping is loudest", "beams apart");
    for (size_t i = 0; i < rows.size(); ++i) {
        if (const Line line = frozenOf(rows[i], i); !line.points.empty()) frozen.lines.push_back(line);
        along.lines.push_back(curveOf(rows[i], i, &SpeckleFigures::along));
        across.lines.push_back(curveOf(rows[i], i, &SpeckleFigures::across));
    }
    return linePlot({frozen, along, across});
}

void writeReport(const std::vector<SpeckleRow>& rows, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    write(folder / "speckle.csv", csvOf(rows));
    write(folder / "lags.csv", lagsCsvOf(rows));
    write(folder / "speckle.svg", plotOf(rows));
}

}  // namespace insonify::study
