#pragma once
#include <array>

#include "components/gpu/ReadBack.hpp"
#include "components/sonar/BinDeposit.hpp"
#include "components/sonar/TruthTable.hpp"
#include "components/sonar/Volume.hpp"

namespace insonify::sonar {

/** How the triangles of one draw are turned from object axes into those of a frustum. */
struct PlacedRun {
    double normal_x[3], normal_y[3], normal_z[3];  ///< Rows of the normals' matrix [1].
    double eye[3];                                 ///< The sonar's place in object axes [m].
    double near_limit, far_limit;                  ///< Inverse ranges of the object [1/m].
    double strength;                               ///< Of the material at normal incidence [1].
    uint32_t first_triangle;                       ///< Of the mesh, among all planes [1].
    uint32_t material;                             ///< Its law in EchoRules::laws [1].
};

/** Of a command for an object. `cosine`, `sine`: of the azimuth of the frustum's axis, from the sonar's. */
PlacedRun placedRun(const ObjectRecord& object, const CommandRecord& command, const EchoRules& rules, double cosine,
                    double sine);

/** A frustum's picture on its way from the device, and what its numbers mean. */
struct TakenPicture {
    gpu::ReadBack words;
    const uint32_t* pixels = nullptr;  ///< Once they are here: `channels` words each, row by row from below.
    size_t channels = 2;               ///< Words a pixel [1].
    std::vector<PlacedRun> ranges;
    std::vector<uint32_t> objects;  ///< Of the ranges, where the truth is wanted.
    WaterView water;
    bool taken = false;
};

/** What one thread deposits of one frustum: the beams [first, last). */
struct FrustumPart {
    const EchoRules& rules;
    const ViewFrustum& frustum;
    const ColumnShares& shares;
    const TakenPicture& picture;
    const std::vector<PlaneRecord>& planes;
    uint32_t first, last;        ///< Beams [1].
    std::array<int, 2> columns;  ///< From, to: those that these beams touch [1].
};

/** Adds the part's echoes to `sums`, EchoRules::sumCount() for each beam. */
void deposit(const FrustumPart& part, uint64_t* sums);

/** The same sums, and what they are of. */
void depositAndTell(const FrustumPart& part, uint64_t* sums, const TruthSink& truth);

/** What is compiled into the deposit of pictures that has these features. */
Features compiledForPictures(const Features& wanted);

}  // namespace insonify::sonar
