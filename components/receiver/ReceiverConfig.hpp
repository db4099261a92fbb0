#pragma once
#include <optional>
#include <string_view>

#include "types/Describe.hpp"

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
        visit({"source_level_db", "dB re 1 uPa m", "used by output received_level_db", -300, 400},
              self.source_level_db);
        visit({"code", "", "used by output code"}, self.code);
        visit({"automatic_gain", "", "gain that follows the level along each ping; absent: none"}, self.automatic_gain);
        visit({"saturation_db", "dB", "max level of a bin, all gain included; absent: none", -1000, 1000},
              self.saturation_db);
        visit({"brightness", "", "instead of tvg: scales bins for a display; absent: none"}, self.brightness);
    }
    void check(types::Diagnostics& diagnostics) const;
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
