#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/base/MadeAhead.hpp"
#include "components/sonar/rays/SceneTrees.hpp"

namespace insonify::sonar {

/** Returns the origin about which the scene has its trees, for a place of the sonar: the nearest point of a grid of
 *  512 m, so at most 444 m away, where float resolves 0.03 mm. It depends on nothing else, so that pings are
 *  independent of pings before [m]. */
glm::dvec3 originNear(const glm::dvec3& sonar);

/** Returns objects at their places about an origin [m]. */
std::vector<TreeObject> objectsAbout(const std::vector<TreeObject>& in_world, const glm::dvec3& origin);

/** Builds the trees of the objects at rest about the origins that a moving sonar may need next, by MadeAhead, and keeps
 *  them: up to eight, where the sonar is near a corner of the cells about origins. */
class TreesAhead {
public:
    using Objects = std::shared_ptr<const std::vector<TreeObject>>;

    static constexpr double near = 32;  ///< Distance from the cell of an origin at which its tree is built [m].
    static constexpr double kept = 64;  ///< Max distance at which it is kept [m].
    static constexpr size_t max_origins = 8;
    /** Max triangles of all trees, unless two trees alone have more [1]. */
    static constexpr size_t max_triangles = 16'000'000;

    /** Follows a sonar through the objects at rest, at their places in the world; the list must not change. A sonar
     *  that jumps further than `near`, or rests in new objects, needs nothing, and what it needed is given up. Returns
     * whether other origins are needed now, for send(). */
    bool follow(const glm::dvec3& sonar, const Objects& objects);
    /** Has the trees of the origins built. Does not wait. */
    void send();
    /** Whether an origin is needed. */
    bool needs(const glm::dvec3& origin) const;
    /** Returns whether all trees are built. */
    bool isDone() const { return ahead_.isDone(); }

private:
    struct Origins {
        std::array<glm::dvec3, max_origins> all;
        size_t count = 0;

        std::span<const glm::dvec3> needed() const { return std::span(all).first(count); }
    };
    /** Returns the origins of the cells near the sonar, the nearest first; none where it is near its own only, whose
     *  tree is in use. */
    Origins originsAround(const glm::dvec3& sonar) const;
    void takeObjects(const Objects& objects);

    Objects objects_;
    size_t max_count_ = 0;  ///< Max number of origins, by the triangles of the objects.
    int64_t version_ = 0;   ///< Number of different lists of objects so far.
    Origins origins_;
    std::optional<glm::dvec3> before_;  ///< Place of the sonar in the ping before.
    MadeAhead ahead_{"trees ahead"};
};

}  // namespace insonify::sonar
