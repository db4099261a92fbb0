#pragma once
#include <complex>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/acoustics/Absorption.hpp"
#include "components/acoustics/BeamPattern.hpp"
#include "components/acoustics/Pulse.hpp"
#include "components/acoustics/Water.hpp"
#include "types/text/Describe.hpp"

namespace insonify::sonar {

/** Errors of one device compared with an ideal device, drawn at random from a seed. They are the same for the device's
 *  whole life (ACOUSTICS.md 5.27). Values of 0, empty lists and absent values give an ideal device. */
struct ImperfectionsConfig {
    uint32_t seed = 1;
    std::optional<int> elements = {};
    double gain_error_db = 0, phase_error_deg = 0, dead_element_share = 0;
    std::vector<uint32_t> dead_elements = {};
    std::optional<double> focus_m = {};
    double beam_gain_error_db = 0, dead_beam_share = 0;
    std::vector<uint32_t> dead_beams = {};
    std::optional<double> crosstalk_db = {};
    double clock_jitter_us = 0;

    /** Returns whether elements of the receiving array differ from ideal elements. */
    bool hasElementErrors() const {
        return gain_error_db > 0 || phase_error_deg > 0 || dead_element_share > 0 || !dead_elements.empty();
    }
    /** Returns the factors of the signals of `count` elements: (gain) exp(i phase), 0 for a dead element. */
    std::vector<std::complex<double>> elementFactors(size_t count) const;
    /** Returns the factors of the intensities of `count` beams, 0 for a dead beam. */
    std::vector<float> beamFactors(size_t count) const;

    static void describe(auto& self, auto& visit) {
        visit({"seed", "1", "seed of the errors; each device has its own", 0, 4294967295.0}, self.seed);
        visit({"elements", "1",
               "elements of the receiving array; absent: those of `elements`, or half a wavelength apart", 2, 4096},
              self.elements);
        visit({"gain_error_db", "dB", "standard deviation of the elements' gains", 0, 20}, self.gain_error_db);
        visit({"phase_error_deg", "deg", "standard deviation of the elements' phases", 0, 180}, self.phase_error_deg);
        visit({"dead_element_share", "1", "probability that an element is dead", 0, 1}, self.dead_element_share);
        visit({"dead_elements", "1", "further dead elements, counted from starboard, the first is 0", 0, 4095},
              self.dead_elements);
        visit({"focus_m", "m",
               "fixed focus of the receiving array; nearer and farther echoes bloom; needs frequency_khz; absent: "
               "focused at every range",
               0.01, 1e5},
              self.focus_m);
        visit({"beam_gain_error_db", "dB", "standard deviation of the beams' gains", 0, 20}, self.beam_gain_error_db);
        visit({"dead_beam_share", "1", "probability that a beam is dead", 0, 1}, self.dead_beam_share);
        visit({"dead_beams", "1", "further dead beams, in the ping's order, the first is 0", 0, 4095}, self.dead_beams);
        visit({"crosstalk_db", "dB", "power of a beam that leaks into each of its neighbours; absent: none", -200, 0},
              self.crosstalk_db);
        visit({"clock_jitter_us", "us",
               "standard deviation of the receiver's times at which bins are sampled, there and back", 0, 1e5},
              self.clock_jitter_us);
    }
};

/** Reception of the pulses of other sonars (ACOUSTICS.md 5.29). */
struct CrosstalkConfig {
    bool echoes = true;
    std::optional<double> source_level_db;
    double rejection_db = 40;

    static void describe(auto& self, auto& visit) {
        visit({"echoes", "", "surfaces scatter the pings of others to this sonar too; false: direct paths only"},
              self.echoes);
        visit({"source_level_db", "dB re 1 uPa m",
               "of this sonar, both as a source and as the reference for what it receives; absent: all sonars "
               "have equal levels",
               -300, 300},
              self.source_level_db);
        visit({"rejection_db", "dB", "attenuation of the receiver outside its band", 0, 300}, self.rejection_db);
    }
};

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

    static void describe(auto& self, auto& visit) {
        visit({"db_per_m", "dB/m", "one-way absorption, instead of a law", 0, 1000}, self.db_per_m);
        visit({"law", "", "computes it from frequency and water"}, self.law);
        visit({"frequency_khz", "kHz", "frequency for the law; absent: the sonar's", 0.001, 1e5}, self.frequency_khz);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Directivity of an array in azimuth and elevation. A receiver without a law in azimuth receives the box of each beam;
 *  any other absent law is 1 in all directions, beside a law of the other array about the same axis. */
struct ArrayConfig {
    std::optional<acoustics::BeamLaw> azimuth, elevation;

    static void describe(auto& self, auto& visit) {
        visit({"azimuth", "", "transmit: about the sonar's axis; receive: about each beam's bearing"}, self.azimuth);
        visit({"elevation", "", "about the horizontal plane of the sonar"}, self.elevation);
    }
};

/** Two-way directivity: the product of transmitter and receiver (ACOUSTICS.md 5.9). */
struct BeamPatternConfig {
    ArrayConfig transmit, receive;
    double floor_db = -60;

    bool hasAzimuth() const { return transmit.azimuth || receive.azimuth; }
    bool hasElevation() const { return transmit.elevation || receive.elevation; }

    static void describe(auto& self, auto& visit) {
        visit({"transmit", "", "directivity of the transmitter"}, self.transmit);
        visit({"receive", "", "directivity of the receiver"}, self.receive);
        visit({"floor_db", "dB",
               "two-way level down to which sidelobes receive echoes, also outside the fan and the aperture", -200, -3},
              self.floor_db);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Water that scatters sound back, in a layer between two depths or everywhere. */
struct VolumeLayer {
    std::optional<double> top_m, bottom_m, strength_db;

    static void describe(auto& self, auto& visit) {
        visit({"top_m", "m", "depth below the water surface, or the world's z = 0; absent: no bound", -1e5, 1e5},
              self.top_m);
        visit({"bottom_m", "m", "depth of the layer's lower bound; absent: no bound", -1e5, 1e5}, self.bottom_m);
        visit({"strength_db", "dB re 1/m", "volume backscattering strength; -200: none", -200, 0}, self.strength_db);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** The water surface as a mirror. */
struct SurfaceMirrorConfig {
    double wind_m_s = 0;

    static void describe(auto& self, auto& visit) {
        visit({"wind_m_s", "m/s", "wind speed, which makes the surface rough; 0: perfectly flat", 0, 50},
              self.wind_m_s);
    }
};

/** Echoes that arrive via mirrors (ACOUSTICS.md 5.23). */
struct MultipathConfig {
    static constexpr int max_bounces = 2;

    std::optional<SurfaceMirrorConfig> surface;
    int bounces = 1;

    static void describe(auto& self, auto& visit) {
        visit({"surface", "", "the scene's water_surface reflects; absent: it lets all sound through"}, self.surface);
        visit({"bounces", "1",
               "max reflections of one path: 1 in the water surface and materials with `mirror: true`, 2 in "
               "smooth materials as well; 0: none",
               0, max_bounces},
              self.bounces);
    }
};

/** Echoes that interfere. Each surface is a lattice of scatterers that belong to its object, and a bin is the square of
 *  the sum of their fields (ACOUSTICS.md 5.21). */
struct SpeckleConfig {
    bool coherent = false;
    int scatterers_per_cell = 10;
    std::optional<double> scatterers_per_m2;

    static void describe(auto& self, auto& visit) {
        visit({"coherent", "", "true: fields are summed, needs frequency_khz; false: energies are summed"},
              self.coherent);
        visit({"scatterers_per_cell", "1",
               "min number of scatterers in a resolution cell (beam width by range resolution)", 1, 200},
              self.scatterers_per_cell);
        visit({"scatterers_per_m2", "1/m2",
               "density of scatterers on surfaces, with exponentially distributed strengths: intensities are "
               "K-distributed, with the number of scatterers in a cell as shape (Abraham and Lyons 2002); absent: "
               "dense enough that none dominates",
               1e-6, 1e9},
              self.scatterers_per_m2);
    }
};

/** A straight array of equal elements whose signals are written. It is as long as the aperture of
 *  `beam_pattern.receive.azimuth`. */
struct ElementsConfig {
    std::optional<int> count;
    std::optional<double> spacing_m;

    /** Number of elements, and their spacing [m]. */
    struct Array {
        size_t count;
        double spacing;
    };
    /** Returns the given values, the rest from the length of the aperture [m]; half a wavelength apart where none is
     *  given. */
    Array makeArray(double aperture_m, double wavelength) const;

    static void describe(auto& self, auto& visit) {
        visit({"count", "1", "number of elements; absent: the number that fits the receiver's aperture", 2, 4096},
              self.count);
        visit({"spacing_m", "m", "spacing of their centres; absent: the aperture over count, or half a wavelength",
               1e-5, 10},
              self.spacing_m);
    }
};

/** Samples per beam: given, or chosen from the pings for an error or a time. The default is an error of 0.05 with at
 *  most 400,000 samples per ping. */
struct QualityConfig {
    std::optional<int> rows, columns_per_beam;
    std::optional<double> target_error, budget_ms;
    std::optional<int> max_samples;

    bool operator==(const QualityConfig&) const = default;
    bool isGiven() const { return rows || columns_per_beam; }

    static void describe(auto& self, auto& visit) {
        visit({"rows", "1", "rows of samples over beam_height_deg; 256 where only columns_per_beam is given", 1, 16384},
              self.rows);
        visit({"columns_per_beam", "1", "columns of samples per beam; 2 where only rows is given", 1, 4096},
              self.columns_per_beam);
        visit({"target_error", "1",
               "instead of rows and columns: relative L2 error of energies times r^5; default 0.05", 1e-4, 1},
              self.target_error);
        visit({"max_samples", "1", "max samples of a ping; absent: 400000, or unlimited if target_error is given", 1,
               1e9},
              self.max_samples);
        visit(
            {"budget_ms", "ms", "instead of rows and columns: render time of a ping, used fully and kept to", 0.1, 1e5},
            self.budget_ms);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** An imaging sonar. Beam k of a fan covers bearings [-fov/2 + k fov/N, -fov/2 + (k + 1) fov/N], positive to port.
 *  `bearings_deg` replaces `field_of_view_deg` and `beam_count`. `beam_width_deg` alone replaces `field_of_view_deg`.
 *  With both, `beam_width_deg` is the width of each beam, and beams may overlap. */
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
    bool across_track = false;  ///< The fan is upright and looks down, as a side-scan's; not a property.
    std::optional<SpeckleConfig> speckle;
    std::optional<ElementsConfig> elements;
    std::optional<MultipathConfig> multipath;
    int32_t max_walls = 4;
    std::optional<ImperfectionsConfig> imperfections;
    std::optional<CrosstalkConfig> crosstalk;
    std::map<std::string, std::map<std::string, double>> effects;

    /** Returns whether there is more than one layer of scattering water, or one with bounds. */
    bool hasLayers() const { return volume.size() > 1 || (!volume.empty() && (volume[0].top_m || volume[0].bottom_m)); }
    /** Return the rows of samples and the columns per beam, until others are chosen for an error or a time [1]. */
    int rows() const { return quality.rows.value_or(256); }
    int columnsPerBeam() const { return quality.columns_per_beam.value_or(2); }
    /** Returns the error to choose the quality for. None when the quality or a budget is given, or with `published`. */
    std::optional<double> targetError() const;
    /** Returns the max number of samples of a ping for its target; none when it is unlimited [1]. */
    std::optional<double> maxSamples() const;
    /** Returns whether the quality is chosen from the pings, rather than given. */
    bool choosesQuality() const { return targetError() || quality.budget_ms; }
    /** Returns the beams per ping: of `bearings_deg`, else beam_count [1]. */
    int beams() const { return bearings_deg.empty() ? beam_count : static_cast<int>(bearings_deg.size()); }
    /** Returns the azimuth of a regular fan, from edge to edge: as given, else 120 [deg]. */
    double fieldOfViewDeg() const { return field_of_view_deg.value_or(120); }
    /** Returns the centre of beam k [deg], 0 ahead, positive to port. */
    double bearingDeg(int k) const;
    /** Returns the opening of one beam across the fan [deg]. */
    double beamWidthDeg() const { return bearings_deg.empty() ? fieldOfViewDeg() / beam_count : *beam_width_deg; }
    /** Returns the azimuth from the outer edge of the first beam to that of the last [deg], at most 360. */
    double coverageDeg() const;
    /** Returns this configuration with the fan of `beam_width_deg` expressed by `field_of_view_deg`, or by
     *  `bearings_deg` where both are given. */
    SonarConfig fan() const;
    /** Returns whether echoes may arrive via mirrors, which requires rays. */
    bool tracesPaths() const { return multipath && multipath->bounces > 0; }
    /** Returns whether fields are summed rather than energies. */
    bool isCoherent() const { return speckle && speckle->coherent; }
    /** Returns the property that only rays support; empty where there is none. */
    std::string needsRays() const;
    /** Returns whether visible surfaces are found by rays on the processor, else by rasterising, as far as the
     *  configuration and the environment decide. None: it depends on whether there is a graphics card. */
    std::optional<bool> choosesRays() const;
    /** Returns the same; looks for a graphics card where nothing else decides. */
    bool tracesRays() const;
    /** Throws types::ConfigError where the configuration needs a graphics device that EGL does not list. */
    void requireDevice(const std::string& task) const;
    /** Returns the frequency for the law of absorption: its own, or the sonar's [kHz]; none where absorption has no
     *  law. */
    std::optional<double> absorbedKhz() const {
        if (!absorption || absorption->db_per_m) return {};
        return absorption->frequency_khz ? absorption->frequency_khz : frequency_khz;
    }
    /** Returns the speed of sound: configured, or that of `water`, or 1500 [m/s]. */
    double speedOfSound() const;

    static void describe(auto& self, auto& visit) {
        visit({"beam_count", "1", "beams per ping", 1, 4096}, self.beam_count);
        visit({"field_of_view_deg", "deg",
               "azimuth covered, edge to edge; absent: 120, or beam_count beams of beam_width_deg; with "
               "beam_width_deg beams may be wider than their spacing",
               0.01, 360},
              self.field_of_view_deg);
        visit({"bearings_deg", "deg", "instead of a regular fan: centre of each beam", -180, 180}, self.bearings_deg);
        visit({"beam_width_convention", "", "beam_width_deg of a regular fan is one beam's, or the whole fan's"},
              self.beam_width_convention);
        describeBeam(self, visit);
    }
    /** Describes the properties that a scanning sonar has as well. */
    static void describeBeam(auto& self, auto& visit);
    /** Describes the keys that have moved to the receiver. */
    void check(types::Diagnostics& diagnostics) const;
    /** Appends the diagnostics of a fan that is given by `beam_width_deg`. */
    void checkFan(types::Diagnostics& diagnostics) const;
    /** Appends the diagnostics that a scanning sonar can have as well. */
    void checkBeam(types::Diagnostics& diagnostics) const;
};

void SonarConfig::describeBeam(auto& self, auto& visit) {
    visit({"model", "", "active sonar equation, or the published mean of S(n.d)"}, self.model);
    visit({"range", "m", "far edge of the last bin", 0.001, 1e5}, self.range);
    visit({"range_min", "m", "nearer echoes are blanked; objects there cast shadows", 0, 1e5}, self.range_min);
    visit({"bin_count", "1", "range bins per beam", 1, 65536}, self.bin_count);
    visit({"beam_width_deg", "deg", "opening of one beam", 0.001, 360}, self.beam_width_deg);
    visit({"beam_height_deg", "deg", "total elevation aperture; at most 150 if rasterised", 0.001, 180},
          self.beam_height_deg);
    visit({"beam_geometry", "", "planar: az = a_k; conical: sin(az) cos(el) = sin(a_k)"}, self.beam_geometry);
    visit({"speed_of_sound", "m/s", "absent: computed from water, else 1500", 100, 20000}, self.speed_of_sound);
    visit({"water", "", "state of the water"}, self.water);
    visit({"frequency_khz", "kHz", "of the sonar; absorption uses it unless it has its own", 0.001, 1e5},
          self.frequency_khz);
    visit({"absorption", "", "absent: none"}, self.absorption);
    visit({"quality", "", "samples per beam, or the target that they are chosen for"}, self.quality);
    visit({"range_rounding", "", "sample: bins of whole microseconds; exact: edges as configured"},
          self.range_rounding);
    visit({"published", "", "cerqueira2017 to the letter, for comparison"}, self.published);
    visit({"visibility", "",
           "cpu: rays on the processor; gl: rasterised; auto: gl with a graphics card, or if device, deposit or "
           "published requires it"},
          self.visibility);
    visit({"device", "", "EGL device to render on; absent: INSONIFY_EGL_DEVICE, else the first"}, self.device);
    visit({"deposit", "", "where samples are summed into bins"}, self.deposit);
    visit({"draw_all", "", "rasterises what is outside the fan and the range too, for comparison; no effect on rays"},
          self.draw_all);
    visit({"beam_pattern", "", "directivity of transmitter and receiver; absent: beams are boxes side by side"},
          self.beam_pattern);
    visit({"pulse", "", "spread of an echo in range; absent: each echo is in its own bin alone"}, self.pulse);
    visit({"volume", "", "water that scatters sound back, or a list of its layers; absent: none"}, self.volume);
    visit({"motion_in_ping", "",
           "sonar and objects move, and the receiver turns, while sound travels; false: all are at rest"},
          self.motion_in_ping);
    visit({"speckle", "", "echoes that interfere, by scatterers of the scene; absent: energies are summed"},
          self.speckle);
    visit({"elements", "",
           "straight array whose signals are on port `elements`; needs speckle: {coherent: true}, beam_geometry: "
           "conical and a weighted aperture in beam_pattern.receive.azimuth; absent: no signals"},
          self.elements);
    visit({"multipath", "", "echoes via mirrors; absent: none"}, self.multipath);
    visit({"max_walls", "1", "max walls (`shell` of a material) on a sound path", 0, 16}, self.max_walls);
    visit({"imperfections", "",
           "errors of this device: elements, beams, focus, clock (components/sonar/EFFECTS.md); absent: none"},
          self.imperfections);
    visit({"crosstalk", "",
           "pings of the sonars connected to port `others` are received; absent: nothing may be connected"},
          self.crosstalk);
    visit({"effects", "",
           "numbers of effects, by name: `edge_diffraction: {min_turn_deg: 60}` for echoes of straight edges, and "
           "effects of other libraries (components/sonar/DEVELOP.md)"},
          self.effects);
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
