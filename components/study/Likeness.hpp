#pragma once
#include <array>
#include <string>
#include <vector>

#include "components/study/CodedPing.hpp"
#include "components/study/ErrorAnalysis.hpp"

namespace insonify::study {

constexpr size_t code_classes = 256;  ///< Of a histogram: those of codes of 8 bits.
constexpr size_t range_slices = 32;   ///< Of equal width from the sonar to the end of the range.
constexpr std::array<double, 7> shown_percentiles{1, 5, 25, 50, 75, 95, 99};

/** What a ping looks like, in figures that do not ask what lay before the sonar. */
struct Looks {
    std::array<double, code_classes> histogram{};                ///< Share of the bins with each code [1].
    std::array<double, shown_percentiles.size()> percentiles{};  ///< Of the codes, 255 the largest.
    double zeros = 0;                                            ///< Share of bins of code 0 [1].
    double saturated = 0;                          ///< Share of bins of the largest code, or the one below it [1].
    double dynamic_range_db = 0;                   ///< Level of the 99.5th percentile above that of the 5th [dB].
    std::array<double, range_slices> mean_code{};  ///< Of each slice of range, 255 the largest.
    std::array<double, range_slices> level_db{};   ///< Of the mean intensity of each, below the largest code's [dB].
    int patches = 0;               ///< Homogeneous ones: of 16 x 16 bins, whose quarters are alike within a quarter.
    double contrast = 0;           ///< Of speckle: deviation over mean of amplitude in these, median; Rayleigh: 0.523.
    double range_correlation = 0;  ///< Of amplitudes of neighbouring bins in these, mean [1].
    double beam_correlation = 0;   ///< Of amplitudes of neighbouring beams in these, mean [1].
    double arc_db = 0;             ///< Level beside the strongest targets at their range, below theirs [dB].
    double arc_excess_db = 0;      ///< That level above the one of the same beams nearer and farther away [dB].
};

/** Figures of a ping of at least 32 beams and 64 bins. Where there is no homogeneous patch, or nothing varies in them,
 *  the figures of these are NaN. */
Looks looksOf(const CodedPing& ping);
/** The mean of each figure. */
Looks meanOf(const std::vector<Looks>& all);

/** Mean distance that codes have to be moved for one histogram to become the other (earth mover's distance; Rubner,
 *  Tomasi and Guibas, 2000): the area between the cumulated histograms [codes of 255]. */
double earthMoversDistance(const std::array<double, code_classes>& a, const std::array<double, code_classes>& b);
/** Jensen-Shannon divergence (Lin, 1991): 0 for the same, 1 for histograms that share no code [bit]. */
double jensenShannonDivergence(const std::array<double, code_classes>& a, const std::array<double, code_classes>& b);

/** How far two looks are apart: distances of histograms, and differences of figures, none below 0. */
struct Apart {
    double emd_codes, js_bits, dynamic_range_db, zeros, saturated;
    double fall_off_db;  ///< rms of the difference of level over range, each about its mean [dB].
    double contrast, range_correlation, beam_correlation, arc_db;
};
Apart apart(const Looks& a, const Looks& b);

/** Wrong forms: a picture of one code, and one of the cosine of incidence on a flat bottom without speckle, of the
 *  shape of `like`. */
CodedPing uniformPing(const CodedPing& like, double code);
CodedPing cosinePing(const CodedPing& like);

/** What is promised of a ping that is so far from recordings; of arcs only where the recordings show some, 3 dB above
 *  what is around them, else it is open. */
std::vector<Claim> claims(const Apart& apart, const Looks& recorded);

}  // namespace insonify::study
