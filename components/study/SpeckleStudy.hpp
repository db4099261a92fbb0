#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/plan/SonarConfig.hpp"
#include "components/study/ErrorAnalysis.hpp"
#include "components/study/SpeckleStatistics.hpp"
#include "types/Snapshot.hpp"

namespace insonify::study {

/** Speckle of an eighth of a ping's range. */
struct SpeckleSlice {
    size_t slice = 0;
    SpeckleFigures figures;
    std::optional<Likewise> next;  ///< With the ping after it; none after the last.
};

/** A ping under study. Slices of which too few bins tell are left out. */
struct SpeckleRow {
    std::string name;
    size_t loudest = 0;  ///< The slice with the highest mean.
    std::vector<SpeckleSlice> slices;

    const SpeckleSlice* loudestSlice() const;  ///< Null where too little of it tells.
};

/** Of a ping and the one after it, null where there is none: by the same code for recorded and simulated ones. */
SpeckleRow speckleRow(const CodedPing& ping, const CodedPing* next);
SpeckleRow speckleRow(const std::string& name, const types::Sonar& ping, const types::Sonar& next);

/** What a sonar gives out of one snapshot and of the same a tenth of a second later, `sonar`, and what speckle drawn
 *  for each bin makes of both, `law_rayleigh`. */
std::vector<SpeckleRow> simulatedRows(const sonar::SonarConfig& config, const types::Snapshot& snapshot);

/** What is promised of the speckle that is drawn by law, and what of recordings is so: these never fail, for they are
 *  no doing of the simulator. */
std::vector<Claim> lawClaims();
std::vector<Claim> recordedClaims(const std::vector<SpeckleRow>& recorded);

/** What is promised of a sonar with `speckle: {coherent: true}` over a level bottom: it stands still with the scene, is
 *  Rayleigh's for many scatterers and K's for few, of a shape that goes as the range, is shared by neighbouring bins
 *  and beams as pulse and pattern say, and is lost as the sonar moves aside by parts of its aperture. Takes some
 *  seconds, and rays. */
std::vector<Claim> coherentClaims();

/** Names of the figures of a slice, and their values. */
struct SpeckleFigure {
    const char* name;
    double value;
};
std::vector<SpeckleFigure> figuresOf(const SpeckleSlice& slice);

std::string csvOf(const std::vector<SpeckleRow>& rows);      ///< A line for each row and slice.
std::string lagsCsvOf(const std::vector<SpeckleRow>& rows);  ///< Both curves of correlation of the loudest slices.
std::string plotOf(const std::vector<SpeckleRow>& rows);     ///< SVG: frozen part over range, both curves.

/** Writes speckle.csv, lags.csv and speckle.svg. Throws std::runtime_error when one cannot be written. */
void writeReport(const std::vector<SpeckleRow>& rows, const std::filesystem::path& folder);

}  // namespace insonify::study
