#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/acoustics/Absorption.hpp"
#include "components/acoustics/BeamPattern.hpp"
#include "components/acoustics/Pulse.hpp"
#include "components/acoustics/Water.hpp"
#include "components/sonar/plan/CrosstalkConfig.hpp"
#include "components/sonar/plan/ImperfectionsConfig.hpp"
#include "types/Describe.hpp"

namespace insonify::sonar {

enum class Model { Physical, Cerqueira2017 };
enum class BeamGeometry { Planar, Conical };
enum class RangeRounding { Sample, Exact };
enum class Deposit { Auto, Cpu, Gpu };
enum class Visibility { Auto, Gl, Cpu };
enum class BeamWidthConvention { PerBeam, TotalFov };

/** Absorption as one number, or by a law from a frequency and the water. */
struct AbsorptionConfig {
    std::optional<double> db_per_m;
    acoustics::AbsorptionLaw law = acoustics::AbsorptionLaw::FrancoisGarrison;
    std::optional<double> frequency_khz;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"db_per_m", "dB/m", "one-way absorption, instead of a law", 0, 1000}, self.db_per_m);
        visit(Field{"law", "", "computes it from frequency and water"}, self.law);
        visit(Field{"frequency_khz", "kHz", "frequency for the law; absent: the sonar's", 0, 1e5}, self.frequency_khz);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** What an array does across the fan and up and down; a law that is absent is 1 in all directions. */
struct ArrayConfig {
    std::optional<acoustics::BeamLaw> azimuth, elevation;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(types::Field{"azimuth", "", "of a sent pulse about the axis; of a beam about its own bearing"},
              self.azimuth);
        visit(types::Field{"elevation", "", "about the horizontal plane of the sonar"}, self.elevation);
    }
};

/** Directivity, two way: what is sent times what is heard (ACOUSTICS.md 5.9). */
struct BeamPatternConfig {
    ArrayConfig transmit, receive;
    double floor_db = -60;

    bool hasAzimuth() const { return transmit.azimuth || receive.azimuth; }
    bool hasElevation() const { return transmit.elevation || receive.elevation; }

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"transmit", "", "of what is sent"}, self.transmit);
        visit(Field{"receive", "", "of what is heard"}, self.receive);
        visit(Field{"floor_db", "dB", "two-way level down to which sidelobes are heard, beyond fan and aperture too",
                    -200, -3},
              self.floor_db);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Water that scatters sound back, between two depths or all of it. */
struct VolumeLayer {
    std::optional<double> top_m, bottom_m, strength_db;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"top_m", "m", "depth below the water surface, or the world's z = 0; absent: no bound", -1e5, 1e5},
              self.top_m);
        visit(Field{"bottom_m", "m", "depth to which it reaches; absent: no bound", -1e5, 1e5}, self.bottom_m);
        visit(Field{"strength_db", "dB re 1/m", "volume backscattering strength; -200: none", -200, 0},
              self.strength_db);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** The water surface as a mirror. */
struct SurfaceMirrorConfig {
    double wind_m_s = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(types::Field{"wind_m_s", "m/s", "wind that makes it rough; 0: as flat as a mirror", 0, 50},
              self.wind_m_s);
    }
};

/** Echoes that come by way of mirrors (ACOUSTICS.md 5.23). */
struct MultipathConfig {
    static constexpr int max_bounces = 2;

    std::optional<SurfaceMirrorConfig> surface;
    int bounces = 1;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"surface", "", "the scene's water_surface reflects; absent: it lets all sound through"},
              self.surface);
        visit(Field{"bounces", "1",
                    "reflections of one way, at most: 1 in the water surface and materials with `mirror: true`, 2 in "
                    "smooth materials as well; 0: none",
                    0, max_bounces},
              self.bounces);
    }
};

/** Echoes that interfere: each surface is a lattice of scatterers that belong to its object, and what a bin holds is
 *  the square of the sum of their fields (ACOUSTICS.md 5.21). */
struct SpeckleConfig {
    bool coherent = false;
    int scatterers_per_cell = 10;
    std::optional<double> scatterers_per_m2;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"coherent", "", "fields are summed, not energies; needs frequency_khz; false: energies are"},
              self.coherent);
        visit(Field{"scatterers_per_cell", "1",
                    "scatterers in a resolution cell, beam width by range resolution, at least", 1, 200},
              self.scatterers_per_cell);
        visit(Field{"scatterers_per_m2", "1/m2",
                    "scatterers of surfaces, of exponentially distributed strengths: intensities are K-distributed, "
                    "of the shape of their number in a cell (Abraham and Lyons 2002); absent: so many that none stands "
                    "out",
                    1e-6, 1e9},
              self.scatterers_per_m2);
    }
};

/** A straight array of equal elements, as long as the aperture of `beam_pattern.receive.azimuth`, whose signals are
 *  told. */
struct ElementsConfig {
    std::optional<int> count;
    std::optional<double> spacing_m;

    /** How many elements there are, and how far apart [m]. */
    struct Array {
        size_t count;
        double spacing;
    };
    /** As given, the rest from the length of the aperture [m]; half a wavelength apart where nothing is given. */
    Array arrayOf(double aperture_m, double wavelength) const;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"count", "1", "elements; absent: as many as the receiver's aperture has room for", 2, 4096},
              self.count);
        visit(Field{"spacing_m", "m", "of their middles; absent: the aperture over count, or half a wavelength", 1e-5,
                    10},
              self.spacing_m);
    }
};

/** Samples per beam: given, or found for an error or a time from the pings. Found for an error of 0.05 with at most
 *  400,000 samples a ping when nothing is given. */
struct QualityConfig {
    std::optional<int> rows, columns_per_beam;
    std::optional<double> target_error, budget_ms;
    std::optional<int> max_samples;

    bool isGiven() const { return rows || columns_per_beam; }

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"rows", "1", "rows of samples over beam_height_deg, else 256", 1, 16384}, self.rows);
        visit(Field{"columns_per_beam", "1", "columns of samples per beam, else 2", 1, 4096}, self.columns_per_beam);
        visit(Field{"target_error", "1", "instead: relative L2 error of energies times r^5; else 0.05", 1e-4, 1},
              self.target_error);
        visit(Field{"max_samples", "1",
                    "of a ping, for a target_error; absent: 400000, with a target_error as many as it takes", 1, 1e9},
              self.max_samples);
        visit(Field{"budget_ms", "ms", "instead: time of a ping, used and kept", 0.1, 1e5}, self.budget_ms);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** An imaging sonar. Beam k of a fan covers bearings [-fov/2 + k fov/N, -fov/2 + (k + 1) fov/N], positive to port;
 *  `bearings_deg` takes the place of `field_of_view_deg` and `beam_count`; `beam_width_deg` alone that of
 *  `field_of_view_deg`; with both, each beam is as wide as it says, and beams may overlap. */
struct SonarConfig {
    Model model = Model::Physical;
    double range = 50;
    double range_min = 0.1;
    int beam_count = 256;
    int bin_count = 500;
    std::optional<double> field_of_view_deg;
    std::vector<double> bearings_deg;
    std::optional<double> beam_width_deg;
    BeamWidthConvention beam_width_convention = BeamWidthConvention::PerBeam;
    double beam_height_deg = 20;
    BeamGeometry beam_geometry = BeamGeometry::Planar;
    std::optional<double> speed_of_sound;
    std::optional<acoustics::Water> water;
    std::optional<double> frequency_khz;
    std::optional<AbsorptionConfig> absorption;
    QualityConfig quality;
    RangeRounding range_rounding = RangeRounding::Sample;
    bool published = false;
    bool draw_all = false;
    Visibility visibility = Visibility::Auto;
    std::string device;
    Deposit deposit = Deposit::Auto;
    std::optional<BeamPatternConfig> beam_pattern;
    std::optional<acoustics::PulseConfig> pulse;
    std::vector<VolumeLayer> volume;
    bool motion_in_ping = false;
    bool across_track = false;  ///< The fan stands upright and looks down, as a side-scan's: no key of its own.
    std::optional<SpeckleConfig> speckle;
    std::optional<ElementsConfig> elements;
    std::optional<MultipathConfig> multipath;
    int32_t max_walls = 4;
    std::optional<ImperfectionsConfig> imperfections;
    std::optional<CrosstalkConfig> crosstalk;
    std::map<std::string, std::map<std::string, double>> effects;
    std::optional<types::MovedTo> tvg, gain, output, source_level_db;

    /** Whether there is more than one water that scatters, or one with bounds. */
    bool hasLayers() const { return volume.size() > 1 || (!volume.empty() && (volume[0].top_m || volume[0].bottom_m)); }
    /** Rows of samples and columns per beam, until others are chosen for an error or a time [1]. */
    int rows() const { return quality.rows.value_or(256); }
    int columnsPerBeam() const { return quality.columns_per_beam.value_or(2); }
    /** Error to choose the quality for, none when it is given or there is a budget. `published` has no use for one. */
    std::optional<double> targetError() const;
    /** Samples that a ping may have for its target, none when it may have as many as it takes [1]. */
    std::optional<double> mostSamples() const;
    /** Whether the quality is found from the pings, rather than given. */
    bool choosesQuality() const { return targetError() || quality.budget_ms; }
    /** Beams per ping: of the table, else beam_count [1]. */
    int beams() const { return bearings_deg.empty() ? beam_count : static_cast<int>(bearings_deg.size()); }
    /** Azimuth of a regular fan, from edge to edge: as given, else 120 [deg]. */
    double fieldOfViewDeg() const { return field_of_view_deg.value_or(120); }
    /** Centre of beam k [deg], 0 ahead, positive to port. */
    double bearingDeg(int k) const;
    /** Opening of one beam across the fan [deg]. */
    double beamWidthDeg() const { return bearings_deg.empty() ? fieldOfViewDeg() / beam_count : *beam_width_deg; }
    /** Azimuth from the outer edge of the first beam to that of the last [deg], at most 360. */
    double coverageDeg() const;
    /** The same with a fan that is given by `beam_width_deg` given by `field_of_view_deg`, or by `bearings_deg` where
     *  both are. */
    SonarConfig fan() const;
    /** Whether echoes may come by way of mirrors, which takes rays. */
    bool tracesPaths() const { return multipath && multipath->bounces > 0; }
    /** Whether fields are summed rather than energies. */
    bool isCoherent() const { return speckle && speckle->coherent; }
    /** The property that only rays can follow; empty where there is none. */
    std::string needsRays() const;
    /** Whether triangles are found by rays on the processor, else by drawing, as far as the configuration and the
     *  environment decide; none: it depends on whether there is a graphics card. */
    std::optional<bool> choosesRays() const;
    /** The same; looks for a graphics card where nothing else decides. */
    bool castsRays() const;
    /** Throws types::ConfigError where the configuration needs a graphics device that EGL does not list. */
    void requireDevice(const std::string& task) const;
    /** Frequency that a law of absorption is for: its own, or the sonar's [kHz]; none where absorption follows no law.
     */
    std::optional<double> absorbedKhz() const;
    /** Configured, or that of `water`, or 1500 [m/s]. */
    double speedOfSound() const;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"beam_count", "1", "beams per ping", 1, 4096}, self.beam_count);
        visit(Field{"field_of_view_deg", "deg",
                    "azimuth covered, edge to edge; absent: 120, or beam_count beams of beam_width_deg; with "
                    "beam_width_deg beams may be wider than their spacing",
                    0.01, 360},
              self.field_of_view_deg);
        visit(Field{"bearings_deg", "deg", "instead of a regular fan: centre of each beam", -180, 180},
              self.bearings_deg);
        visit(Field{"beam_width_convention", "", "beam_width_deg of a regular fan is one beam's, or the whole fan's"},
              self.beam_width_convention);
        describeBeam(self, visit);
    }
    /** The properties that a scanning sonar has as well. */
    template <class Self, class V>
    static void describeBeam(Self& self, V& visit);
    /** The keys that a receiver has now. */
    template <class Self, class V>
    static void describeMoved(Self& self, V& visit);
    void check(types::Diagnostics& diagnostics) const;
    /** The diagnostics of a fan that is given by `beam_width_deg`. */
    void checkFan(types::Diagnostics& diagnostics) const;
    /** The diagnostics that a scanning sonar can have as well. */
    void checkBeam(types::Diagnostics& diagnostics) const;
};

template <class Self, class V>
void SonarConfig::describeBeam(Self& self, V& visit) {
    using types::Field;
    visit(Field{"model", "", "active sonar equation, or the published mean of S(n.d)"}, self.model);
    visit(Field{"range", "m", "far edge of the last bin", 0.001, 1e5}, self.range);
    visit(Field{"range_min", "m", "nearer echoes are blanked; what is there casts its shadow", 0, 1e5}, self.range_min);
    visit(Field{"bin_count", "1", "range bins per beam", 1, 65536}, self.bin_count);
    visit(Field{"beam_width_deg", "deg", "opening of one beam", 0.001, 360}, self.beam_width_deg);
    visit(Field{"beam_height_deg", "deg", "total elevation aperture; drawn, at most 150", 0.001, 180},
          self.beam_height_deg);
    visit(Field{"beam_geometry", "", "planar: az = a_k; conical: sin(az) cos(el) = sin(a_k)"}, self.beam_geometry);
    visit(Field{"speed_of_sound", "m/s", "absent: computed from water, else 1500", 1, 20000}, self.speed_of_sound);
    visit(Field{"water", "", "state of the water"}, self.water);
    visit(Field{"frequency_khz", "kHz", "of the sonar; absorption takes it where it names none", 0.001, 1e5},
          self.frequency_khz);
    visit(Field{"absorption", "", "absent: none"}, self.absorption);
    visit(Field{"quality", "", "samples per beam, or what they are chosen for"}, self.quality);
    visit(Field{"range_rounding", "", "sample: bins of whole microseconds; exact: edges as asked"},
          self.range_rounding);
    visit(Field{"published", "", "cerqueira2017 to the letter, for comparison"}, self.published);
    visit(Field{"visibility", "",
                "cpu: rays on the processor; gl: drawn; auto: gl where a card is or device, deposit or published ask "
                "for it"},
          self.visibility);
    visit(Field{"device", "", "EGL device to draw on; absent: INSONIFY_EGL_DEVICE, else the first"}, self.device);
    visit(Field{"deposit", "", "where samples are summed into bins"}, self.deposit);
    visit(Field{"draw_all", "", "draws what is outside the fan and the range as well, to compare; rays meet it anyway"},
          self.draw_all);
    visit(Field{"beam_pattern", "", "directivity of transmitter and receiver; absent: beams are boxes side by side"},
          self.beam_pattern);
    visit(Field{"pulse", "", "what an echo leaves in range; absent: it is in its own bin alone"}, self.pulse);
    visit(Field{"volume", "", "water that scatters sound back, or a list of its layers; absent: none"}, self.volume);
    visit(Field{"motion_in_ping", "",
                "sonar and objects move, and the receiver turns, while sound is under way; false: all stand still"},
          self.motion_in_ping);
    visit(Field{"speckle", "", "echoes that interfere, by scatterers of the scene; absent: energies are summed"},
          self.speckle);
    visit(Field{"elements", "",
                "straight array whose signals port `elements` tells; needs speckle: {coherent: true}, beam_geometry: "
                "conical and a weighted aperture in beam_pattern.receive.azimuth; absent: they are not told"},
          self.elements);
    visit(Field{"multipath", "", "echoes by way of mirrors; absent: none"}, self.multipath);
    visit(Field{"max_walls", "1", "walls (`shell` of a material) that sound goes through", 0, 16}, self.max_walls);
    visit(Field{"imperfections", "",
                "errors of this device: elements, beams, focus, clock (components/sonar/README.md); absent: none"},
          self.imperfections);
    visit(Field{"crosstalk", "",
                "pings of the sonars that are connected to port `others` are heard; absent: nothing may be connected"},
          self.crosstalk);
    visit(Field{"effects", "",
                "numbers of effects, by name: `edge_diffraction: {min_turn_deg: 60}`, echoes of straight edges, and "
                "those of other libraries (components/sonar/README.md)"},
          self.effects);
    describeMoved(self, visit);
}

template <class Self, class V>
void SonarConfig::describeMoved(Self& self, V& visit) {
    using types::Field;
    visit(Field{"tvg", "",
                "has moved: a sonar gives intensities; tvg belongs to a receiver::ReceiverTask after the noise"},
          self.tvg);
    visit(Field{"gain", "",
                "has moved: a sonar gives intensities; gain_db belongs to a receiver::ReceiverTask after the "
                "noise, and so does Rock's gain, as brightness: {gain}"},
          self.gain);
    visit(Field{"output", "",
                "has moved: a sonar gives intensities; output belongs to a receiver::ReceiverTask after the noise"},
          self.output);
    visit(Field{"source_level_db", "",
                "has moved: a sonar gives intensities relative to its source; source_level_db belongs to a "
                "receiver::ReceiverTask after the noise, for output: received_level_db"},
          self.source_level_db);
}

}  // namespace insonify::sonar

template <>
struct insonify::types::EnumNames<insonify::sonar::Model> {
    static constexpr std::string_view names[] = {"physical", "cerqueira2017"};
};
template <>
struct insonify::types::EnumNames<insonify::sonar::BeamGeometry> {
    static constexpr std::string_view names[] = {"planar", "conical"};
};
template <>
struct insonify::types::EnumNames<insonify::sonar::RangeRounding> {
    static constexpr std::string_view names[] = {"sample", "exact"};
};
template <>
struct insonify::types::EnumNames<insonify::sonar::BeamWidthConvention> {
    static constexpr std::string_view names[] = {"per_beam", "total_fov"};
};
template <>
struct insonify::types::EnumNames<insonify::sonar::Deposit> {
    static constexpr std::string_view names[] = {"auto", "cpu", "gpu"};
};
template <>
struct insonify::types::EnumNames<insonify::sonar::Visibility> {
    static constexpr std::string_view names[] = {"auto", "gl", "cpu"};
};
