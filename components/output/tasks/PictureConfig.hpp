#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "types/text/Describe.hpp"

namespace insonify::output {

/** Colours from the weakest to the strongest echo. */
enum class ColourMap { Amber, Copper, Turbo, Viridis, Inferno, Gray };

/** The content of bins: linear intensities, levels in dB, or codes. */
enum class BinScale { Linear, Decibel, Code };

/** The appearance of a picture. */
struct DisplayConfig {
    uint32_t width = 1024;
    double dynamic_range_db = 40;
    std::optional<double> reference_db;
    ColourMap colour_map = ColourMap::Amber;
    BinScale scale = BinScale::Linear;
    int code_bits = 8;

    double maxCode() const { return std::exp2(code_bits) - 1; }

    static void describe(auto& self, auto& visit) {
        visit({"width", "1", "width of the picture in pixels; an odd width is rounded up to even; the height follows",
               256, 8192},
              self.width);
        visit({"dynamic_range_db", "dB", "between the darkest and the brightest colour", 1, 300},
              self.dynamic_range_db);
        visit({"reference_db", "dB", "level of the brightest colour, 10 log10 of a bin; absent: follows the echoes",
               -3000, 3000},
              self.reference_db);
        visit({"colour_map", "", "colours from weak to strong"}, self.colour_map);
        visit({"scale", "",
               "content of the bins: linear intensities, decibel, or code, shown unchanged from 0 to the max code"},
              self.scale);
        visit({"code_bits", "1", "bits of a code, if scale is code", 1, 32}, self.code_bits);
    }
    /** Reports a reference level of codes, which have none. */
    void check(types::Diagnostics& diagnostics) const;
};

/** The files to write; names are relative to the output folder. */
struct RecordingConfig {
    std::optional<std::string> file;
    std::optional<std::string> video;
    std::optional<double> video_rate;

    static void describe(auto& self, auto& visit) {
        visit({"file", "", "PNG files, numbered from 0: fan_%06d.png; absent: none"}, self.file);
        visit({"video", "", "video file, .avi (MJPG) or .mp4 (mp4v); absent: none"}, self.video);
        visit({"video_rate", "Hz", "pictures a second in the video; absent: that of the pings", 0.01, 1000},
              self.video_rate);
    }
    /** Reports an invalid pattern in `file` and an unknown kind of `video`. */
    void check(types::Diagnostics& diagnostics) const;
};

/** The properties of every task that makes pictures of pings. */
struct PictureConfig : DisplayConfig, RecordingConfig {
    uint32_t every = 1;

    static void describe(auto& self, auto& visit) {
        RecordingConfig::describe(self, visit);
        visit({"every", "1",
               "pings from one picture to the next: a picture shows the first of them; a disc shows the last", 1, 1e6},
              self.every);
        DisplayConfig::describe(self, visit);
    }
    void check(types::Diagnostics& diagnostics) const {
        RecordingConfig::check(diagnostics);
        DisplayConfig::check(diagnostics);
    }
};

}  // namespace insonify::output

template <>
struct insonify::types::EnumNames<insonify::output::ColourMap> {
    static constexpr std::string_view names[] = {"amber", "copper", "turbo", "viridis", "inferno", "gray"};
};
template <>
struct insonify::types::EnumNames<insonify::output::BinScale> {
    static constexpr std::string_view names[] = {"linear", "decibel", "code"};
};
