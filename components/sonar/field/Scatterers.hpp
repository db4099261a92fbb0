#pragma once
#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "components/sonar/echo/EchoRules.hpp"
#include "components/sonar/echo/Interface.hpp"
#include "components/sonar/rays/AngularView.hpp"

namespace insonify::sonar {

/** A part of a triangle's plane that neighbouring samples see; sonar axes. */
struct Patch {
    static constexpr size_t max_beams = 4;  ///< As many as a tile has columns.

    glm::dvec3 normal;                  ///< Of any length [1].
    double distance;                    ///< normal.p of its points [m].
    glm::dvec3 middle;                  ///< Unit, to its middle [1].
    std::array<glm::dvec3, 4> corners;  ///< Unit, to its corners, one side after the other [1].
    AngularView::Direction low_bearing, high_bearing;
    size_t beams;                                                     ///< In which it lies, neighbours [1].
    std::array<AngularView::Direction, max_beams - 1> next_bearings;  ///< Where the second begins, and so on.
    double low_sine, high_sine;                                       ///< Of its elevations [1].
    double width, height;                                             ///< [rad]
    double strength_range;                                            ///< Strength times slant range [m].
    double per_solid_angle;  ///< Two-way pattern in elevation, over the solid angle of a cell [1/sr].
    const ObjectRecord& object;
    uint32_t number;  ///< Of the object [1].
    bool conical;     ///< Bearings are those of cones.
};

/** The axes of an object, along which its scatterers lie. */
struct LatticeFrame {
    LatticeFrame() = default;
    explicit LatticeFrame(const ObjectRecord& object);

    glm::dmat3 axes{1};                   ///< Unit, of the object in sonar axes [1].
    std::array<glm::dvec3, 3> inverse{};  ///< A vector's parts along them, in metres of the world [1].
    glm::dvec3 place{0};                  ///< The sonar's along them [m].
    double volume = 1;                    ///< That three of a metre span [1].
};

struct PatchLattice;
struct LatticePatch;

/** Squares of a lattice in which scatterers of a patch may be, from the square that holds its middle. */
struct LatticeSquares {
    static constexpr int most = 256;
    alignas(64) int32_t u[most] = {}, v[most] = {};
};

/** What scatterers add: a field in units of the square root of a whole cell, and to which range cell; 0 to the first:
 *  none. */
struct ScatteredFields {
    alignas(64) float real[LatticeSquares::most], imaginary[LatticeSquares::most];
    alignas(64) int32_t cell[LatticeSquares::most], beam[LatticeSquares::most];  ///< The beam from the patch's first.
    alignas(64) uint32_t bits[LatticeSquares::most];
};

/** The estimator of fields: which scatterers lie on what samples see, and what they add to the field of each range cell
 *  of a beam (ACOUSTICS.md 5.21). */
class Scatterers {
public:
    static constexpr bool tells_truth = false;
    static constexpr Features features{Feature::Physical, Feature::Speckle};

    /** `sums`: EchoRules::sumCount() for each beam, [range cell][real, imaginary] in quanta, with sign. */
    Scatterers(const EchoRules& rules, uint64_t* sums) : rules_(rules), beam_sums_(rules.sumCount()), sums_(sums) {}

    /** `beam`: the patch's first. */
    void deposit(const Patch& patch, size_t beam);

private:
    /** Slant ranges [m]. */
    struct Ranges {
        double near, far;
    };
    Ranges rangesOf(const Patch& patch) const;
    void depositLevel(const Patch& patch, const PatchLattice& lattice, const LatticeLevel& level, const Ranges& ranges,
                      uint64_t* of_beam);
    /** Adds the first of fields_ to the sums. */
    void sum(const LatticeLevel& level, int count, uint64_t* of_beam);

    const EchoRules& rules_;
    size_t beam_sums_;  ///< Numbers of a beam [1].
    uint64_t* sums_;
    LatticeFrame frame_;
    uint32_t frame_of_ = 0xffffffff;  ///< An object's number.
    LatticeSquares squares_;
    ScatteredFields fields_;
};

}  // namespace insonify::sonar
