#pragma once
#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "components/sonar/base/Interface.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "components/sonar/rays/AngularView.hpp"

namespace insonify::sonar {

/** A batch of patches. A patch is the part of a triangle's plane that samples of one rectangle see. Vectors are
 *  [x, y, z][patch], in sonar axes. */
struct Patches {
    static constexpr int capacity = 64;
    static constexpr int max_columns = 4, max_rows = 4;  ///< Max size of a rectangle that is seen in part.
    static constexpr int corners = 4;

    alignas(64) double normal[3][capacity];                   ///< Any length [1].
    double distance[capacity];                                ///< normal.p of the patch's points [m].
    double middle[3][capacity];                               ///< Unit vector to the rectangle's middle [1].
    double width[capacity], height[capacity];                 ///< Max extent in azimuth, and in elevation [rad].
    double bearing_cosine[capacity], bearing_sine[capacity];  ///< Bearing of the middle.
    double edge_cosine[max_columns + 1][capacity], edge_sine[max_columns + 1][capacity];  ///< Bearings of columns.
    double corner_cosine[corners][capacity], corner_sine[corners][capacity];  ///< Azimuths of corners, side by side.
    double low_cosine[capacity], low_sine[capacity], high_cosine[capacity], high_sine[capacity];  ///< Elevations.
    double strength_range[capacity];        ///< Strength times slant range [m].
    double per_solid_angle[capacity];       ///< Two-way pattern in elevation, over the solid angle of a cell [1/sr].
    float rows[max_rows + 1][capacity];     ///< Edges: sines of elevation; the last is repeated, as that of columns.
    uint32_t seen[capacity];                ///< Bit max_columns * row + column of each sample that sees the plane.
    uint32_t beams[max_columns][capacity];  ///< Beam of each column, counted from the first beam of the sums [1].
    uint32_t object[capacity];              ///< Index into the objects.
    uint32_t number[capacity];              ///< Number of the object's lattice [1].
    int count = 0;
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

/** Squares of a lattice in which scatterers of a patch may be, counted from the square of its middle. */
struct LatticeSquares {
    static constexpr int capacity = 256, at_once = 16;
    alignas(64) int32_t u[capacity + at_once] = {}, v[capacity + at_once] = {};
};

/** Patches on the lattices of their objects, whose two axes are u and v. */
struct LatticePatches {
    static constexpr int capacity = Patches::capacity, corners = Patches::corners;
    static constexpr int far_side = corners, sides = corners + 1;  ///< Of an outline: that of the far range is last.

    alignas(64) double inverse[2][3][capacity];  ///< Rows that give a vector's components along u and v [1].
    double along[2][3][capacity];                ///< Step on the plane per metre along u and v [m].
    double middle[2][capacity];                  ///< Place of the middle [m].
    double range[capacity];                      ///< Slant range of the middle [m].
    double near[capacity], far[capacity];        ///< Slant ranges that the patch may reach [m].
    double corner_inverse[corners][capacity];    ///< Inverse slant ranges of the corners [1/m].
    double area_height[capacity];  ///< Area of the plane per square metre of the lattice, times its distance [m].
    uint32_t side[capacity];       ///< The axis that the patch faces most, and whether from behind: 0 to 5.
    float columns[Patches::max_columns + 1][capacity];  ///< Edges: tangents about the bearing, or sines of cones.

    // On one lattice, from the square that contains the middle [spacings].
    double near_here[capacity], far_here[capacity];        ///< Slant ranges on it [m].
    double low_inverse[capacity], high_inverse[capacity];  ///< Inverse of the far and the near one [1/m].
    double base[2][capacity];                              ///< That square.
    double out[2][sides][capacity], end[sides][capacity];  ///< Half planes that contain the outline: out . place < end.
    double excess[capacity];                               ///< Of a curved side beyond its chord [m].
    double box_low[2][capacity], box_high[2][capacity];    ///< Box around the outline.
    double rows_are_u[capacity];                           ///< 1: rows of squares are counted along u, else along v.
    int32_t first[capacity], last[capacity], first_across[capacity], last_across[capacity];  ///< Rows of squares; ends.
    /** Ends of rows on the half planes, over their number. */
    double low[sides][capacity], low_slope[sides][capacity], high[sides][capacity], high_slope[sides][capacity];
    float middle_at[2][capacity];  ///< Place of the middle in its square [spacings].
    /** Change of the squared slant range from the middle, by u, v, uu, uv and vv. */
    float square[5][capacity];
    /** Components of the middle, and of u and v: up, aside and ahead of the middle's bearing [m]. */
    float up[3][capacity], aside[3][capacity], ahead[3][capacity];
    float amplitude[capacity];  ///< Factor of the square root of a power over the square of the range.
    float turns[capacity];      ///< Phase of the middle, two way.
};

/** Scatterers of the squares of a patch. */
struct LatticeScatterers {
    alignas(64) uint32_t bits[LatticeSquares::capacity];  ///< Random bits of the square.
    float size[LatticeSquares::capacity];   ///< Size of the field, in units of the square root of a whole cell.
    float turns[LatticeSquares::capacity];  ///< Phase of the two-way path.
    int32_t sum[LatticeSquares::capacity];  ///< Index of the sum of the real part; -1: outside the patch.
};

/** Scatterers inside of patches, and their fields. */
struct HeldScatterers {
    static constexpr int capacity = 2 * LatticeSquares::capacity, room = capacity + LatticeSquares::at_once;

    alignas(64) uint32_t bits[room];
    float size[room], turns[room];
    int32_t sum[room];
    float real[capacity], imaginary[capacity];
    int64_t real_quanta[capacity], imaginary_quanta[capacity];
    int count = 0;
};

/** The estimator of fields. Finds the scatterers on the surfaces that samples see, and adds their fields to each range
 *  cell of a beam (ACOUSTICS.md 5.21). */
class Scatterers {
public:
    static constexpr bool reports_truth = false;
    static constexpr Features features{Feature::Physical, Feature::Speckle};

    /** `sums`: EchoRules::sumCount() for each beam, [range cell][real, imaginary] in quanta, with sign. */
    Scatterers(const EchoRules& rules, std::span<const ObjectRecord> objects, uint64_t* sums)
        : rules_(rules), objects_(objects), sums_(sums) {}

    /** The next patches, which deposit() empties. */
    Patches patches;
    void deposit();

private:
    /** `begin`: slant range from which the level is used [m]. */
    void depositLevel(const LatticeLevel& level, double begin);
    /** Adds the squares of rows of patch i to the batch. */
    void addRows(int i, const LatticeLevel& level);
    /** Finds the scatterers of `count` squares of patch i. */
    void find(int i, const LatticeLevel& level, int count);
    /** Adds the fields of the scatterers that were found. */
    void add();

    const EchoRules& rules_;
    std::span<const ObjectRecord> objects_;
    uint64_t* sums_;
    LatticeFrame frame_;
    uint32_t frame_of_ = ~0u;  ///< The object of `frame_`.
    LatticePatches on_lattice_;
    LatticeSquares squares_;
    LatticeScatterers scatterers_;
    HeldScatterers held_;
};

}  // namespace insonify::sonar
