#pragma once
#include <cmath>
#include <vector>

#include "components/study/CodedPing.hpp"

namespace insonify::study {

constexpr double silent_db = -400;  ///< Level where there is no intensity [dB].

inline double toDb(double power) { return power > 1e-40 ? 10 * std::log10(power) : silent_db; }
inline double toPower(double db) { return std::pow(10, db / 10); }

/** What a code says in the mean of an intensity, over the exponential law of speckle: codes are cut off at both ends
 *  and rounded. */
class CodeResponse {
public:
    /** @param law with which intensities, relative to that of the largest code, become codes and levels again */
    explicit CodeResponse(const CodedPing& law);

    /** Mean of the intensity that codes state, for a mean intensity of `level_db`, both relative to the largest code's
     *  [dB]. */
    double operator()(double level_db) const;

private:
    std::vector<double> stated_db_;  ///< By steps of a quarter of a decibel.
};

/** Mean levels of blocks of a ping, by beams and by range. */
struct LevelBlocks {
    size_t beam_blocks = 0, slices = 0;
    std::vector<double> ranges = {};  ///< Middle of each slice [m].
    std::vector<double> level = {};   ///< By beam block, then slice: 10 log10 of the mean intensity [dB].

    double at(size_t block, size_t slice) const { return level[block * slices + slice]; }
};

/** Mean levels of what the codes of a ping state, relative to the largest code, and of intensities relative to the
 *  source. A block without intensity has the level -400 dB. */
LevelBlocks blocksOf(const CodedPing& ping);
LevelBlocks blocksOf(const types::Sonar& intensities);
/** The mean of several pings, as intensities. */
LevelBlocks meanOf(const std::vector<LevelBlocks>& all);
/** The least of several pings. */
LevelBlocks leastOf(const std::vector<LevelBlocks>& all);

}  // namespace insonify::study
