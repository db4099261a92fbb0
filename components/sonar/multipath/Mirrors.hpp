#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "components/sonar/plan/RenderPlan.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** The plane n.p = D. */
struct MirrorPlane {
    glm::dvec3 normal{0};  ///< Unit [1].
    double distance = 0;   ///< [m]

    glm::dvec3 turned(const glm::dvec3& direction) const {
        return direction - 2 * glm::dot(normal, direction) * normal;
    }
    glm::dvec3 image(const glm::dvec3& place) const {
        return place - 2 * (glm::dot(normal, place) - distance) * normal;
    }
};

/** Returns the share of the sound that a material reflects specularly, with up to `bounces` reflections per path [1].
 *  It is above 0 for a material declared as mirror, and with two or more reflections for a smooth material without
 *  shell (ACOUSTICS.md 5.23). */
double reflectedPower(const types::Material& material, int bounces);

/** Returns the max number of reflections of one path; 0: there are no paths by mirrors [1]. */
int countBounces(const SonarConfig& config);

/** Returns the mean square slope of a sea surface in a wind [m/s], the sum of both directions; 0 without wind [1].
 *  ACOUSTICS.md 5.24. */
double slopeOfSea(double wind);

/** Returns the share of a pressure that a sea surface reflects specularly, in phase; the rest is scattered. It depends
 *  on the rms height in the wind [m/s], the wavelength [m] and the sine of the grazing angle [1]. ACOUSTICS.md 5.24. */
double coherentReflection(double wind, double wavelength, double sine_grazing);

/** The water surface of one ping, from below. */
class WaterMirror {
public:
    explicit WaterMirror(const SonarConfig& config);

    /** Places the surface; call it once per ping. */
    void place(const types::Snapshot& snapshot, double range_max);
    /** Returns whether it reflects in this ping. */
    bool reflects() const { return reflects_; }
    /** Returns its plane in sonar axes; the normal is up. */
    const MirrorPlane& plane() const { return plane_; }
    /** Returns its distance along a direction from a place, sonar axes, in lengths of the direction; infinite where it
     *  is not ahead. */
    double distance(const glm::dvec3& from, const glm::dvec3& direction) const;
    /** Returns a facet about `at` that the wind has tilted, facing sound that travels along `direction`; `key`
     * identifies the facet in the ping. Flat without wind. */
    MirrorPlane facet(const glm::dvec3& at, const glm::dvec3& direction, uint64_t key) const;
    /** Returns why it does not reflect in this ping; none where it does, or is not configured to. */
    std::optional<Omitted> omissions() const { return omitted_; }

private:
    bool wanted_;
    double slope_;  ///< Rms slope in one direction [1].
    uint64_t ping_ = 0;
    bool reflects_ = false;
    MirrorPlane plane_;
    std::optional<Omitted> omitted_;
};

/** The mirrors that a ray has hit, in order, and what walls and mirrors have left of it. */
struct MirrorChain {
    static constexpr int max_bounces = MultipathConfig::max_bounces;

    int count = 0;
    std::array<uint64_t, max_bounces> names{};  ///< Equal for all rays that hit the same mirror.
    std::array<MirrorPlane, max_bounces> planes;
    double power = 1;           ///< Share of the power after the mirrors, one way [1].
    double passed = 1;          ///< Share of the power after the walls, one way [1].
    double widest = 0;          ///< Max contribution of a mirror's facet to a mean square slope, over its cosine [1].
    bool begins_lobed = false;  ///< Whether the first mirror has a lobe.
    int walls = 0;              ///< Thin walls that the ray has passed [1].
    uint64_t wall_names = 0;    ///< Equal for all rays that pass the same walls.
    bool was_in_fill = false;   ///< Whether the ray has been in a fluid other than water.

    bool sameAs(const MirrorChain& other) const {
        return count == other.count && wall_names == other.wall_names &&
               std::equal(names.begin(), names.begin() + count, other.names.begin());
    }
    glm::dvec3 image(glm::dvec3 place) const {
        for (int k = count; k-- > 0;) place = planes[static_cast<size_t>(k)].image(place);
        return place;
    }
    glm::dvec3 turned(glm::dvec3 direction) const {
        for (int k = count; k-- > 0;) direction = planes[static_cast<size_t>(k)].turned(direction);
        return direction;
    }
    /** Inverts turned(). */
    glm::dvec3 turnedBack(glm::dvec3 direction) const {
        for (int k = 0; k < count; ++k) direction = planes[static_cast<size_t>(k)].turned(direction);
        return direction;
    }
};

}  // namespace insonify::sonar
