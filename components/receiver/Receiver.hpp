#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "types/samples/Sonar.hpp"
#include "types/text/Describe.hpp"
#include "types/text/Notice.hpp"

namespace insonify::receiver {

/** The unit and scale of the bins that the receiver outputs. */
enum class Output { Intensity, Amplitude, LevelDb, ReceivedLevelDb, Code };
enum class CodeLaw { Linear, Sqrt, Log };
/** The acoustic model of the sonar, which determines the scale of its bins. */
enum class Model { Physical, Cerqueira2017 };

/** Time-varied gain: log_coefficient log10(r) + 2 db_per_m r [dB], at most max_db; r in metres. */
struct TvgConfig {
    double log_coefficient = 0;
    double db_per_m = 0;
    double max_db = 100;

    static void describe(auto& self, auto& visit) {
        visit({"log_coefficient", "dB", "gain per decade of range", 0, 1000}, self.log_coefficient);
        visit({"db_per_m", "dB/m", "one-way absorption to compensate, twice per metre of range", 0, 1000},
              self.db_per_m);
        visit({"max_db", "dB", "max gain", -1000, 1000}, self.max_db);
    }
};

struct BlankingConfig {
    double range_min = 0;

    static void describe(auto& self, auto& visit) {
        visit({"range_min", "m", "bins that begin nearer are silent", 0, 1e5}, self.range_min);
    }
};

/** Whole numbers from 0 to 2^bits - 1, as an instrument sends them. */
struct CodeConfig {
    int bits = 8;
    CodeLaw law = CodeLaw::Log;
    double full_scale_db = 0;
    double dynamic_range_db = 60;
    double gamma = 1;

    static void describe(auto& self, auto& visit) {
        visit({"bits", "1", "of a code: the max code is 2^bits - 1", 8, 16}, self.bits);
        visit({"law", "", "the code is proportional to intensity, to its root, or to its level"}, self.law);
        visit({"full_scale_db", "dB", "level of the max code, all gain included", -1000, 1000}, self.full_scale_db);
        visit({"dynamic_range_db", "dB", "law log: level of code 0 below full_scale_db", 0.1, 3000},
              self.dynamic_range_db);
        visit({"gamma", "1",
               "law linear or sqrt: the code is proportional to the law's value to this power; below 1 it brightens "
               "weak echoes",
               0.05, 5},
              self.gamma);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** The brightness of the simulator of Rock: scales bins to 0 to 1 for a display, at any range. `cerqueira2017`: the bin
 *  times 2 gain. `physical`: E/S0 times 2 gain r^3 / (mu w dR), where mu is that of medium sand, w the width of a beam
 *  [rad] and dR that of a bin [m]. With gain 0.5, a cell of medium sand at normal incidence is 1. */
struct BrightnessConfig {
    double gain = 0.5;
    Model model = Model::Physical;

    static void describe(auto& self, auto& visit) {
        visit({"gain", "1", "a bin is twice this times its value relative to medium sand face on, at most 1", 0, 1},
              self.gain);
        visit({"model", "", "`model` of the connected sonar"}, self.model);
    }
};

/** Gain that follows the level along a ping. */
struct AutomaticGainConfig {
    double target_db = -20;
    double attack_ms = 0.5, release_ms = 5;
    double max_db = 40;

    static void describe(auto& self, auto& visit) {
        visit({"target_db", "dB", "target of the mean level over the beams, all gain included", -1000, 1000},
              self.target_db);
        visit({"attack_ms", "ms", "time to follow a rising level, to 1 - 1/e", 0, 1e6}, self.attack_ms);
        visit({"release_ms", "ms", "the same for a falling level", 0, 1e6}, self.release_ms);
        visit({"max_db", "dB", "max magnitude of this gain, up or down", 0, 1000}, self.max_db);
    }
};

/** The configuration of a receiver. An absent block is not applied. */
struct ReceiverConfig {
    std::optional<TvgConfig> tvg;
    double gain_db = 0;
    std::optional<BlankingConfig> blanking;
    Output output = Output::Intensity;
    double source_level_db = 0;
    std::optional<CodeConfig> code;
    std::optional<BrightnessConfig> brightness;
    std::optional<AutomaticGainConfig> automatic_gain;
    std::optional<double> saturation_db;

    static void describe(auto& self, auto& visit) {
        visit({"tvg", "", "time-varied gain: log_coefficient log10(r) + 2 db_per_m r; absent: none"}, self.tvg);
        visit({"gain_db", "dB", "gain at every range", -1000, 1000}, self.gain_db);
        visit({"blanking", "", "silences near bins, whose shadows remain; absent: none"}, self.blanking);
        visit({"output", "",
               "intensity; amplitude, its root; level_db, 10 log10 of it; received_level_db, the same plus "
               "source_level_db; code, whole numbers by `code`"},
              self.output);
        visit({"source_level_db", "dB re 1 uPa m", "used by output received_level_db", -300, 300},
              self.source_level_db);
        visit({"code", "", "used by output code"}, self.code);
        visit({"automatic_gain", "", "gain that follows the level along each ping; absent: none"}, self.automatic_gain);
        visit({"saturation_db", "dB", "max level of a bin, all gain included; absent: none", -1000, 1000},
              self.saturation_db);
        visit({"brightness", "", "instead of tvg: scales bins for a display; absent: none"}, self.brightness);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Computes the gain along a ping that brings its level to a target (ACOUSTICS.md 7.5). The gain starts anew with each
 *  ping, so a replayed ping gets the same gain.
 *
 *  @param means mean intensity of each bin over the beams, other gain included [1]
 *  @param first bins before this, and bins of NaN, are skipped
 *  @param target level of the means with the gain [dB]
 *  @param bin_ms time in which the echoes of a bin are received: two-way [ms]
 *  @param gains_db output, gain of each bin [dB] */
void followLevel(const AutomaticGainConfig& config, std::span<const double> means, size_t first, double target,
                 double bin_ms, std::span<double> gains_db);

/** Returns the gain at slant range r [m] before the clamp [dB]. */
double unclampedTvgDb(const TvgConfig& tvg, double r);
/** Returns the gain at slant range r [m], at most max_db [dB]. */
double tvgDb(const TvgConfig& tvg, double r);
/** Returns the slant range at which the gain reaches max_db; none when that is beyond `range_max` [m]. */
std::optional<double> clampRange(const TvgConfig& tvg, double range_max);

/** Turns the intensities that reach a receiver into its output: time-varied gain, gain, blanking, and an output law.
 *
 *  The gain of a bin is that of the bin's middle, on the range axis of the ping. Intensities and amplitudes are clamped
 *  at the max float, levels at -3000 dB below, codes at both ends. A bin without an echo is 0, or -3000 dB. NaN stays
 *  NaN, except in codes, where it becomes 0.
 *
 *      Receiver receiver(config);
 *      receiver.receive(intensities, ping); */
class Receiver {
public:
    explicit Receiver(const ReceiverConfig& config);

    /** Copies `intensities` to `received` with the bins as the receiver outputs them. Allocates nothing when both had
     *  these shapes before. */
    void receive(const types::Sonar& intensities, types::Sonar& received);
    /** Returns why it cannot receive a ping; null when it can. A brightness of the physical model needs beams of known
     *  width. */
    const char* findDiagnostic(const types::Sonar& intensities) const;
    /** The reasons why a received ping shows nothing. */
    struct Flaws {
        bool blanked = false;   ///< Every bin is blanked.
        double saturated = 0;   ///< Share of the bins after blanking that have the max code [1].
        bool all_zero = false;  ///< Every code is 0, although some bin after blanking has an intensity.
        bool any() const { return blanked || all_zero || saturated > max_saturated; }
    };
    static constexpr double max_saturated = 0.1;  ///< Share of saturated bins above which a warning is due [1].
    /** Returns the flaws of the ping that was received last. */
    Flaws getFlaws(const types::Sonar& intensities, const types::Sonar& received) const;
    /** Returns the most important flaw as a message, with numbers and a remedy. */
    std::string text(const Flaws& flaws, const types::Sonar& intensities) const;
    /** Returns whether the receiver leaves every ping unchanged. */
    bool isNeutral() const;
    /** Returns notices for the user: the range of the gain's clamp, and configuration without effect. */
    types::Notices notices() const;

private:
    /** The properties of a ping that the tables depend on. */
    struct Axis {
        uint32_t bin_count = 0;
        double bin_width = 0;   ///< [m]
        double bin_s = 0;       ///< One-way travel time through a bin.
        double beam_width = 0;  ///< [rad]
        bool operator==(const Axis&) const = default;
    };
    void makeTables(const types::Sonar& ping);
    /** Adds the automatic gain of a ping to the tables. */
    void followLevel(const types::Sonar& ping);
    /** Returns the offset of the output's own scale, which the tables add to a level with all gain included [dB]. */
    double scaleDb() const;
    double saturation() const;  ///< Max intensity on the scale of the tables [1].
    double gainDb(const types::Sonar& ping, double r) const;
    bool isLevel() const;
    void receiveBeam(const float* intensities, float* received) const;
    void encode(float* received) const;
    float maxCode() const { return static_cast<float>((1 << code_.bits) - 1); }
    /** Returns the level of the loudest bin after blanking, all gain included, relative to full_scale_db [dB]. */
    double loudestDb(const types::Sonar& intensities) const;
    /** Returns the level relative to full_scale_db above which codes are not 0 [dB]. */
    double lowestDb() const;

    ReceiverConfig config_;
    CodeConfig code_;
    Axis axis_;
    size_t silent_ = 0;                                    ///< Number of blanked bins at the start of each beam.
    double range_max_ = 0;                                 ///< Range of the last ping [m].
    std::vector<double> factor_;                           ///< Gain of each bin as a factor [1].
    std::vector<float> offset_db_;                         ///< Gain of each bin as a level [dB].
    std::vector<double> fixed_db_, means_, automatic_db_;  ///< With automatic gain: gain and mean of each bin.
};

}  // namespace insonify::receiver

template <>
struct insonify::types::EnumNames<insonify::receiver::Output> {
    static constexpr std::string_view names[] = {"intensity", "amplitude", "level_db", "received_level_db", "code"};
};
template <>
struct insonify::types::EnumNames<insonify::receiver::CodeLaw> {
    static constexpr std::string_view names[] = {"linear", "sqrt", "log"};
};
template <>
struct insonify::types::EnumNames<insonify::receiver::Model> {
    static constexpr std::string_view names[] = {"physical", "cerqueira2017"};
};
