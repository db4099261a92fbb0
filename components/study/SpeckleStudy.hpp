#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "components/study/SpeckleStatistics.hpp"
#include "components/study/error/ErrorAnalysis.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::study {

/** Speckle of an eighth of a ping's range. */
struct SpeckleSlice {
    size_t slice = 0;
    SpeckleFigures figures;
    std::optional<Likewise> next;  ///< Compared with the next ping; none after the last.
};

/** A ping under study. Slices with too few bins are omitted. */
struct SpeckleRow {
    std::string name;
    size_t loudest = 0;  ///< The slice with the max mean.
    std::vector<SpeckleSlice> slices;

    const SpeckleSlice* loudestSlice() const;  ///< Returns null if it has too few bins.
};

/** Analyses a ping and the next ping, which may be null, by the same code for recorded and simulated pings. */
SpeckleRow speckleRow(const CodedPing& ping, const CodedPing* next);
SpeckleRow speckleRow(const std::string& name, const types::Sonar& ping, const types::Sonar& next);

/** Returns the rows of a sonar's pings of one snapshot and of the same 0.1 s later (`sonar`), and of speckle drawn for
 *  each of their bins (`law_rayleigh`). */
std::vector<SpeckleRow> simulatedRows(const sonar::SonarConfig& config, const types::Snapshot& snapshot);

/** Return the promises about speckle that is drawn by law, and the same statistics of recordings. The latter never
 *  fail, because they do not depend on the simulator. */
std::vector<Claim> lawClaims();
std::vector<Claim> recordedClaims(const std::vector<SpeckleRow>& recorded);

/** Returns the promises about a sonar with `speckle: {coherent: true}` over a level bottom. Its speckle is fixed to the
 *  scene. It is Rayleigh-distributed for many scatterers and K-distributed for few, with a shape proportional to the
 *  range. Neighbouring bins and beams correlate according to pulse and pattern. It decorrelates as the sonar moves
 *  aside by parts of its aperture. Takes some seconds, and rays. */
std::vector<Claim> coherentClaims();

/** The name and the value of a statistic of a slice. */
struct SpeckleFigure {
    const char* name;
    double value;
};
std::vector<SpeckleFigure> computeFigures(const SpeckleSlice& slice);

std::string csv(const std::vector<SpeckleRow>& rows);      ///< Returns a line for each row and slice.
std::string lagsCsv(const std::vector<SpeckleRow>& rows);  ///< Returns both correlation curves of the loudest slices.

/** Writes speckle.csv, lags.csv and speckle.svg. Throws std::runtime_error if a file cannot be written. */
void writeReport(const std::vector<SpeckleRow>& rows, const std::filesystem::path& folder);

}  // namespace insonify::study
