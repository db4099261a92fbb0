#pragma once
#include <map>
#include <optional>
#include <string>

#include "components/scene/Acoustics.hpp"
#include "types/Mount.hpp"

namespace insonify::scene {

using types::Mount;

struct SceneConfig {
    std::string file;
    Mount mount;
    std::optional<double> water_surface, pose_timeout, extrapolate;
    std::map<std::string, Acoustics> materials;

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
    }
};

}  // namespace insonify::scene
