#pragma once
#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/echo/MaterialLaws.hpp"
#include "types/Snapshot.hpp"

namespace insonify::study {

/** All triangles of a snapshot as they lie there, and which of them a ray meets first. Embree finds it in float, about
 *  the sonar's place in that snapshot; whatever else is known of a triangle is in double. No levels of detail. */
class RayTree {
public:
    static constexpr int packet = 16;
    static constexpr size_t packets_at_once = 4;
    static constexpr uint32_t none = ~0u;  ///< Instead of a triangle: a miss.

    struct Triangle {
        glm::dvec3 normal;  ///< Unit, axes of the world; 0 where its corners lie on a line [1].
        double distance;    ///< normal.p of its points p about the origin [m].
        double mu;          ///< Its Lambert parameter [1].
        bool mapped;        ///< Its material has a normal map.
        int material;
    };
    /** Directions in the axes of the world, of any length; what is nearer than so many lengths is not met. */
    struct Rays {
        alignas(64) float x[packet], y[packet], z[packet], nearest[packet];
        void set(int i, const glm::dvec3& direction, double nearest_met = 0);
    };
    using Found = std::array<uint32_t, packet>;

    /** Throws std::runtime_error when Embree cannot build it. */
    explicit RayTree(const types::Snapshot& scene);
    ~RayTree();
    RayTree(const RayTree&) = delete;
    RayTree& operator=(const RayTree&) = delete;

    /** The first triangle on each ray from a point about the origin, of at most `packets_at_once` packets. All rays of
     *  a call should lie close together. */
    void cast(glm::dvec3 from, std::span<const Rays> rays, std::span<Found> found) const;

    /** Materials give back what they do to a sonar of this configuration; Lambert's law before that. Nothing is done
     *  for one that materials are the same to as to the last. */
    void takeLaws(const sonar::SonarConfig& config);
    /** sigma_b / cos(theta) of a triangle that is met along a unit direction, axes of the world, at a range [1, m]. */
    double backscatter(uint32_t triangle, double cosine, const glm::dvec3& direction, double range) const {
        const Triangle& plane = triangles_[triangle];
        if (laws_.records.empty()) return plane.mu * cosine;
        const auto material = static_cast<size_t>(plane.material);
        return laws_.overCosine(material, cosine, lobeSlopes(triangle, cosine, direction, range));
    }

    /** sigma_b over the cosine of one way, of sound that comes or goes at the other [1]; `middle`: of the two
     * directions, unit, axes of the world, at half of the way out and back [m]. ACOUSTICS.md 5.23. */
    double bistatic(uint32_t triangle, double cosine, double other, const glm::dvec3& middle, double range) const;

    /** Whether a material has a lobe, for which directions and ranges matter. */
    bool hasLobes() const { return !facets_.empty(); }
    const glm::dvec3& origin() const { return origin_; }  ///< In the world [m].
    const Triangle& operator[](uint32_t triangle) const { return triangles_[triangle]; }
    /** The object that a triangle is part of: index into the geometry's [1]. */
    uint32_t objectOf(uint32_t triangle) const { return sources_[triangle].object; }

    /** Cosine between a unit direction and the mapped normal at a point of a mapped triangle (about the origin), as
     *  glTF has it: normal, tangent and uv of the corners by the point's weights, the map bilinear without mipmaps; at
     *  least 1e-6, either side. */
    double mappedCosine(uint32_t triangle, glm::dvec3 point, glm::dvec3 direction) const;

private:
    sonar::LobeSlopes lobeSlopes(uint32_t triangle, double cosine, const glm::dvec3& direction, double range) const;

    struct Embree;
    /** Where a triangle comes from. */
    struct Source {
        uint32_t object, first_index;
        int material;
    };
    /** What laws depend on of a sonar. */
    struct Hearer {
        sonar::Model model;
        std::optional<double> frequency_khz;
        double speed_of_sound;
        bool operator==(const Hearer&) const = default;
    };
    struct Place {
        glm::dmat4 origin_from_object;
        glm::dmat3 normals;
    };
    void add(uint32_t object, std::vector<glm::dvec3>& corners);
    /** About the origin [m]. */
    std::array<glm::dvec3, 3> cornersOf(const Source& source) const;

    types::GeometryPtr geometry_;
    glm::dvec3 origin_;
    std::vector<Place> places_;  ///< Of each object.
    std::vector<Triangle> triangles_;
    std::vector<sonar::FacetRecord> facets_;  ///< Of each triangle, its axis in the world; empty without lobes.
    std::vector<Source> sources_;             ///< Of each triangle.
    sonar::MaterialLaws laws_;                ///< None where all follow Lambert's.
    std::optional<Hearer> heard_by_;
    std::unique_ptr<Embree> embree_;
};

}  // namespace insonify::study
