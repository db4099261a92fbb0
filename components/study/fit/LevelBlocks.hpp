#pragma once
#include <cmath>
#include <vector>

#include "components/study/CodedPing.hpp"

namespace insonify::study {

constexpr double silent_db = -400;  ///< Level of zero intensity [dB].

inline double toDb(double power) { return power > 1e-40 ? 10 * std::log10(power) : silent_db; }
inline double toPower(double db) { return std::pow(10, db / 10); }

/** Computes the mean intensity that codes state, over the exponential law of speckle: codes are clipped at both ends
 *  and rounded. */
class CodeResponse {
public:
    /** @param law converts intensities, relative to that of the max code, to codes and back to levels */
    explicit CodeResponse(const CodedPing& law);

    /** Returns the mean intensity that codes state for a mean intensity of `level_db`, both relative to that of the max
     *  code [dB]. */
    double operator()(double level_db) const;

private:
    std::vector<double> stated_db_;  ///< In steps of a quarter of a decibel.
};

/** Mean levels of blocks of a ping: groups of beams, slices of range. */
struct LevelBlocks {
    size_t beam_blocks = 0, slices = 0;
    std::vector<double> ranges = {};  ///< Middle of each slice [m].
    std::vector<double> level = {};   ///< By beam block, then slice: 10 log10 of the mean intensity [dB].

    double at(size_t block, size_t slice) const { return level[block * slices + slice]; }
};

/** Returns the mean levels that a ping's codes state, relative to the max code; for intensities, relative to the
 *  source. A block without intensity has the level -400 dB. */
LevelBlocks makeBlocks(const CodedPing& ping);
LevelBlocks makeBlocks(const types::Sonar& intensities);
/** Returns the mean of several pings, as intensities. */
LevelBlocks computeMean(const std::vector<LevelBlocks>& all);
/** Returns the min of several pings. */
LevelBlocks findMinimum(const std::vector<LevelBlocks>& all);

}  // namespace insonify::study
