#include "components/viewer/SceneMesh.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "components/viewer/PingPicture.hpp"
#include "types/geometry/PosedMesh.hpp"

namespace insonify::viewer {
namespace {

using Json = nlohmann::json;

template <class T>
void append(std::string& data, const std::vector<T>& values) {
    data.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

Json toMatrix(const glm::dmat4& m) {
    Json columns = Json::array();
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) columns.push_back(m[c][r]);
    return columns;
}

/** Returns the numbers of the objects to draw, in ascending order. Objects with more triangles are preferred, up to
 *  `most` triangles. */
std::vector<size_t> shownObjects(const types::Geometry& geometry, const std::vector<Part>& parts, size_t maximum) {
    std::vector<size_t> order(geometry.objects.size()), shown;
    std::iota(order.begin(), order.end(), size_t{0});
    const auto triangles = [&](size_t object) {
        return parts[static_cast<size_t>(geometry.objects[object].mesh)].indices.size() / 3;
    };
    std::ranges::stable_sort(order, [&](size_t a, size_t b) { return triangles(a) > triangles(b); });
    size_t sum = 0;
    for (const size_t object : order)
        if (sum + triangles(object) <= maximum) {
            sum += triangles(object);
            shown.push_back(object);
        }
    std::ranges::sort(shown);
    return shown;
}

Json getPosition(const glm::dvec3& p) { return {p.x, p.y, p.z}; }
Json getOrientation(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

/** Appends the positions of the objects that a snapshot deforms. Returns their places in the data. */
Json getShapes(const types::Snapshot& snapshot, size_t max_triangles, std::string& data) {
    const bool coarse = snapshot.geometry->triangleCount() > max_triangles;
    const types::GeometryPtr posed = types::posedGeometry(snapshot);
    Json shapes = Json::array();
    for (const types::DeformedObject& deformed : snapshot.deformed) {
        const auto mesh = static_cast<size_t>(posed->objects[deformed.object].mesh);
        const Part part = getPart(posed->meshes[mesh], coarse);
        shapes.push_back({{"object", deformed.object}, {"offset", data.size()}, {"count", part.positions.size()}});
        append(data, part.positions);
    }
    return shapes;
}

}  // namespace

Part getPart(const types::Mesh& mesh, bool coarse) {
    Part part;
    part.material = mesh.clusters.empty() ? 0 : mesh.clusters.front().material;
    std::vector<uint32_t> number(mesh.positions.size(), UINT32_MAX);
    for (const uint32_t index : coarse && !mesh.coarse_indices.empty() ? mesh.coarse_indices : mesh.indices) {
        if (number[index] == UINT32_MAX) {
            number[index] = static_cast<uint32_t>(part.positions.size() / 3);
            const glm::vec3& p = mesh.positions[index];
            part.positions.insert(part.positions.end(), {p.x, p.y, p.z});
        }
        part.indices.push_back(number[index]);
    }
    return part;
}

ShownScene shownScene(const types::Geometry& geometry, size_t max_triangles) {
    ShownScene scene;
    scene.coarse = geometry.triangleCount() > max_triangles;
    for (const types::Mesh& mesh : geometry.meshes) scene.parts.push_back(getPart(mesh, scene.coarse));
    scene.objects = shownObjects(geometry, scene.parts, max_triangles);
    std::vector<bool> used(scene.parts.size());
    for (const size_t i : scene.objects) used[static_cast<size_t>(geometry.objects[i].mesh)] = true;
    for (size_t i = 0; i < scene.parts.size(); ++i)
        if (!used[i]) scene.parts[i] = {};  // the part keeps its number
    return scene;
}

std::string sceneMessage(const types::Geometry& geometry, size_t max_triangles, const std::string& source) {
    const auto [parts, shown, coarse] = shownScene(geometry, max_triangles);
    Json meshes = Json::array(), objects = Json::array(), materials = Json::array();
    std::string data;
    for (const Part& part : parts) {
        meshes.push_back(
            {{"positions", {{"offset", data.size()}, {"count", part.positions.size()}}},
             {"indices",
              {{"offset", data.size() + part.positions.size() * sizeof(float)}, {"count", part.indices.size()}}},
             {"material", part.material}});
        append(data, part.positions);
        append(data, part.indices);
    }
    for (const size_t i : shown) {
        const types::Object& object = geometry.objects[i];
        objects.push_back({{"object", i},
                           {"name", object.name},
                           {"mesh", object.mesh},
                           {"matrix", toMatrix(object.world_from_object)}});
    }
    for (const types::Material& material : geometry.materials) materials.push_back(material.name);
    const Json json = {{"source", source},
                       {"meshes", meshes},
                       {"objects", objects},
                       {"materials", materials},
                       {"triangles", geometry.triangleCount()},
                       {"coarse", coarse},
                       {"left_out", geometry.objects.size() - shown.size()}};
    return pageMessage(scene_kind, json.dump(-1, ' ', false, Json::error_handler_t::replace), data);
}

std::string snapshotMessage(const types::Snapshot& snapshot, size_t max_triangles, const std::string& source) {
    Json moved = Json::array();
    for (const types::MovedObject& object : snapshot.moved)
        moved.push_back({{"object", object.object}, {"matrix", toMatrix(object.world_from_object)}});
    Json json = {{"type", "snapshot"},
                 {"source", source},
                 {"time_us", snapshot.time.microseconds},
                 {"position", getPosition(snapshot.sonar.position)},
                 {"orientation", getOrientation(snapshot.sonar.orientation)},
                 {"moved", moved}};
    if (snapshot.water_surface) json["water_surface"] = *snapshot.water_surface;
    if (snapshot.deformed.empty()) return json.dump();
    std::string data;
    json["shapes"] = getShapes(snapshot, max_triangles, data);
    return pageMessage(snapshot_kind, json.dump(), data);
}

std::string poseText(const types::Pose& pose, const std::string& source) {
    return Json{{"type", "pose"},
                {"source", source},
                {"time_us", pose.time.microseconds},
                {"position", getPosition(pose.position)},
                {"orientation", getOrientation(pose.orientation)}}
        .dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace insonify::viewer
