#include "components/sdf/Sdf.hpp"

#include <fmt/format.h>

#include <charconv>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <sdf/Box.hh>
#include <sdf/Capsule.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Element.hh>
#include <sdf/Ellipsoid.hh>
#include <sdf/Geometry.hh>
#include <sdf/Heightmap.hh>
#include <sdf/Joint.hh>
#include <sdf/Link.hh>
#include <sdf/Material.hh>
#include <sdf/Mesh.hh>
#include <sdf/Model.hh>
#include <sdf/Plane.hh>
#include <sdf/Sphere.hh>
#include <sdf/Visual.hh>
#include <sdf/World.hh>
#include <set>

#include "components/scene/UniqueNames.hpp"
#include "components/sdf/SdfFile.hpp"
#include "components/sdf/SdfMeshes.hpp"
#include "components/sdf/SdfShapes.hpp"
#include "types/ConfigError.hpp"

namespace insonify::sdf {

using namespace scene;
namespace {

glm::dvec3 vectorOf(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

glm::dmat4 matrixOf(const ignition::math::Pose3d& pose) {
    const ignition::math::Quaterniond& q = pose.Rot();
    return glm::translate(glm::dmat4(1), vectorOf(pose.Pos())) *
           glm::mat4_cast(glm::normalize(glm::dquat(q.W(), q.X(), q.Y(), q.Z())));
}

Placing scaled(Placing placing, glm::dvec3 size) {
    placing.visual_from_object = glm::scale(placing.visual_from_object, size);
    return placing;
}

AcousticValue valueOf(const std::string& text) {
    double number;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc() && end == text.data() + text.size()) return number;
    if (text == "true" || text == "false") return text == "true";
    return text;
}

/** The link or nested model of `model` that holds what is called `name` there; empty when there is none. */
std::string partOf(const ::sdf::Model& model, const std::string& name) {
    for (uint64_t i = 0; i < model.LinkCount(); ++i)
        if (model.LinkByIndex(i)->Name() == name) return name;  // names of old worlds may hold "::"
    const std::string first = name.substr(0, name.find("::"));
    for (uint64_t i = 0; i < model.ModelCount(); ++i)
        if (model.ModelByIndex(i)->Name() == first) return first;
    return "";
}

/** For links and nested models that a joint moves: the name in `model` of the link that they hang on. */
std::map<std::string, std::string> carriersOf(const ::sdf::Model& model) {
    std::map<std::string, std::string> carriers;
    for (uint64_t i = 0; i < model.JointCount(); ++i) {
        const ::sdf::Joint& joint = *model.JointByIndex(i);
        std::string child, parent;
        if (!joint.ResolveChildLink(child).empty()) child = joint.ChildLinkName();
        if (!joint.ResolveParentLink(parent).empty()) parent = joint.ParentLinkName();
        const std::string part = partOf(model, child);
        if (!part.empty() && partOf(model, parent) != part) carriers.try_emplace(part, parent);
    }
    return carriers;
}

class SdfReader {
public:
    explicit SdfReader(const std::filesystem::path& file)
        : file_(std::filesystem::absolute(file)), paths_(file_), meshes_(geometry_) {}

    Scene read() {
        CerrCapture console;
        const ::sdf::Root root = readSdfFile(file_, paths_, console, geometry_.notices);
        if (const ::sdf::World* world = root.WorldByIndex(0))
            addWorld(*world);
        else
            addModel(*root.Model(), "", -1, glm::dmat4(1));
        if (!diagnostics_.empty()) throw types::ConfigError(std::move(diagnostics_));
        addCount(root.WorldCount() > 1 ? root.WorldCount() - 1 : 0, "worlds left out, the first of the file is read",
                 geometry_.notices);
        addCount(flat_visuals_, "visuals left out, their size is zero in some direction or not finite",
                 geometry_.notices);
        if (geometry_.objects.empty()) notice("the scene has no triangles: an empty sea");
        scene_.geometry = std::make_shared<const types::Geometry>(std::move(geometry_));
        return std::move(scene_);
    }

private:
    void addWorld(const ::sdf::World& world) {
        for (uint64_t i = 0; i < world.ModelCount(); ++i) addModel(*world.ModelByIndex(i), "", -1, glm::dmat4(1));
        addCount(world.ActorCount(), "actors left out", geometry_.notices);
        if (world.Element()->HasElement("state")) notice("the poses of <state> are not taken, those of the models are");
    }

    /** `scope` is the name of what holds the model, with "::" behind it. */
    void addModel(const ::sdf::Model& model, const std::string& scope, int parent, const glm::dmat4& world_from_scope) {
        const std::string name = scope + model.Name();
        const glm::dmat4 world_from_model = world_from_scope * poseOf(model, name);
        const int node = addNode(name, parent, world_from_model);
        const std::map<std::string, std::string> carriers = carriersOf(model);
        std::set<std::string> begun;
        const std::function<void(const std::string&)> addPart = [&](const std::string& part) {
            if (part.empty() || !begun.insert(part).second) return;
            int below = node;
            if (const auto carrier = carriers.find(part); carrier != carriers.end()) {
                addPart(partOf(model, carrier->second));
                const auto known = nodes_.find(name + "::" + carrier->second);
                if (known != nodes_.end()) below = known->second;  // else it hangs on itself in a circle
            }
            for (uint64_t i = 0; i < model.LinkCount(); ++i)
                if (model.LinkByIndex(i)->Name() == part)
                    return addLink(*model.LinkByIndex(i), name + "::", below, world_from_model);
            addModel(*model.ModelByName(part), name + "::", below, world_from_model);
        };
        for (uint64_t i = 0; i < model.LinkCount(); ++i) addPart(model.LinkByIndex(i)->Name());
        for (uint64_t i = 0; i < model.ModelCount(); ++i) addPart(model.ModelByIndex(i)->Name());
    }

    void addLink(const ::sdf::Link& link, const std::string& scope, int parent, const glm::dmat4& world_from_model) {
        const std::string name = scope + link.Name();
        const int node = addNode(name, parent, world_from_model * poseOf(link, name));
        for (uint64_t i = 0; i < link.VisualCount(); ++i) {
            const ::sdf::Visual& visual = *link.VisualByIndex(i);
            const std::string visual_name = name + "::" + visual.Name();
            const glm::dmat4 link_from_visual = poseOf(visual, visual_name);
            for (const Placing& placing : placingsOf(visual, visual_name))
                addObject(visual_name, node, placing.mesh, link_from_visual * placing.visual_from_object);
        }
    }

    /** In the frame of what holds it. */
    template <class Part>
    glm::dmat4 poseOf(const Part& part, const std::string& name) {
        ignition::math::Pose3d pose;
        const ::sdf::Errors errors = part.SemanticPose().Resolve(pose);
        if (errors.empty()) return matrixOf(pose);
        if (!part.PoseRelativeTo().empty())
            fail(*part.Element(), name + ".pose",
                 fmt::format("relative to \"{}\" cannot be resolved: {}", part.PoseRelativeTo(),
                             errors.front().Message()));
        return matrixOf(part.RawPose());
    }

    int addNode(const std::string& name, int parent, const glm::dmat4& world_from_node) {
        const glm::dmat4 parent_from_world =
            parent < 0 ? glm::dmat4(1) : glm::inverse(world_from_node_[static_cast<size_t>(parent)]);
        scene_.nodes.push_back({names_.add(name), parent, parent_from_world * world_from_node, glm::dvec3(1)});
        world_from_node_.push_back(world_from_node);
        return nodes_[name] = static_cast<int>(scene_.nodes.size()) - 1;
    }

    void addObject(const std::string& name, int node, int mesh, const glm::dmat4& node_from_object) {
        const glm::dmat4 world_from_object = world_from_node_[static_cast<size_t>(node)] * node_from_object;
        if (!isFinite(world_from_object) || glm::determinant(glm::dmat3(node_from_object)) == 0)
            return void(++flat_visuals_);
        geometry_.objects.push_back({object_names_.add(name), mesh, world_from_object});
        scene_.object_nodes.push_back(node);
        scene_.node_from_object.push_back(node_from_object);
    }

    std::vector<Placing> placingsOf(const ::sdf::Visual& visual, const std::string& name) {
        const ::sdf::Geometry& shape = *visual.Geom();
        const Look look = lookOf(visual, name);
        const auto size = [&](const char* key, glm::dvec3 given) {
            if (!(given.x >= 0 && given.y >= 0 && given.z >= 0))
                fail(*visual.Element(), fmt::format("{}.{}", name, key),
                     fmt::format("is {}; must not be negative", std::min({given.x, given.y, given.z})));
            return given;
        };
        const auto sizeOf = [&](const char* key, const ignition::math::Vector3d& given) {
            return size(key, vectorOf(given));
        };
        switch (shape.Type()) {
            case ::sdf::GeometryType::BOX:
                return {scaled(meshes_.shape("box", look, unitBox), sizeOf("size", shape.BoxShape()->Size()))};
            case ::sdf::GeometryType::SPHERE:
                return {scaled(meshes_.shape("sphere", look, unitSphere),
                               size("radius", glm::dvec3(shape.SphereShape()->Radius())))};
            case ::sdf::GeometryType::ELLIPSOID:
                return {scaled(meshes_.shape("sphere", look, unitSphere),
                               sizeOf("radii", shape.EllipsoidShape()->Radii()))};
            case ::sdf::GeometryType::CYLINDER: {
                const ::sdf::Cylinder& cylinder = *shape.CylinderShape();
                return {scaled(meshes_.shape("cylinder", look, unitCylinder),
                               size("radius, length", {cylinder.Radius(), cylinder.Radius(), cylinder.Length()}))};
            }
            case ::sdf::GeometryType::CAPSULE: {
                const double radius = shape.CapsuleShape()->Radius(), length = shape.CapsuleShape()->Length();
                size("radius, length", {radius, radius, length});
                return {meshes_.shape(fmt::format("capsule {} {}", radius, length), look,
                                      [&] { return capsule(radius, length); })};
            }
            case ::sdf::GeometryType::PLANE: return {planeOf(*shape.PlaneShape(), look)};
            case ::sdf::GeometryType::MESH: return meshOf(*shape.MeshShape(), name, look);
            case ::sdf::GeometryType::HEIGHTMAP: return heightmapOf(*shape.HeightmapShape(), name, look);
            default:
                notice(fmt::format("visual {} is left out: its geometry is not one of those that are drawn", name));
                return {};
        }
    }

    Placing planeOf(const ::sdf::Plane& plane, const Look& look) {
        ignition::math::Quaterniond turn;
        turn.From2Axes(ignition::math::Vector3d::UnitZ, plane.Normal());
        Placing placing = meshes_.shape("plane", look, unitPlane);
        placing.visual_from_object = matrixOf({ignition::math::Vector3d::Zero, turn});
        return scaled(placing, {plane.Size().X(), plane.Size().Y(), 1});
    }

    std::vector<Placing> meshOf(const ::sdf::Mesh& mesh, const std::string& name, const Look& look) try {
        const auto path = paths_.find(mesh.Uri(), mesh.FilePath());
        if (!path) return leftOut(name, mesh.Uri(), "is not found");
        std::vector<Placing> placings = meshes_.file(*path, mesh.Submesh(), look);
        if (placings.empty()) return leftOut(name, mesh.Uri(), fmt::format("has no submesh \"{}\"", mesh.Submesh()));
        if (mesh.CenterSubmesh()) placings = meshes_.centred(std::move(placings));
        const glm::dmat4 scale = glm::scale(glm::dmat4(1), vectorOf(mesh.Scale()));
        for (Placing& placing : placings) placing.visual_from_object = scale * placing.visual_from_object;
        return placings;
    } catch (const types::ConfigError& failure) {
        return leftOut(name, mesh.Uri(), failure.diagnostics().front().message);
    }

    std::vector<Placing> heightmapOf(const ::sdf::Heightmap& map, const std::string& name, const Look& look) try {
        const auto path = paths_.find(map.Uri(), map.FilePath());
        if (!path) return leftOut(name, map.Uri(), "is not found");
        const glm::dvec3 size = vectorOf(map.Size());
        Placing placing = meshes_.shape(fmt::format("{} {} {} {}", path->string(), size.x, size.y, size.z), look,
                                        [&] { return readHeightmap(*path, size); });
        placing.visual_from_object = glm::translate(glm::dmat4(1), vectorOf(map.Position()));
        return {placing};
    } catch (const std::runtime_error& failure) {
        return leftOut(name, map.Uri(), failure.what());
    }

    Look lookOf(const ::sdf::Visual& visual, const std::string& name) {
        Look look;
        if (const ::sdf::Material* material = visual.Material()) look.name = material->ScriptName();
        const ::sdf::ElementPtr tag = visual.Element()->FindElement("insonify:acoustics");
        if (!tag) return look;
        for (const ::sdf::ParamPtr& attribute : tag->GetAttributes())
            look.acoustics[attribute->GetKey()] = valueOf(attribute->GetAsString());
        for (::sdf::ElementPtr key = tag->GetFirstElement(); key; key = key->GetNextElement()) {
            if (!key->GetFirstElement()) look.acoustics[key->GetName()] = valueOf(key->Get<std::string>());
            for (::sdf::ElementPtr of = key->GetFirstElement(); of; of = of->GetNextElement())
                look.acoustics[key->GetName() + "." + of->GetName()] = valueOf(of->Get<std::string>());
        }
        types::Diagnostics diagnostics;
        const auto folder = std::filesystem::path(visual.Element()->FilePath()).parent_path();
        const Acoustics known = readAcoustics(look.acoustics, folder, diagnostics);
        if (known.table) look.acoustics["table"] = (folder / *known.table).string();
        for (const types::Diagnostic& diagnostic : diagnostics)
            fail(*visual.Element(), fmt::format("{}.insonify:acoustics.{}", name, diagnostic.path), diagnostic.message);
        return look;
    }

    std::vector<Placing> leftOut(const std::string& visual, const std::string& uri, const std::string& why) {
        notice(fmt::format("visual {} is left out: {} {}", visual, uri, why));
        return {};
    }
    void notice(std::string text) { geometry_.notices.push_back(std::move(text)); }
    void fail(const ::sdf::Element& element, const std::string& path, const std::string& message) {
        diagnostics_.push_back({path, message, element.FilePath(), element.LineNumber().value_or(0)});
    }

    std::filesystem::path file_;
    SdfPaths paths_;
    types::Geometry geometry_;
    SdfMeshes meshes_;
    Scene scene_;
    std::vector<glm::dmat4> world_from_node_;  ///< For each node.
    std::map<std::string, int> nodes_;         ///< By name in the file.
    UniqueNames names_, object_names_;
    types::Diagnostics diagnostics_;
    size_t flat_visuals_ = 0;
};

}  // namespace

Scene readSdf(const std::filesystem::path& file) { return SdfReader(file).read(); }

}  // namespace insonify::sdf
