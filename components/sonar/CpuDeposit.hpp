#pragma once
#include "components/sonar/BinDeposit.hpp"
#include "components/sonar/ThreadPool.hpp"

namespace insonify::sonar {

/** The deposit on the processor: reads the pictures back; each thread owns a run of beams, so none waits for another.
 */
class CpuDeposit final : public BinDeposit {
public:
    CpuDeposit(DepositSetup setup, const SurfacePass& surface, ThreadPool& threads);
    void take(size_t slab, const SurfacePass& surface) override;
    std::span<const uint64_t> finish() override;

    /** How the planes of one run of triangles are turned from object axes into those of a slab. */
    struct Run {
        double normal_x[3], normal_y[3], normal_z[3], origin[3];  ///< Rows of the normals' matrix; origin, slab axes [m].
        double near_limit, far_limit;                             ///< Inverse ranges of the object [1/m].
        double strength;                                          ///< Of the material at normal incidence.
        uint32_t first_triangle;
    };
    /** A slab's picture and what its numbers mean, copied when taken. */
    struct Picture {
        std::vector<uint32_t> words;
        std::vector<Run> runs;
        bool taken = false;
    };

private:
    void depositBeams(uint32_t first, uint32_t last);
    void depositSlab(size_t slab, uint32_t first, uint32_t last);

    DepositSetup setup_;
    ThreadPool& threads_;
    std::vector<double> edges_;
    const std::vector<vec4>& planes_;
    size_t channels_;
    std::vector<Picture> pictures_;
    std::vector<uint64_t> sums_;
};

}  // namespace insonify::sonar
