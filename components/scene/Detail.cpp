#include "components/scene/Detail.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <future>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <span>
#include <thread>

#include "components/scene/Clusters.hpp"

namespace insonify::scene {
namespace {

using Indices = std::vector<uint32_t>;

constexpr size_t kKept = 4;  ///< One triangle in so many is kept from level to level.

/** Distance of a point from a triangle: C. Ericson, Real-Time Collision Detection, 5.1.5. */
double distanceTo(glm::dvec3 p, const std::array<glm::vec3, 3>& corners) {
    const glm::dvec3 t[] = {corners[0], corners[1], corners[2]};  // thin triangles take more digits than float has
    const glm::dvec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], bp = p - t[1], cp = p - t[2];
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp),
                 d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return glm::length(ap);
    if (d3 >= 0 && d4 <= d3) return glm::length(bp);
    if (d6 >= 0 && d5 <= d6) return glm::length(cp);
    const double a = d3 * d6 - d5 * d4, b = d5 * d2 - d1 * d6, c = d1 * d4 - d3 * d2;
    if (c <= 0 && d1 >= 0 && d3 <= 0) return glm::length(ap - ab * (d1 / (d1 - d3)));
    if (b <= 0 && d2 >= 0 && d6 <= 0) return glm::length(ap - ac * (d2 / (d2 - d6)));
    if (a <= 0 && d4 >= d3 && d5 >= d6) return glm::length(bp - (t[2] - t[1]) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    const double sum = a + b + c;
    return sum > 0 ? glm::length(ap - ab * (b / sum) - ac * (c / sum)) : glm::length(ap);
}

/** The triangles that stand for a patch, for distances from them. */
class StandIn {
public:
    StandIn(const types::Mesh& mesh, const Indices& indices) {
        for (size_t i = 0; i + 2 < indices.size(); i += 3) {
            Triangle t{};
            for (size_t k = 0; k < 3; ++k) {
                t.corners[k] = mesh.positions[indices[i + k]];
                t.reach = std::max(t.reach, glm::distance(t.corners[0], t.corners[k]));
            }
            triangles_.push_back(t);
        }
    }

    /** Distance of a point, or some smaller number than `enough` where it is less. */
    float distance(glm::vec3 point, float enough) const {
        float least = std::numeric_limits<float>::max();
        for (const Triangle& t : triangles_) {
            if (glm::distance(point, t.corners[0]) - t.reach >= least) continue;
            least = std::min(least, static_cast<float>(distanceTo(point, t.corners)));
            if (least < enough) break;
        }
        return least;
    }

private:
    struct Triangle {
        std::array<glm::vec3, 3> corners;
        float reach;
    };
    std::vector<Triangle> triangles_;
};

bool holds(const types::Patch& patch, glm::vec3 point) {
    return glm::all(glm::lessThanEqual(glm::abs(point - patch.centre), patch.half));
}

/** Does job(0) to job(count - 1), on all cores; throws what a job has thrown. */
template <class Job>
void inParallel(size_t count, const Job& job) {
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        for (size_t i = next++; i < count; i = next++) job(i);
    };
    std::vector<std::future<void>> helpers;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
        helpers.push_back(std::async(std::launch::async, work));
    work();
    for (std::future<void>& helper : helpers) helper.get();
}

/** Finds what stands for the patches of a mesh. */
class Simplifier {
public:
    explicit Simplifier(types::Mesh& mesh) : mesh_(mesh), stand_ins_(mesh.patches.size()), ranks_(mesh.patches.size()) {
        for (size_t i = ranks_.size(); i-- > 0;)
            forParts(i, [&](size_t part) { ranks_[i] = std::max(ranks_[i], ranks_[part] + 1); });
    }

    void run() {
        for (size_t root = 0; root < mesh_.patches.size(); root = mesh_.patches[root].next)
            shareOut(root, levels(root));
        std::vector<float> deviations(stand_ins_.size());
        inParallel(deviations.size(), [&](size_t i) { deviations[i] = deviation(i); });
        for (size_t i = deviations.size(); i-- > 0;) {
            float below = 0;
            forPartsOfParts(i, [&](size_t part) { below = std::max(below, mesh_.patches[part].deviation); });
            mesh_.patches[i].deviation = deviations[i] + below;
        }
        for (size_t i = 0; i < stand_ins_.size(); ++i) store(mesh_.patches[i], stand_ins_[i]);
    }

private:
    template <class Job>
    void forParts(size_t patch, const Job& job) const {
        for (size_t part = patch + 1; part < mesh_.patches[patch].next; part = mesh_.patches[part].next) job(part);
    }

    /** Two levels down: what deviates there adds little to a deviation from it. */
    template <class Job>
    void forPartsOfParts(size_t patch, const Job& job) const {
        forParts(patch, [&](size_t part) { forParts(part, job); });
    }

    /** All fine triangles of a patch. */
    std::span<const uint32_t> fine(const types::Patch& patch) const {
        const types::Cluster &first = mesh_.clusters[patch.first_cluster],
                             &last = mesh_.clusters[patch.first_cluster + patch.cluster_count - 1];
        return std::span(mesh_.indices)
            .subspan(first.first_index, last.first_index + last.index_count - first.first_index);
    }

    /** All of a tree of patches with a quarter of the triangles, a quarter of those, and so on; one level for each
     * rank, empty where it cannot be had. Open borders stay, so that nothing opens towards another mesh or material. */
    std::vector<Indices> levels(size_t root) const {
        std::vector<Indices> all;
        std::span<const uint32_t> finer = fine(mesh_.patches[root]);
        while (all.size() <= ranks_[root]) {
            Indices coarser(finer.size());
            coarser.resize(meshopt_simplify(coarser.data(), finer.data(), finer.size(), &mesh_.positions[0].x,
                                            mesh_.positions.size(), sizeof(glm::vec3), finer.size() / (3 * kKept) * 3,
                                            1.0f, meshopt_SimplifyLockBorder, nullptr));
            if (2 * coarser.size() > finer.size()) coarser.clear();
            finer = all.emplace_back(std::move(coarser));
        }
        return all;
    }

    /** Gives each patch at and below `patch` the triangles of its level that reach into its box. What two patches have
     *  in common closes the gaps that levels side by side would leave. */
    void shareOut(size_t patch, const std::vector<Indices>& levels) {
        std::vector<Indices> within(ranks_[patch] + 1);
        for (size_t rank = 0; rank < within.size(); ++rank) within[rank] = reaching(mesh_.patches[patch], levels[rank]);
        forParts(patch, [&](size_t part) { shareOut(part, within); });
        stand_ins_[patch] = std::move(within.back());
    }

    Indices reaching(const types::Patch& patch, const Indices& indices) const {
        Indices result;
        for (size_t i = 0; i + 2 < indices.size(); i += 3) {
            const glm::vec3 a = mesh_.positions[indices[i]], b = mesh_.positions[indices[i + 1]],
                            c = mesh_.positions[indices[i + 2]];
            const glm::vec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
            if (glm::all(glm::lessThanEqual(low, patch.centre + patch.half)) &&
                glm::all(glm::greaterThanEqual(high, patch.centre - patch.half)))
                result.insert(result.end(), &indices[i], &indices[i] + 3);
        }
        return result;
    }

    /** Largest distance of a vertex of the level but one below from what stands for a patch. */
    float deviation(size_t patch) const {
        const StandIn stand_in(mesh_, stand_ins_[patch]);
        float largest = 0;
        const auto take = [&](std::span<const uint32_t> indices) {
            Indices vertices(indices.begin(), indices.end());
            std::ranges::sort(vertices);
            vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
            for (uint32_t vertex : vertices)
                if (holds(mesh_.patches[patch], mesh_.positions[vertex]))
                    largest = std::max(largest, stand_in.distance(mesh_.positions[vertex], largest));
        };
        if (ranks_[patch] <= 1) take(fine(mesh_.patches[patch]));
        forParts(patch, [&](size_t part) {
            if (ranks_[patch] > 1 && ranks_[part] == 0) take(fine(mesh_.patches[part]));
        });
        forPartsOfParts(patch, [&](size_t part) { take(stand_ins_[part]); });
        return largest;
    }

    void store(types::Patch& patch, Indices& indices) {
        patch.first_index = static_cast<uint32_t>(mesh_.coarse_indices.size());
        patch.index_count = static_cast<uint32_t>(indices.size());
        orderTriangles(indices);
        mesh_.coarse_indices.insert(mesh_.coarse_indices.end(), indices.begin(), indices.end());
    }

    types::Mesh& mesh_;
    std::vector<Indices> stand_ins_;
    std::vector<size_t> ranks_;  ///< How many levels of patches lie below each.
};

}  // namespace

void simplifyPatches(types::Mesh& mesh) { Simplifier(mesh).run(); }

}  // namespace insonify::scene
