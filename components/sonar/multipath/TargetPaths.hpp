#pragma once
#include <array>
#include <deque>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/multipath/FlatMirrors.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/surfaces/Sightlines.hpp"
#include "components/sonar/surfaces/WallLaws.hpp"

namespace insonify::sonar {

/** Arrivals of sound through walls that ring, on a path out and back or one way. */
struct WallArrivals {
    EchoTrain both, once;
    double ringing = 1;  ///< Energy out and back relative to the square of that one way: resonances [1].

    bool areDelayed() const { return both.isDelayed() || once.isDelayed(); }
};

/** Sound on straight lines through thin walls with water behind them (ACOUSTICS.md 5.26). */
class WallSights {
public:
    static constexpr double min_passed = 1e-3;    ///< One way: 60 dB two-way [1].
    static constexpr double nearest_wall = 1e-4;  ///< Between two walls, with `same_wall` of their range [m].
    static constexpr double same_wall = 1e-5;     ///< [1]

    /** `plan` must outlive it. Without the pass of walls all surfaces hide. */
    explicit WallSights(const RenderPlan& plan);

    /** Returns the one-way share of the energy that passes from one point to another [1]; 0: hidden. `walls` counts the
     *  walls of the whole path, of which at most max_walls pass sound. `arrivals` continues with those of this line. */
    double passed(const Sightlines& sightlines, const glm::dvec3& from, const glm::dvec3& to, int& walls,
                  WallArrivals& arrivals);

private:
    double pass(const Sightlines::WallHit& hit, WallArrivals& arrivals) const;

    const RenderPlan& plan_;
    std::vector<bool> are_walls_;  ///< One for each material; empty: none is a wall.
    std::vector<Sightlines::WallHit> hits_;
};

/** One sound path between the sonar and a point. */
struct TargetPath {
    static constexpr size_t max_mirrors = MultipathConfig::max_bounces;

    double length = 0;                       ///< [m]
    glm::dvec3 direction{0};                 ///< Unit direction from the sonar, sonar axes [1].
    glm::dvec3 from_point{0};                ///< Unit direction from the point along the path, world axes [1].
    double power = 1;                        ///< Share of the sound's power after its mirrors and walls, one way [1].
    double ringing = 1;                      ///< As in WallArrivals [1].
    int reflections = 0;                     ///< Number of mirrors [1].
    int walls = 0;                           ///< Number of thin walls that the sound passes [1].
    bool by_surface = false;                 ///< Whether one of the mirrors is the water surface.
    double sine_grazing = 0;                 ///< Sine of the grazing angle at the water surface [1].
    const WallArrivals* arrivals = nullptr;  ///< Null: one without delay.
    /** Its mirrors, from the sonar: 1: the water surface, from 2: mirror triangles in the scene's order; 0: none. */
    std::array<uint32_t, max_mirrors> mirrors{};
};

/** All unobstructed sound paths between the sonar and points of the world (ACOUSTICS.md 5.23): the straight path, and
 *  those via the water surface and triangles of mirrors. Uses the image method, in double. */
class TargetPaths {
public:
    /** `geometry` must outlive it, and so must `walls`; null: all surfaces hide. */
    TargetPaths(const SonarConfig& config, const types::Geometry& geometry, WallSights* walls = nullptr);

    /** Places mirrors and objects; call it once per ping. Ignores paths longer than twice `range_max` [m]. */
    void place(const types::Snapshot& snapshot, double range_max);
    /** Returns the paths in the order of `TargetPath::mirrors`, the straight one first. They are valid until the next
     *  call. */
    const std::vector<TargetPath>& pathsTo(const glm::dvec3& point);

private:
    using Chain = std::span<const PlacedMirror* const>;

    void placeMirrors(const types::Snapshot& snapshot, double range_max);
    /** Adds the paths via one mirror, and computes the point's images. */
    void addByOne(const glm::dvec3& point);
    void addByTwo(const glm::dvec3& point);
    /** Returns whether a line to `image` may hit a mirror within its box. Both distances are from the mirror's plane,
     *  that of the image with inverted sign [m]. */
    bool mayMeet(const PlacedMirror& mirror, const glm::dvec3& from, double distance, const glm::dvec3& image,
                 double image_distance) const;
    /** Returns arrivals for one more path. */
    WallArrivals& newArrivals();
    /** Adds the path via the mirrors of a chain, if there is one. */
    void addPath(const glm::dvec3& point, Chain chain);
    /** Returns where the line from a stop to the image hits a mirror, and adds the mirror to the path. */
    std::optional<glm::dvec3> meet(const PlacedMirror& mirror, const glm::dvec3& from, const glm::dvec3& image,
                                   TargetPath& path) const;
    void addOnce(const TargetPath& path);

    int bounces_;
    FlatMirrors flat_;
    Sightlines sightlines_;
    WallSights* walls_;
    std::deque<WallArrivals> arrivals_;  ///< Arrivals by the paths through walls.
    size_t arrivals_count_ = 0;
    WaterMirror water_;
    std::vector<PlacedMirror> mirrors_;  ///< The water surface and all flat mirrors.
    MirrorReach reach_;
    bool has_reach_ = false;  ///< Whether reach_ is of this ping.

    std::vector<glm::dvec3> images_;  ///< The point's image in each mirror [m].
    std::vector<double> distances_;   ///< From each mirror's plane to the point [m].
    std::vector<TargetPath> paths_;
    glm::dvec3 sonar_{0};
    glm::dquat sonar_from_world_{1, 0, 0, 0};
    double longest_ = 0;  ///< [m]
    double doubt_ = 0;    ///< Bounds the rounding of places [m].
};

}  // namespace insonify::sonar
