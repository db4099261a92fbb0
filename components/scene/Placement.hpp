#pragma once
#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>

#include "components/scene/Scene.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/text/Describe.hpp"
#include "types/text/Notice.hpp"

namespace insonify::scene {

/** The axis of a file that points up. */
enum class UpAxis { X, Y, Z };

/** The place of a scene in the world of the poses: x north, y west, z up. */
struct Placement {
    glm::dvec3 position{0};
    double yaw_deg = 0;
    types::WorldFrame frame = types::WorldFrame::AsIs;
    std::optional<UpAxis> up = {};
    std::optional<double> scale = {};

    bool operator==(const Placement&) const = default;

    static void describe(auto& self, auto& visit) {
        visit({"position", "m", "of the file's origin in the world: north, west, up", -1e7, 1e7}, self.position);
        visit({"yaw_deg", "deg", "turn of the scene about the vertical at its origin, positive from north to west",
               -360, 360},
              self.yaw_deg);
        visit({"frame", "",
               "axes in which the scene was made, its z being up: as_is: x north, y west; enu, as ROS has it: x "
               "east, y "
               "north; ned: x north, y east, z down"},
              self.frame);
        visit({"up", "", "axis of the file that points up; absent: y of glTF, that of .dae as it states it, else z"},
              self.up);
        visit({"scale", "1",
               "factor of all lengths of the file, such as 0.001 for one in millimetres; absent: 1; a large file "
               "without a unit gives a notice",
               1e-6, 1e6},
              self.scale);
    }
};

/** Returns the scene at another place. Meshes are shared. Nodes that poses move are affected by `up` alone. */
Scene placed(const Scene& scene, const Placement& placement);

/** Returns the scene with some nodes, and the nodes below them, scaled about their origins, which stay in place. Meshes
 *  are shared.
 *  @param factors by name of a node, above 0. Names that no node has are added to `diagnostics` as `scale.<name>`. */
Scene scaled(const Scene& scene, const std::map<std::string, double>& factors, types::Diagnostics& diagnostics);

/** Describes a scene's orientation: "the file's x is north, its -z west, its y up". `poses`: the axes of the poses as
 *  they are sent; the direction of their x is added if these axes are not the world's. */
std::string describeLay(const Scene& scene, const Placement& placement, types::WorldFrame poses);

/** Returns a warning if most of the surface of a file's scene faces along y and it is higher than it is wide in y: glTF
 *  that was written with z up, or OBJ, STL or PLY with y up, has its sea floor as a wall. Empty: it does not. */
std::string sideWarning(const types::Geometry& geometry, const std::filesystem::path& file);

/** Returns the question whether a scene of this size [m] is in millimetres, if its file (OBJ, STL, PLY) states no unit:
 *  a warning for a body larger than any ship, a notice for all else of 100 m or more. None: nothing to ask.
 *  @param remedy says what answers the question */
std::optional<types::Notice> askUnit(const std::filesystem::path& file, const glm::dvec3& size, const char* remedy);

}  // namespace insonify::scene

template <>
struct insonify::types::EnumNames<insonify::scene::UpAxis> {
    static constexpr std::string_view names[] = {"x", "y", "z"};
};
