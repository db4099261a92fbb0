#pragma once
#include <vector>

#include "components/sonar/Mirrors.hpp"
#include "components/sonar/Sightlines.hpp"

namespace insonify::sonar {

/** One way between the sonar and a point. */
struct TargetWay {
    double length = 0;        ///< [m]
    glm::dvec3 direction{0};  ///< From the sonar, unit, its axes [1].
    double power = 1;         ///< What its mirrors leave of the sound [1].
    int reflections = 0;      ///< In mirrors [1].
    bool by_surface = false;  ///< One of them is the water surface.
    double sine_grazing = 0;  ///< At which it is met there [1].
};

/** All ways between the sonar and points of the world that nothing hides: the straight one, and those by way of the
 *  water surface and of triangles of mirrors (ACOUSTICS.md 5.23), by the image method, in double. */
class TargetWays {
public:
    /** `geometry` must outlive it. */
    TargetWays(const SonarConfig& config, const types::Geometry& geometry);

    /** Once a ping. Ways longer than twice `range_max` [m] are not looked for. */
    void place(const types::Snapshot& snapshot, double range_max);
    /** Valid until it is asked for another's. */
    const std::vector<TargetWay>& waysTo(const glm::dvec3& point);

private:
    /** A triangle that reflects, or with no corners the water surface; world axes. */
    struct Mirror {
        MirrorPlane plane;
        double power = 1;
        glm::dvec3 a{0}, b{0}, c{0};
        bool is_surface = false;

        bool holds(const glm::dvec3& point) const;
    };
    /** Where one is in its mesh. */
    struct Source {
        size_t object, first_index;
        double power;
    };
    void placeMirrors(const types::Snapshot& snapshot, double range_max);
    /** Adds the way by the mirrors of `chain_`, where there is one, and those by one more. */
    void follow(const glm::dvec3& point, int bounces);
    void addWay(const glm::dvec3& point);

    const types::Geometry& geometry_;
    int bounces_;
    Sightlines sightlines_;
    WaterMirror water_;
    std::vector<Source> sources_;
    std::vector<Mirror> mirrors_;       ///< In this ping.
    std::vector<const Mirror*> chain_;  ///< From the sonar on.
    std::vector<TargetWay> ways_;
    glm::dvec3 sonar_{0};
    glm::dquat sonar_from_world_{1, 0, 0, 0};
    double longest_ = 0;  ///< [m]
};

}  // namespace insonify::sonar
