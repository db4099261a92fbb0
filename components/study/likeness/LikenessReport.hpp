#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/study/likeness/Likeness.hpp"
#include "types/Image.hpp"

namespace insonify::study {

/** A picture under study: its statistics, and its differences from those of the recordings. */
struct LikenessRow {
    std::string name;
    Looks looks;
    Apart apart;
};

struct LikenessResult {
    Looks recorded;                 ///< Mean of the recorded pings.
    std::vector<LikenessRow> rows;  ///< Each recorded ping, the simulated ping if there is one, the wrong pictures.
    std::vector<CodedPing> shown;   ///< A recorded ping, and the simulated ping next to it.

    const LikenessRow* row(const std::string& name) const;  ///< Returns null if there is none.
};

/** Compares pings. @param simulated null: only the recordings and the wrong pictures
 *  @throws std::invalid_argument if a ping has too few beams or bins */
LikenessResult studyLikeness(const std::vector<CodedPing>& recorded, const CodedPing* simulated);

/** The name and the value of a statistic in a row of likeness.csv. */
struct LikenessFigure {
    const char* name;
    double value;
};
std::vector<LikenessFigure> figuresOf(const LikenessRow& row);

/** Return a line for each row, with its statistics and distances; histograms by code, codes and levels by slice. */
std::string csvOf(const LikenessResult& result);
std::string profilesCsvOf(const LikenessResult& result);

/** Draws pings as fans side by side, grey, codes unchanged. */
types::Image fansOf(const std::vector<CodedPing>& pings);

/** Writes likeness.csv, profiles.csv and fans.png. Throws std::runtime_error if a file cannot be written. */
void writeReport(const LikenessResult& result, const std::filesystem::path& folder);

}  // namespace insonify::study
