#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/acoustics/Absorption.hpp"
#include "components/acoustics/SoundSpeed.hpp"
#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/beams/Directivity.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "components/sonar/surfaces/MaterialLaws.hpp"
#include "components/sonar/surfaces/ObjectPlacements.hpp"
#include "types/ReturnLevels.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::sonar {

/** Parts of the estimators that are compiled in only where needed: `#ifdef HAVE_<NAME>` in the shaders and in the
 *  shader code that is compiled for the processor. Effects add names of their own (RenderPlan::effect_features). */
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
    BackscatterLaws,  ///< At least one material has a table or a lobe.
    Speckle           ///< Fields of scatterers are summed, not energies.
};
constexpr int feature_count = 11;

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

    unsigned bits_ = 0;  ///< Public so that a set can be a template's parameter.

private:
    constexpr explicit Features(unsigned bits) : bits_(bits) {}
};

/** Work for each ping, in this order. */
enum class Pass { Cull, Surface, Rays, SurfaceMaps, Deposit, Walls, Paths, Beams, Beamform, Pulse, RingDown };

/** Reason for an omission; Omitted::words adds the details. */
enum class Reason {
    NotConfigured,
    NoneInScene,
    Lacking,       ///< It is configured, and the scene lacks what it needs: a warning.
    BelowBound,    ///< `value` is below `bound`.
    Approximated,  ///< `value` is its effect, which is approximated.
    OutOfView,     ///< `value` out of `bound` at the first ping.
    Other
};

/** An omission, with the numbers that justify it. */
struct Omitted {
    /** The reason in words. */
    using Words = std::string (*)(const Omitted& what, const BinGrid& grid);

    std::string_view effect;  ///< Name in words, a constant.
    Reason reason;
    double value = std::numeric_limits<double>::quiet_NaN();  ///< In the effect's unit, which the words state.
    double bound = std::numeric_limits<double>::quiet_NaN();
    Words words = nullptr;  ///< Null: the words of the reason.
};

class Effect;

/** What is compiled and run for a sonar and a scene, decided once, without OpenGL. The renderer, both deposits, the
 *  studies and the report to the user all read it. */
struct RenderPlan {
    SonarConfig config;  ///< With the current quality.
    RenderOptions options;
    bool traces_rays = false;
    Features features;
    std::vector<std::string> effect_features;  ///< Names that effects add: "motion_in_ping".
    std::vector<const Effect*> effects;        ///< Active effects, in order.
    std::vector<Pass> passes;                  ///< In order.
    BinGrid grid;
    BinGrid summed;  ///< Range cells in which echoes are summed: the bins, or parts of them where fields are summed.
    MaterialLaws laws;
    std::shared_ptr<const acoustics::SoundProfile> profile;  ///< Bends the rays; null: they are straight.
    Fan beams;
    std::optional<Directivity> directivity;  ///< None without a beam pattern.
    SonarConfig sampled;                     ///< Configuration of the samples: sampledConfig(), or `config`.
    Fan cells;  ///< Azimuth cells of `sampled`; the beams themselves without a pattern in azimuth.
    std::vector<ViewFrustum> frusta;  ///< Frusta of the images of the cells; empty with rays.
    double max_map_strength = 1;      ///< Max factor by surface maps, at least 1 [1].
    bool fills_water = false;         ///< Whether there are echoes where there is no surface.
    bool echoes_from_misses = false;  ///< Whether effects process samples that hit nothing.
    std::vector<Omitted> omitted;

    /** Sets other rows and columns per beam [1], and the matching images. */
    void setQuality(int rows, int columns_per_beam);
    bool has(Pass pass) const { return std::ranges::count(passes, pass) > 0; }
    /** Inserts a pass at its place in the order. */
    void add(Pass pass) { passes.insert(std::ranges::upper_bound(passes, pass), pass); }
    bool hasFeature(std::string_view name) const;
    /** Whether the bins are squares of fields, which fluctuate about their mean, not energies. */
    bool sumsFields() const { return features.has(Feature::Speckle); }
    /** Returns "physical", "normal_map"..., then the names that effects add. */
    std::vector<std::string> featureNames() const;
    /** "HAVE_PHYSICAL", "HAVE_NORMAL_MAP"..., for the shaders. */
    std::vector<std::string> defines() const;
    /** Returns the omission of an effect, by its name in words; null where it is not omitted. */
    const Omitted* findOmitted(std::string_view effect) const;
};

RenderPlan makeRenderPlan(const SonarConfig& config, const types::Geometry& geometry,
                          const RenderOptions& options = {});

/** Returns the part of space that the sonar of a plan covers. */
Reach reach(const RenderPlan& plan);

/** Returns the configured absorption; none when the block is absent. A law needs `water`. */
acoustics::Absorption makeAbsorption(const SonarConfig& config);

/** Returns what is known of the bins of a configured sonar, for the detection of returns. */
types::ReturnRules makeReturnRules(const SonarConfig& config);

}  // namespace insonify::sonar

template <>
struct insonify::types::EnumNames<insonify::sonar::Feature> {
    static constexpr std::string_view names[] = {"physical",          "cerqueira2017",    "absorption", "published",
                                                 "conical",           "normal_map",       "nearest",    "jitter",
                                                 "elevation_pattern", "backscatter_laws", "speckle"};
};
template <>
struct insonify::types::EnumNames<insonify::sonar::Pass> {
    static constexpr std::string_view names[] = {"cull",  "surface", "rays",     "surface_maps", "deposit",  "walls",
                                                 "paths", "beams",   "beamform", "pulse",        "ring_down"};
};
