#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/scene/Acoustics.hpp"
#include "types/Mount.hpp"

namespace insonify::scene {

using types::Mount;

/** A point target: what gives an echo and is too small to be resolved, fixed in the world or on a node. */
struct TargetConfig {
    std::string name;
    std::optional<glm::dvec3> position;
    std::string attached_to;
    std::optional<double> strength_db;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"name", "", "of the target, which no other has"}, self.name);
        visit(Field{"position", "m",
                    "in the world; with attached_to in the node's axes, which are the world's where the node is not "
                    "turned, absent: the node's origin",
                    -1e7, 1e7},
              self.position);
        visit(Field{"attached_to", "", "node with which the target moves; absent: it stands still"}, self.attached_to);
        visit(Field{"strength_db", "dB re 1 m^2", "target strength, the same from all sides", -3000, 200},
              self.strength_db);
    }
    void check(types::Diagnostics& diagnostics) const;
};

struct SceneConfig {
    std::string file;
    Mount mount;
    std::optional<double> water_surface, pose_timeout, extrapolate;
    std::map<std::string, Acoustics> materials;
    std::vector<TargetConfig> targets;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"file", "", "scene: .gltf, .glb, .world or .sdf, relative to the deployment"}, self.file);
        visit(Field{"mount", "", "the sonar in the body"}, self.mount);
        visit(Field{"water_surface", "m", "z of the water surface in the world; absent: none"}, self.water_surface);
        visit(Field{"pose_timeout", "s",
                    "age of the newest pose, of the body and of each node that has a connection, from which there is "
                    "none; absent: 1 in realtime, else none",
                    1e-3, 1e6},
              self.pose_timeout);
        visit(
            Field{"extrapolate", "s",
                  "how far a sonar carries its pose on by its velocities to the time of its ping, at most; absent: it "
                  "is used as it is",
                  1e-3, 10},
            self.extrapolate);
        visit(Field{"materials", "", "acoustic values by name of a material or model, over those of the file"},
              self.materials);
        visit(Field{"targets", "", "point targets, heard by the active sonar equation; absent: none"}, self.targets);
    }
    void check(types::Diagnostics& diagnostics) const;
};

}  // namespace insonify::scene
