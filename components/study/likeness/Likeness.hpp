#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "components/study/CodedPing.hpp"
#include "components/study/error/ErrorAnalysis.hpp"
#include "types/samples/Image.hpp"

namespace insonify::study {

constexpr size_t code_classes = 256;  ///< Classes of a histogram: codes of 8 bits.
constexpr size_t range_slices = 32;   ///< Slices of equal width from the sonar to the end of the range.
constexpr std::array<double, 7> shown_percentiles{1, 5, 25, 50, 75, 95, 99};

/** Statistics of a ping's appearance that do not depend on the scene. */
struct Looks {
    std::array<double, code_classes> histogram{};                ///< Fraction of the bins with each code [1].
    std::array<double, shown_percentiles.size()> percentiles{};  ///< Percentiles of the codes; 255 is the max code.
    double zeros = 0;                                            ///< Fraction of bins with code 0 [1].
    double saturated = 0;                          ///< Fraction of bins with the max code, or the code below it [1].
    double dynamic_range_db = 0;                   ///< Level of the 99.5th percentile minus that of the 5th [dB].
    std::array<double, range_slices> mean_code{};  ///< Mean code of each slice of range; 255 is the max code.
    std::array<double, range_slices> level_db{};   ///< Mean intensity of each slice relative to the max code [dB].
    int patches = 0;      ///< Number of homogeneous patches: 16 x 16 bins whose quarters agree within a quarter.
    double contrast = 0;  ///< Median deviation over mean of the amplitude in the patches; Rayleigh: 0.523.
    double range_correlation = 0;  ///< Mean correlation of amplitudes of neighbouring bins in the patches [1].
    double beam_correlation = 0;   ///< Mean correlation of amplitudes of neighbouring beams in the patches [1].
    double arc_db = 0;         ///< Level next to the strongest targets at their range, relative to the targets [dB].
    double arc_excess_db = 0;  ///< That level minus the level of the same beams nearer and farther away [dB].
};

/** Returns the statistics of a ping of at least 32 beams and 64 bins. Without a homogeneous patch, or if nothing varies
 *  in the patches, their statistics are NaN. */
Looks computeLooks(const CodedPing& ping);
/** Returns the mean of each statistic. */
Looks computeMean(const std::vector<Looks>& all);

/** Returns the mean distance by which codes must be moved to turn one histogram into the other (earth mover's distance;
 *  Rubner, Tomasi and Guibas, 2000): the area between the cumulated histograms [codes of 255]. */
double earthMoversDistance(const std::array<double, code_classes>& a, const std::array<double, code_classes>& b);
/** Returns the Jensen-Shannon divergence (Lin, 1991): 0 for equal histograms, 1 for histograms without a common code
 *  [bit]. */
double jensenShannonDivergence(const std::array<double, code_classes>& a, const std::array<double, code_classes>& b);

/** The difference of two looks: distances of histograms, and differences of statistics, all at least 0. */
struct Apart {
    double emd_codes, js_bits, dynamic_range_db, zeros, saturated;
    double fall_off_db;  ///< rms difference of the levels over range, each about its mean [dB].
    double contrast, range_correlation, beam_correlation, arc_db;
};
Apart apart(const Looks& a, const Looks& b);

/** Returns wrong pictures for comparison: one of a single code, and one of the cosine of incidence on a flat bottom
 *  without speckle, of the shape of `like`. */
CodedPing uniformPing(const CodedPing& like, double code);
CodedPing cosinePing(const CodedPing& like);

/** Returns the claims for a ping that differs from recordings by `apart`. The claim about arcs is open unless the
 *  recordings show arcs 3 dB above their surroundings. */
std::vector<Claim> claims(const Apart& apart, const Looks& recorded);

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
 *  @throws types::ConfigError if a ping has too few beams or bins */
LikenessResult studyLikeness(const std::vector<CodedPing>& recorded, const CodedPing* simulated);

/** The name and the value of a statistic in a row of likeness.csv. */
struct LikenessFigure {
    const char* name;
    double value;
};
std::vector<LikenessFigure> computeFigures(const LikenessRow& row);

/** Return a line for each row, with its statistics and distances; histograms by code, codes and levels by slice. */
std::string csv(const LikenessResult& result);
std::string profilesCsv(const LikenessResult& result);

/** Draws pings as fans side by side, grey, codes unchanged. */
types::Image drawFans(const std::vector<CodedPing>& pings);

/** Writes likeness.csv, profiles.csv and fans.png. Throws std::runtime_error if a file cannot be written. */
void writeReport(const LikenessResult& result, const std::filesystem::path& folder);

}  // namespace insonify::study
