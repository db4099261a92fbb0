#pragma once
#include "components/sonar/rays/TileCells.hpp"

namespace insonify::sonar {

/** Places of a batch's cells in normal maps. Their cosines are computed together. */
class MappedCells {
public:
    /** Records the place of cell i: the hits' command, its triangle within the object's mesh, and barycentric
     *  coordinates of the triangle's second and third corner [1]. */
    void place(int i, uint32_t command, uint32_t triangle, float u, float v) {
        command_[i] = command;
        triangle_[i] = triangle;
        u_[i] = u;
        v_[i] = v;
    }
    /** Records that cell i hits nothing. */
    void placeMiss(int i) { command_[i] = TileHits::nothing; }

    /** Sets Cells::mapped of the cells from `first` to before `end` whose materials have maps. */
    void setCosines(const PlacedScene& scene, int first, int end, Cells& cells);

private:
    static_assert(Cells::capacity <= NormalMapping::max_samples);

    uint32_t command_[Cells::capacity], triangle_[Cells::capacity];
    float u_[Cells::capacity], v_[Cells::capacity];
    float x_[Cells::capacity], y_[Cells::capacity], z_[Cells::capacity];  ///< As in NormalMapping::Samples.
    float extent_[Cells::capacity], normal_[Cells::capacity];             ///< As in NormalMapping::Samples.
};

}  // namespace insonify::sonar
