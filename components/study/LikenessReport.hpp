#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/study/Likeness.hpp"
#include "types/Image.hpp"

namespace insonify::study {

/** A picture under study: its figures, and how far they are from those of the recordings. */
struct LikenessRow {
    std::string name;
    Looks looks;
    Apart apart;
};

struct LikenessResult {
    Looks recorded;                 ///< Mean of the recorded pings.
    std::vector<LikenessRow> rows;  ///< Each recorded ping, the simulated one if there is one, the wrong forms.
    std::vector<CodedPing> shown;   ///< A recorded ping, and the simulated one beside it.

    const LikenessRow* row(const std::string& name) const;  ///< Null when there is none.
};

/** Lays pings beside each other. @param simulated where it is null, of the recordings and the wrong forms alone
 *  @throws std::invalid_argument when a ping has too few beams or bins */
LikenessResult studyLikeness(const std::vector<CodedPing>& recorded, const CodedPing* simulated);

/** Names of the figures of a row of likeness.csv, and their values. */
struct LikenessFigure {
    const char* name;
    double value;
};
std::vector<LikenessFigure> figuresOf(const LikenessRow& row);

std::string csvOf(const LikenessResult& result);          ///< A line for each row, its figures and distances.
std::string profilesCsvOf(const LikenessResult& result);  ///< Histograms by code, codes and levels by slice of range.

/** Pings as fans beside each other, grey, codes as they are. */
types::Image fansOf(const std::vector<CodedPing>& pings);

/** Writes likeness.csv, profiles.csv and fans.png. Throws std::runtime_error when one cannot be written.
 */
void writeReport(const LikenessResult& result, const std::filesystem::path& folder);

}  // namespace insonify::study
