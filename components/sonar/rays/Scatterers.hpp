#pragma once
#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "components/sonar/base/Interface.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "components/sonar/rays/AngularView.hpp"

namespace insonify::sonar {

/** The part of a triangle's plane that samples of one rectangle see; sonar axes. */
struct Patch {
    static constexpr int max_columns = 4, max_rows = 4;  ///< Max size of a rectangle that is seen in part.

    glm::dvec3 normal;                  ///< Any length [1].
    double distance;                    ///< normal.p of the patch's points [m].
    glm::dvec3 middle;                  ///< Unit vector to the rectangle's middle [1].
    std::array<glm::dvec3, 4> corners;  ///< Unit vectors to its corners, side by side [1].
    double width, height;               ///< [rad]
    AngularView::Direction bearing;     ///< Bearing of the middle.
    std::array<double, max_columns + 1>
        columns;  ///< Edges: tangents about `bearing`, or sines of cones; the last is repeated.
    std::array<double, max_rows + 1> rows;    ///< Edges: sines of elevation; the last is repeated.
    uint32_t seen;                            ///< Bit max_columns * row + column of each sample that sees the plane.
    std::array<uint32_t, max_columns> beams;  ///< Beam of each column, counted from the first beam of the sums [1].
    double strength_range;                    ///< Strength times slant range [m].
    double per_solid_angle;                   ///< Two-way pattern in elevation, over the solid angle of a cell [1/sr].
    const ObjectRecord& object;
    uint32_t number;  ///< Number of the object's lattice [1].
    bool conical;     ///< Bearings are bearings of cones.
};

/** The axes of an object, with which its scatterers are aligned. */
struct LatticeFrame {
    LatticeFrame() = default;
    explicit LatticeFrame(const ObjectRecord& object);

    glm::dmat3 axes{1};  ///< Unit axes of the object, in sonar axes [1].
    std::array<glm::dvec3, 3>
        inverse{};        ///< Rows that give a vector's components along them, in metres of the world [1].
    glm::dvec3 place{0};  ///< Place of the sonar along them [m].
    double volume = 1;    ///< Volume spanned by the three axes, each a metre long [1].
};

struct PatchLattice;
struct LatticePatch;

/** Squares of a lattice in which scatterers of a patch may be, counted from the square of its middle. */
struct LatticeSquares {
    static constexpr int capacity = 256, at_once = 16;
    alignas(64) int32_t u[capacity + at_once] = {}, v[capacity + at_once] = {};
};

/** Scatterers of squares, and the fields of those inside the patch. */
struct LatticeScatterers {
    alignas(64) float u[LatticeSquares::capacity],
        v[LatticeSquares::capacity];                      ///< From the patch's middle [spacings].
    alignas(64) uint32_t bits[LatticeSquares::capacity];  ///< Random bits of the square.
    alignas(
        64) float size[LatticeSquares::capacity];  ///< Size of the field, in units of the square root of a whole cell.
    alignas(64) float turns[LatticeSquares::capacity];  ///< Phase of the two-way path.
    alignas(64) int32_t sum[LatticeSquares::capacity];  ///< Index of the sum of the real part; -1: outside the patch.
    alignas(64) float real[LatticeSquares::capacity], imaginary[LatticeSquares::capacity];  ///< Fields.
    alignas(64) int64_t real_quanta[LatticeSquares::capacity], imaginary_quanta[LatticeSquares::capacity];
};

/** The estimator of fields. Finds the scatterers on the surfaces that samples see, and adds their fields to each range
 *  cell of a beam (ACOUSTICS.md 5.21). */
class Scatterers {
public:
    static constexpr bool reports_truth = false;
    static constexpr Features features{Feature::Physical, Feature::Speckle};

    /** `sums`: EchoRules::sumCount() for each beam, [range cell][real, imaginary] in quanta, with sign. */
    Scatterers(const EchoRules& rules, uint64_t* sums) : rules_(rules), sums_(sums) {}

    void deposit(const Patch& patch);

private:
    /** Slant ranges [m]. */
    struct Ranges {
        double near, far;
    };
    Ranges computeRanges(const Patch& patch) const;
    void depositLevel(const Patch& patch, const PatchLattice& lattice, const LatticeLevel& level, const Ranges& ranges);
    /** Adds the fields of the first squares. */
    void add(const LatticePatch& part, const LatticeLevel& level, int count);

    const EchoRules& rules_;
    uint64_t* sums_;
    LatticeFrame frame_;
    const ObjectRecord* frame_of_ = nullptr;  ///< The object of `frame_`.
    LatticeSquares squares_;
    LatticeScatterers scatterers_;
};

}  // namespace insonify::sonar
