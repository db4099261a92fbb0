// Tables of the study of speckle.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "components/study/SpeckleStudy.hpp"

namespace insonify::study {
namespace {

using Out = std::back_insert_iterator<std::string>;
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

void writeReport(const std::vector<SpeckleRow>& rows, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    write(folder / "speckle.csv", csvOf(rows));
    write(folder / "lags.csv", lagsCsvOf(rows));
}

}  // namespace insonify::study
