#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/scene/Acoustics.hpp"
#include "components/scene/GazeboWorld.hpp"
#include "components/scene/Placement.hpp"
#include "components/scene/Scene.hpp"
#include "components/scene/SurfaceMaps.hpp"
#include "components/scene/motion/Animator.hpp"
#include "types/geometry/Datum.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::scene {

using types::Mount;

/** A point target: an object that gives an echo and is too small to be resolved, fixed in the world or on a node. */
struct TargetConfig {
    std::string name;
    std::optional<glm::dvec3> position;
    std::string attached_to;
    std::optional<double> strength_db;
    std::optional<types::Datum> geodetic = {};

    static void describe(auto& self, auto& visit) {
        visit({"name", "", "of the target, unique"}, self.name);
        visit({"position", "m",
               "in the world; with attached_to in the node's axes, which are the world's where the node is not "
               "turned, absent: the node's origin",
               -1e7, 1e7},
              self.position);
        visit({"geodetic", "", "place on the earth, in place of position; it needs a datum"}, self.geodetic);
        visit({"attached_to", "", "node with which the target moves; absent: it is fixed"}, self.attached_to);
        visit({"strength_db", "dB re 1 m^2", "target strength, the same from all sides", -3000, 200}, self.strength_db);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** A mosaic on the floor of a survey: strengths or classes on the same map. */
struct MosaicConfig {
    std::string file;
    int band = 1;
    MapValues meaning;

    static void describe(auto& self, auto& visit) {
        visit({"file", "", "strengths or classes on the same map as the survey, in a format of surveys"}, self.file);
        visit({"band", "1", "of the file", 1, 1000}, self.band);
        MapValues::describe(self.meaning, visit);
    }
    void check(types::Diagnostics& diagnostics) const;
    bool operator==(const MosaicConfig&) const = default;
};

/** The sea floor of a survey, read around the vehicle as it moves. */
struct BathymetryConfig {
    std::string file;
    std::optional<double> easting, northing;
    int band = 1, tile = 64;
    bool positive_down = false;
    double reach = 200;
    std::optional<MosaicConfig> map;

    static void describe(auto& self, auto& visit) {
        visit({"file", "",
               "elevations on a map: GeoTIFF, BAG, netCDF, ESRI .flt, ENVI, Erdas .img, or a mosaic of "
               "them (.vrt)"},
              self.file);
        visit({"easting", "m",
               "of the world's zero on the map, in place of a datum; both absent: the middle of the survey", -1e8, 1e8},
              self.easting);
        visit({"northing", "m",
               "of the world's zero on the map, in place of a datum; both absent: the middle of the survey", -1e8, 1e8},
              self.northing);
        visit({"band", "1", "of the file", 1, 1000}, self.band);
        visit({"positive_down", "", "true: the file has depths; false: elevations"}, self.positive_down);
        visit({"reach", "m", "min distance around the vehicle to which the floor reaches: the sonar's range", 1, 1e5},
              self.reach);
        visit({"tile", "1", "posts of a tile along each side: the floor is read by tiles", 1, 2048}, self.tile);
        visit({"map", "", "map of the floor's echo strength or material; absent: the same everywhere"}, self.map);
    }
    void check(types::Diagnostics& diagnostics) const;
};

struct SceneConfig {
    std::string file;
    std::optional<GazeboConfig> gazebo;
    std::optional<BathymetryConfig> bathymetry;
    std::optional<types::Datum> datum;
    std::optional<Placement> placement;
    std::map<std::string, double> scale;
    Mount mount;
    std::optional<double> water_surface, pose_timeout, extrapolate;
    std::vector<std::string> omit = {};
    bool omit_drawings = true;
    std::map<std::string, Acoustics> materials;
    bool materials_by_name = true;
    std::vector<TargetConfig> targets;
    AnimationConfigs animations;

    static void describe(auto& self, auto& visit) {
        visit({"file", "", sceneFileMeaning()}, self.file);
        visit({"gazebo", "",
               "a world that Gazebo runs, whose models are the scene, in the place of file; absent: what file has"},
              self.gazebo);
        visit({"bathymetry", "", "the sea floor of a survey, read around the vehicle; absent: what file has"},
              self.bathymetry);
        visit({"datum", "",
               "the world's origin on the earth, for bathymetry and for targets with latitudes; absent: the "
               "deployment's"},
              self.datum);
        visit({"placement", "", "place of the scene of file or gazebo in the world; absent: the scene's own"},
              self.placement);
        visit(
            {"scale", "1",
             "by name of a node: factor of the size of the node and of what is below it, about its origin", 1e-3, 1e3},
            self.scale);
        visit({"mount", "", "the sonar in the body"}, self.mount);
        visit({"water_surface", "m", "z of the water surface in the world; absent: none", -1e5, 1e5},
              self.water_surface);
        visit({"omit", "",
               "names of nodes, models, links and visuals that are omitted, with all below them; * is any text; "
               "absent: "
               "none"},
              self.omit);
        visit({"omit_drawings", "",
               "whether drawn water and invisible visuals are omitted, unless they have acoustics; false: all is "
               "kept"},
              self.omit_drawings);
        visit({"pose_timeout", "s",
               "max age of the newest pose, of the body and of each connected node; absent: 1 in realtime, else "
               "no limit",
               1e-3, 1e6},
              self.pose_timeout);
        visit({"extrapolate", "s",
               "max time by which a sonar extrapolates its pose with its velocities to its ping; absent: the pose "
               "is used as it is",
               1e-3, 10},
              self.extrapolate);
        visit({"materials", "", "acoustic values by name of a material or model, over those of the file"},
              self.materials);
        visit({"materials_by_name", "",
               "materials without acoustic values are of the matter or sediment that their names contain, such as "
               "Steel.001; false: they are medium sand"},
              self.materials_by_name);
        visit({"targets", "", "point targets, rendered by the active sonar equation; absent: none"}, self.targets);
        visit({"animations", "",
               "by name of an animation of the file, or * for all others: how it plays; absent: all play in a loop "
               "from the start of the run"},
              self.animations);
    }
    void check(types::Diagnostics& diagnostics) const;
};

}  // namespace insonify::scene
