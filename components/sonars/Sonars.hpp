#pragma once
#include <optional>
#include <string>
#include <vector>

#include "types/text/Describe.hpp"

namespace insonify::sonars {

/** One of the frequencies or modes of a sonar, by its maker. A figure that is not given is 0. */
struct SonarMode {
    double frequency_khz = 0;
    double range_min = 0, range_max = 0;  ///< [m]
    double field_of_view_deg = 0;         ///< Of a fan or a grid of beams, between its edges.
    double rows_field_of_view_deg = 0;    ///< Of a grid, in elevation.
    double beam_width_deg = 0, beam_height_deg = 0;
    int beam_count = 0, row_count = 0;
    double range_resolution = 0;  ///< [m]
    double step_deg = 0;
    double rate_hz = 0;

    static void describe(auto& self, auto& visit) {
        visit({"frequency_khz", "kHz", "of the sound", 1, 10000}, self.frequency_khz);
        visit({"range_min", "m", "nearest range", 0, 1000}, self.range_min);
        visit({"range_max", "m", "farthest range", 0.1, 10000}, self.range_max);
        visit({"field_of_view_deg", "deg", "between the edges of a fan or a grid of beams", 0, 360},
              self.field_of_view_deg);
        visit({"rows_field_of_view_deg", "deg", "of a grid, in elevation", 0, 180}, self.rows_field_of_view_deg);
        visit({"beam_width_deg", "deg", "of each beam, half power, one way", 0, 360}, self.beam_width_deg);
        visit({"beam_height_deg", "deg", "the same in elevation", 0, 180}, self.beam_height_deg);
        visit({"beam_count", "1", "beams of a fan, or in a row of a grid", 0, 65535}, self.beam_count);
        visit({"row_count", "1", "rows of a grid", 0, 65535}, self.row_count);
        visit({"range_resolution", "m", "of its pulse", 0, 10}, self.range_resolution);
        visit({"step_deg", "deg", "of a scanning head", 0, 360}, self.step_deg);
        visit({"rate_hz", "Hz", "of its pings", 0, 1000}, self.rate_hz);
    }
};

/** A sonar as a device: what its beams, receiver and head do beside its data sheet. A figure that is not given is 0. */
struct SonarDevice {
    std::string kind;     ///< "lens": beams by an acoustic lens; "array": by its elements; "head": one beam that turns.
    double pulse_us = 0;  ///< Of a tone at the starter's range; 0: its resolution.
    double sidelobe_db = 0;                              ///< Highest of a beam, two-way about its own axis.
    double gain_error_db = 0, phase_error_deg = 0;       ///< Deviations of elements.
    double beam_gain_error_db = 0, step_error_deg = 0;   ///< Deviations of beams, of the head's steps.
    double scatterers = 0;                               ///< In a resolution cell, of fields; 0: energies.
    double looks = 0;                                    ///< Averaged in a bin.
    double correlation_beams = 0, correlation_bins = 0;  ///< Lags of 1/e of its noise.
    double noise_db = 0;                                 ///< Median of its noise, relative to white.
    double directivity_index_db = 0;                     ///< Of its noise.
    double tvg = 0;                                      ///< Gain per decade of range [dB].
    int code_bits = 0;                                   ///< 0: its samples are not codes.
    double gamma = 0, dynamic_range_db = 0;              ///< Codes of amplitude to that power, or of level.
    double headroom_db = 0;                              ///< Of white above a white body.
    bool smooth = false;                                 ///< Its display interpolates between bins.

    static void describe(auto& self, auto& visit) {
        visit({"kind", "", "lens, array or head"}, self.kind);
        visit({"pulse_us", "us", "duration of its tone at the range of `insonify init`", 0, 1e6}, self.pulse_us);
        visit({"sidelobe_db", "dB", "highest sidelobe of a beam", -100, 0}, self.sidelobe_db);
        visit({"gain_error_db", "dB", "standard deviation of the elements' gains", 0, 20}, self.gain_error_db);
        visit({"phase_error_deg", "deg", "standard deviation of the elements' phases", 0, 180}, self.phase_error_deg);
        visit({"beam_gain_error_db", "dB", "standard deviation of the beams' gains", 0, 20}, self.beam_gain_error_db);
        visit({"step_error_deg", "deg", "standard deviation of the head's bearing", 0, 90}, self.step_error_deg);
        visit({"scatterers", "1", "of fields in a resolution cell; 0: energies are summed", 0, 200}, self.scatterers);
        visit({"looks", "1", "intensities that are averaged in a bin", 0, 256}, self.looks);
        visit({"correlation_beams", "1", "beams over which its noise is correlated", 0, 16}, self.correlation_beams);
        visit({"correlation_bins", "1", "bins over which its noise is correlated", 0, 16}, self.correlation_bins);
        visit({"noise_db", "dB", "median of its noise at a third of the range of `insonify init`, relative to white",
               -200, 0},
              self.noise_db);
        visit({"directivity_index_db", "dB", "of its receiver", 0, 100}, self.directivity_index_db);
        visit({"tvg", "dB", "gain per decade of range", 0, 100}, self.tvg);
        visit({"code_bits", "1", "bits of a code; 0: its samples are no codes", 0, 16}, self.code_bits);
        visit({"gamma", "1", "codes are amplitudes to this power", 0, 5}, self.gamma);
        visit({"dynamic_range_db", "dB", "codes are levels over this range", 0, 300}, self.dynamic_range_db);
        visit({"headroom_db", "dB", "of white above a white body there", -100, 100}, self.headroom_db);
        visit({"smooth", "", "its display interpolates between bins"}, self.smooth);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Where figures of a sonar come from. */
struct SonarSource {
    std::string document;            ///< "none: ..." where there is none.
    std::string read;                ///< Day on which it was read: "2026-11-22".
    std::vector<std::string> gives;  ///< Keys of SonarMode and SonarDevice, or "part".

    static void describe(auto& self, auto& visit) {
        visit({"document", "", "maker and title"}, self.document);
        visit({"read", "", "day on which it was read, YYYY-MM-DD"}, self.read);
        visit({"gives", "", "keys of figures"}, self.gives);
    }
};

/** What `insonify init` writes for a sonar in addition to its first mode. */
struct SonarStarter {
    std::string note, summary;      ///< Sources of the values as a comment; "130 x 20 degrees, 512 beams at 750 kHz".
    int bin_count = 0, bin_us = 0;  ///< Whole microseconds, one way.
    double period = 0;              ///< Between pings [s].
    int columns_per_beam = 0;
    double pitch_deg = 0;      ///< Of the mount of a fan, down.
    int picture_height = 0;    ///< Of the pictures of its sweep [px].
    bool sends_tones = false;  ///< Else chirps.

    static void describe(auto& self, auto& visit) {
        visit({"note", "", "sources of the values, for a comment"}, self.note);
        visit({"summary", "", "beams and frequency in words"}, self.summary);
        visit({"bin_count", "1", "bins of a beam", 1, 65535}, self.bin_count);
        visit({"bin_us", "us", "duration of a bin, one way", 1, 10000}, self.bin_us);
        visit({"period", "s", "time between pings", 1e-3, 100}, self.period);
        visit({"columns_per_beam", "1", "samples across a beam", 1, 4096}, self.columns_per_beam);
        visit({"pitch_deg", "deg", "of the mount, down", -90, 90}, self.pitch_deg);
        visit({"picture_height", "1", "height of the pictures of its data sets", 16, 8192}, self.picture_height);
        visit({"sends_tones", "", "else chirps"}, self.sends_tones);
    }
};

/** A sonar by its maker's documents. */
struct SonarFigures {
    std::string name;  ///< "oculus_m750d"
    std::string title;
    int part = 0;  ///< Part number in the device's messages; 0: it has none.
    std::vector<SonarMode> modes;
    std::vector<SonarSource> sources;
    std::optional<SonarDevice> device;  ///< Given if there is a starter.
    std::optional<SonarStarter> starter;

    static void describe(auto& self, auto& visit) {
        visit({"title", "", "maker and model"}, self.title);
        visit({"part", "1", "part number in messages of the device", 0, 65535}, self.part);
        visit({"modes", "", "frequencies or modes, first the one of `insonify init`"}, self.modes);
        visit({"sources", "", "documents of the figures"}, self.sources);
        visit({"device", "", "what the device does beside its data sheet"}, self.device);
        visit({"starter", "", "what `insonify init` writes in addition"}, self.starter);
    }
    void check(types::Diagnostics& diagnostics) const;

    bool isGrid() const { return modes.front().row_count > 1; }
    bool isFan() const { return modes.front().beam_count > 1 && !isGrid(); }
};

/** Reads figures, a map of names. Throws types::ConfigError with the places of unknown keys, values out of bounds, and
 *  figures that no source gives, or more than one. */
std::vector<SonarFigures> readSonars(const std::string& yaml, const std::string& file);

/** Returns all sonars of sonars.yml, which is embedded in the program, in its order. */
const std::vector<SonarFigures>& sonars();
/** Throws std::out_of_range when there is no sonar of that name. */
const SonarFigures& sonar(const std::string& name);

}  // namespace insonify::sonars
