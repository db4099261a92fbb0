#pragma once
// Paths to a point by mirrors, found without a search structure.
#include <algorithm>
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "components/sonar/multipath/Mirrors.hpp"
#include "components/sonar/multipath/TargetPaths.hpp"
#include "types/geometry/MeshRays.hpp"

namespace insonify::sonar {

/** Tries all sequences of up to two triangles, each with its own plane, and every leg against every triangle. */
class TriedPaths {
public:
    TriedPaths(const types::Snapshot& snapshot, bool by_surface, double longest)
        : snapshot_(snapshot), longest_(longest) {
        if (by_surface) mirrors_.push_back({{{0, 0, 1}, *snapshot.water_surface}, 1, {}, true});
        for (size_t object = 0; object < snapshot.geometry->objects.size(); ++object) addObject(object);
    }

    std::vector<TargetPath> to(const glm::dvec3& point) {
        paths_.clear();
        if (!mirrors_.empty() && mirrors_[0].is_surface && !(point.z < mirrors_[0].plane.distance)) return paths_;
        add(point, {});
        for (const Mirror& first : mirrors_) {
            add(point, {&first});
            for (const Mirror& second : mirrors_)
                if (&second != &first) add(point, {&first, &second});
        }
        return paths_;
    }

private:
    struct Mirror {
        MirrorPlane plane;
        double power;
        std::array<glm::dvec3, 3> corners;
        bool is_surface;
    };

    void addObject(size_t object) {
        const types::Geometry& geometry = *snapshot_.geometry;
        glm::dmat4 place = geometry.objects[object].world_from_object;
        for (const types::MovedObject& moved : snapshot_.moved)
            if (moved.object == object) place = moved.world_from_object;
        const types::Mesh& mesh = geometry.meshes[static_cast<size_t>(geometry.objects[object].mesh)];
        for (const types::Cluster& cluster : mesh.clusters)
            for (size_t i = cluster.first_index; i < cluster.first_index + cluster.index_count; i += 3) {
                const auto corner = [&](size_t k) {
                    return glm::dvec3(place * glm::dvec4(mesh.positions[mesh.indices[i + k]], 1));
                };
                const std::array corners{corner(0), corner(1), corner(2)};
                triangles_.push_back(corners);
                const types::Material& material = geometry.materials[static_cast<size_t>(cluster.material)];
                const glm::dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
                if (!material.mirror || !(glm::length(across) > 0)) continue;
                const glm::dvec3 normal = glm::normalize(across);
                mirrors_.push_back(
                    {{normal, glm::dot(normal, corners[0])}, reflectedPower(material, 2), corners, false});
            }
    }

    static bool holds(const Mirror& mirror, const glm::dvec3& point) {
        const auto& [a, b, c] = mirror.corners;
        const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
            return glm::dot(glm::cross(to - from, point - from), mirror.plane.normal) >= 0;
        };
        return mirror.is_surface || (inside(a, b) && inside(b, c) && inside(c, a));
    }

    bool isOpen(const glm::dvec3& from, const glm::dvec3& to) const {
        const double range = glm::distance(from, to);
        return std::ranges::none_of(triangles_, [&](const std::array<glm::dvec3, 3>& corners) {
            const auto met = types::meetTriangle(to - from, corners[0] - from, corners[1] - from, corners[2] - from);
            return met && met->share * range > Sightlines::nearest && (1 - met->share) * range > Sightlines::nearest;
        });
    }

    void add(const glm::dvec3& point, const std::vector<const Mirror*>& chain) {
        std::vector<glm::dvec3> images(chain.size() + 1, point);
        for (size_t k = chain.size(); k-- > 0;) images[k] = chain[k]->plane.image(images[k + 1]);
        const glm::dvec3& sonar = snapshot_.sonar.position;
        TargetPath path;
        path.length = glm::distance(sonar, images[0]);
        if (!(path.length > 0 && path.length <= longest_)) return;
        path.direction = glm::conjugate(snapshot_.sonar.orientation) * ((images[0] - sonar) / path.length);
        path.reflections = static_cast<int>(chain.size());
        glm::dvec3 from = sonar;
        for (size_t k = 0; k < chain.size(); ++k) {
            const Mirror& mirror = *chain[k];
            const double here = glm::dot(mirror.plane.normal, from) - mirror.plane.distance;
            const double there = glm::dot(mirror.plane.normal, images[k]) - mirror.plane.distance;
            if (!(here * there < 0)) return;
            const glm::dvec3 at = from + here / (here - there) * (images[k] - from);
            if (!holds(mirror, at) || !isOpen(from, at)) return;
            path.power *= mirror.power;
            path.by_surface |= mirror.is_surface;
            if (mirror.is_surface) path.sine_grazing = std::abs(here) / glm::distance(from, at);
            from = at;
        }
        if (isOpen(from, point)) paths_.push_back(path);
    }

    const types::Snapshot& snapshot_;
    double longest_;  ///< [m]
    std::vector<Mirror> mirrors_;
    std::vector<std::array<glm::dvec3, 3>> triangles_;
    std::vector<TargetPath> paths_;
};

}  // namespace insonify::sonar
