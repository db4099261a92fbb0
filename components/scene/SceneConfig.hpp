#pragma once
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>

#include "components/scene/Acoustics.hpp"
#include "types/Pose.hpp"

namespace insonify::scene {

/** Where a sensor sits in the body: x forward, y left, z up; R = Rz(yaw) Ry(pitch) Rx(roll). */
struct Mount {
    glm::dvec3 position{0};                           ///< [m]
    double roll_deg = 0, pitch_deg = 0, yaw_deg = 0;  ///< Positive pitch looks down, positive yaw turns to port [deg].

    glm::dquat orientation() const;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"position", "m", "of the sensor in the body"}, self.position);
        visit(Field{"roll_deg", "deg", "about x", -360, 360}, self.roll_deg);
        visit(Field{"pitch_deg", "deg", "about y, positive looks down", -360, 360}, self.pitch_deg);
        visit(Field{"yaw_deg", "deg", "about z, positive turns to port", -360, 360}, self.yaw_deg);
    }
};

/** Pose of the sensor in the world, at the body's time; velocities stay unknown. */
void place(const types::Pose& body, const Mount& mount, types::Pose& sensor);

struct SceneConfig {
    std::string file;
    Mount mount;
    std::optional<double> water_surface;
    std::map<std::string, Acoustics> materials;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"file", "", "scene: .gltf, .glb, .world or .sdf, relative to the deployment"}, self.file);
        visit(Field{"mount", "", "the sonar in the body"}, self.mount);
        visit(Field{"water_surface", "m", "z of the water surface in the world; absent: none"}, self.water_surface);
        visit(Field{"materials", "", "acoustic values by name of a material or model, over those of the file"},
              self.materials);
    }
};

}  // namespace insonify::scene
