#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/acoustics/Absorption.hpp"
#include "components/acoustics/SoundProfile.hpp"
#include "components/sonar/BeamFan.hpp"
#include "components/sonar/BinGrid.hpp"
#include "components/sonar/Directivity.hpp"
#include "components/sonar/MaterialLaws.hpp"
#include "components/sonar/SonarConfig.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** What is compiled into the estimators where it is wanted: `#ifdef HAVE_<NAME>` in the shaders and in what the
 *  processor compiles of them. */
enum class Feature {
    Physical,
    Cerqueira2017,
    Absorption,
    Published,
    Conical,
    NormalMap,
    Nearest,
    Jitter,
    ElevationPattern,
    BackscatterLaws,  ///< Of any material: a table, or a lobe.
    Volume,
    VolumeLayers,
    Speckle,  ///< Fields of scatterers are summed, not energies.
    Refraction,
    MotionInPing
};
constexpr int feature_count = 15;

/** A set of features. */
class Features {
public:
    constexpr Features() = default;
    constexpr Features(std::initializer_list<Feature> features) {
        for (Feature feature : features) add(feature);
    }
    constexpr void add(Feature feature) { bits_ |= 1u << static_cast<unsigned>(feature); }
    constexpr bool has(Feature feature) const { return bits_ >> static_cast<unsigned>(feature) & 1u; }
    constexpr Features without(Feature feature) const {
        return Features(bits_ & ~(1u << static_cast<unsigned>(feature)));
    }
    constexpr bool operator==(const Features&) const = default;
    constexpr Features operator&(Features other) const { return Features(bits_ & other.bits_); }
    constexpr Features operator|(Features other) const { return Features(bits_ | other.bits_); }
    /** "physical", "normal_map"... */
    std::vector<std::string> names() const;
    /** "HAVE_PHYSICAL", "HAVE_NORMAL_MAP"..., for the shaders. */
    std::vector<std::string> defines() const;

    unsigned bits_ = 0;  ///< Public so that a set can be a template's parameter.

private:
    constexpr explicit Features(unsigned bits) : bits_(bits) {}
};

/** Work for each ping, in this order. */
enum class Pass { Cull, Surface, Rays, Deposit, Paths, Beams, Beamform, Pulse, RingDown };

/** What may be left out of a ping. */
enum class Effect {
    Absorption,
    AbsorptionInBin,
    SpecularLobe,
    SeabedLaw,
    MeasuredBackscatter,
    Spreading,
    BackscatterByMaterial,
    RangeFootprints,
    ElevationMask,
    SharedColumns,
    NearBlanking,
    AzimuthPattern,
    ElevationPattern,
    RangePointSpread,
    RingDown,
    PointTargets,
    Volume,
    Speckle,
    Multipath,
    FurtherSlabs,
    Refraction,
    MotionInPing,
    NormalMaps,
    Objects,
    Triangles,
    Slabs
};

/** Why something is left out. */
enum class Reason {
    NotConfigured,
    NoFrequency,
    NoMaterialHasOne,
    NoneInScene,
    MeansOfS,      ///< Bins of `cerqueira2017` are means of S(n.d).
    Published,     ///< The published simulator has none.
    BelowBound,    ///< `value` is below `bound`.
    Approximated,  ///< `value` is what it amounts to.
    NoBounces,     ///< As many reflections are asked for.
    NoMirror,      ///< Nothing in the scene reflects, or is asked to.
    NoWaterSurface,
    AboveSurface,  ///< The sonar is not in the water.
    BeyondRange,   ///< `value` is the distance of the mirror, `bound` the range [m].
    OneImage,      ///< One image shows the whole fan.
    OutOfView      ///< `value` of `bound` at the first ping.
};

/** Something that is left out, with the numbers that allow it. */
struct LeftOut {
    Effect effect;
    Reason reason;
    double value = std::numeric_limits<double>::quiet_NaN();  ///< In the effect's unit, which the report tells.
    double bound = std::numeric_limits<double>::quiet_NaN();
};

/** What is compiled and run for a sonar and a scene, decided once, without OpenGL: the renderer, both deposits, the
 *  studies and what a user is told all read it. */
struct RenderPlan {
    SonarConfig config;  ///< With the quality that is in force.
    RenderOptions options;
    bool casts_rays = false;
    Features features;
    std::vector<Pass> passes;
    BinGrid grid;
    MaterialLaws laws;
    std::shared_ptr<const acoustics::SoundProfile> profile;  ///< That bends the rays; null: they are straight.
    Fan beams;
    std::optional<Directivity> directivity;  ///< None without a beam pattern.
    SonarConfig sampled;                     ///< What is sampled: sampledConfig(), or `config`.
    Fan cells;                               ///< Its azimuth cells; the beams themselves without a pattern in azimuth.
    std::vector<ViewFrustum> frusta;         ///< Images of the cells; none with rays.
    std::vector<LeftOut> left_out;

    /** Other rows and columns per beam [1], and the images that go with them. */
    void setQuality(int rows, int columns_per_beam);
    bool has(Pass pass) const { return std::ranges::count(passes, pass) > 0; }
    /** What is left out of an effect, null where it is not. */
    const LeftOut* leftOut(Effect effect) const;
};

RenderPlan makeRenderPlan(const SonarConfig& config, const types::Geometry& geometry,
                          const RenderOptions& options = {});

/** Share of the sound that a material reflects as a mirror does, where `bounces` reflections of a way are asked for
 *  [1]: one that is declared to, or from two on one that is smooth (ACOUSTICS.md 5.23); 0: it does not. */
double reflectedPower(const types::Material& material, int bounces);

/** Gradient of the speed of sound with depth that refraction is judged by without a profile, a strong thermocline
 *  [1/s]. */
constexpr double speed_gradient = 0.1;

/** How far a ray is bent at the far edge by a gradient [1/s], and what of it can be ignored [m] (ACOUSTICS.md 12). */
struct Bending {
    double offset, tolerated;
};
Bending bending(const SonarConfig& config, const BinGrid& grid, double gradient = speed_gradient);

/** From where on motion within a ping is heard: half a bin at the far edge, half the width of a beam (ACOUSTICS.md 12).
 */
struct MotionBound {
    double speed;  ///< [m/s]
    double turn;   ///< [rad/s]
};
MotionBound motionBound(const SonarConfig& config, const BinGrid& grid);

/** What a chirp adds to the range of an echo for each metre a second at which it recedes, f T / B; 0: nothing [s]. */
double dopplerCoupling(const SonarConfig& config);

/** Why a sonar cannot bend its rays as its profile of the speed of sound would have them; empty where it can, or where
 *  these are too straight for it to matter.
 *  @throws types::ConfigError with all that is wrong with the profile's file */
std::string whyStraight(const SonarConfig& config);

/** The configured absorption; none when the block is absent. A law needs `water`. */
acoustics::Absorption makeAbsorption(const SonarConfig& config);

}  // namespace insonify::sonar

template <>
struct insonify::types::EnumNames<insonify::sonar::Feature> {
    static constexpr std::string_view names[] = {
        "physical",   "cerqueira2017", "absorption", "published",         "conical",
        "normal_map", "nearest",       "jitter",     "elevation_pattern", "backscatter_laws",
        "volume",     "volume_layers", "speckle",    "refraction",        "motion_in_ping"};
};
template <>
struct insonify::types::EnumNames<insonify::sonar::Pass> {
    static constexpr std::string_view names[] = {"cull",  "surface",  "rays",  "deposit",  "paths",
                                                 "beams", "beamform", "pulse", "ring_down"};
};
