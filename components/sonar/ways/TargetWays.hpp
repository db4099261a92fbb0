#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/places/Sightlines.hpp"
#include "components/sonar/ways/MirrorReach.hpp"

namespace insonify::sonar {

/** One way between the sonar and a point. */
struct TargetWay {
    static constexpr size_t max_mirrors = MultipathConfig::max_bounces;

    double length = 0;         ///< [m]
    glm::dvec3 direction{0};   ///< From the sonar, unit, its axes [1].
    glm::dvec3 from_point{0};  ///< From the point to where the way leads first, unit, world axes [1].
    double power = 1;          ///< What its mirrors leave of the sound [1].
    int reflections = 0;       ///< In mirrors [1].
    bool by_surface = false;   ///< One of them is the water surface.
    double sine_grazing = 0;   ///< At which it is met there [1].
    /** Its mirrors, from the sonar on: 1 is the water surface, from 2 on mirror triangles in the order of the scene;
     *  0: none. */
    std::array<uint32_t, max_mirrors> mirrors{};
};

/** All ways between the sonar and points of the world that nothing hides: the straight one, and those by way of the
 *  water surface and of triangles of mirrors (ACOUSTICS.md 5.23), by the image method, in double. */
class TargetWays {
public:
    /** `geometry` must outlive it. */
    TargetWays(const SonarConfig& config, const types::Geometry& geometry);

    /** Once a ping. Ways longer than twice `range_max` [m] are not looked for. */
    void place(const types::Snapshot& snapshot, double range_max);
    /** Returns the ways in the order of `TargetWay::mirrors`, the straight one first. They are valid until the next
     *  call. */
    const std::vector<TargetWay>& waysTo(const glm::dvec3& point);

private:
    using Chain = std::span<const PlacedMirror* const>;

    void placeMirrors(const types::Snapshot& snapshot, double range_max);
    /** Takes the point's images as well. */
    void addByOne(const glm::dvec3& point);
    void addByTwo(const glm::dvec3& point);
    /** Whether a line may meet a mirror within its box on the way to `image`. Both distances are from the mirror's
     *  plane, that of the image with its sign turned [m]. */
    bool mayMeet(const PlacedMirror& mirror, const glm::dvec3& from, double distance, const glm::dvec3& image,
                 double image_distance) const;
    /** Adds the way by the mirrors of a chain, if there is one. */
    void addWay(const glm::dvec3& point, Chain chain);
    /** Returns where the line from a stop to the image meets a mirror, and takes the mirror into the way. */
    std::optional<glm::dvec3> meet(const PlacedMirror& mirror, const glm::dvec3& from, const glm::dvec3& image,
                                   TargetWay& way) const;
    void addOnce(const TargetWay& way);

    int bounces_;
    FlatMirrors flat_;
    Sightlines sightlines_;
    WaterMirror water_;
    std::vector<PlacedMirror> mirrors_;  ///< The water surface and all flat mirrors.
    MirrorReach reach_;
    bool has_reach_ = false;  ///< In this ping.

    std::vector<glm::dvec3> images_;  ///< The point's image in each mirror [m].
    std::vector<double> distances_;   ///< From each mirror's plane to the point [m].
    std::vector<TargetWay> ways_;
    glm::dvec3 sonar_{0};
    glm::dquat sonar_from_world_{1, 0, 0, 0};
    double longest_ = 0;  ///< [m]
    double doubt_ = 0;    ///< Bounds the rounding of places [m].
};

}  // namespace insonify::sonar
