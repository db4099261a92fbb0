#include "components/sdf/Sdf.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <random>
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

#include "components/meshes/WorldBuilder.hpp"
#include "components/scene/Scene.hpp"
#include "components/scene/Surface.hpp"
#include "components/sdf/SdfFile.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::sdf {

using namespace scene;
namespace {

AcousticValue getValue(const std::string& text) {
    double number;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc() && end == text.data() + text.size()) return number;
    if (text == "true" || text == "false") return text == "true";
    return text;
}

glm::dvec3 toVector(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

glm::dmat4 toMatrix(const ignition::math::Pose3d& pose) {
    const ignition::math::Quaterniond& q = pose.Rot();
    return glm::translate(glm::dmat4(1), toVector(pose.Pos())) *
           glm::mat4_cast(glm::normalize(glm::dquat(q.W(), q.X(), q.Y(), q.Z())));
}

/** Returns the link or nested model of `model` that contains the entity `name`; empty if there is none. */
std::string getPart(const ::sdf::Model& model, const std::string& name) {
    for (uint64_t i = 0; i < model.LinkCount(); ++i)
        if (model.LinkByIndex(i)->Name() == name) return name;  // names of old worlds may hold "::"
    const std::string first = name.substr(0, name.find("::"));
    for (uint64_t i = 0; i < model.ModelCount(); ++i)
        if (model.ModelByIndex(i)->Name() == first) return first;
    return "";
}

/** Returns, for links and nested models that a joint moves, the name in `model` of the link that carries them. */
std::map<std::string, std::string> findCarriers(const ::sdf::Model& model) {
    std::map<std::string, std::string> carriers;
    for (uint64_t i = 0; i < model.JointCount(); ++i) {
        const ::sdf::Joint& joint = *model.JointByIndex(i);
        std::string child, parent;
        if (!joint.ResolveChildLink(child).empty()) child = joint.ChildLinkName();
        if (!joint.ResolveParentLink(parent).empty()) parent = joint.ParentLinkName();
        const std::string part = getPart(model, child);
        if (!part.empty() && getPart(model, parent) != part) carriers.try_emplace(part, parent);
    }
    return carriers;
}

meshes::Shape getShape(const ::sdf::Geometry& geometry) {
    switch (geometry.Type()) {
        case ::sdf::GeometryType::BOX: return meshes::BoxShape{toVector(geometry.BoxShape()->Size())};
        case ::sdf::GeometryType::SPHERE:
            return meshes::EllipsoidShape{glm::dvec3(geometry.SphereShape()->Radius()), true};
        case ::sdf::GeometryType::ELLIPSOID:
            return meshes::EllipsoidShape{toVector(geometry.EllipsoidShape()->Radii())};
        case ::sdf::GeometryType::CYLINDER:
            return meshes::CylinderShape{geometry.CylinderShape()->Radius(), geometry.CylinderShape()->Length()};
        case ::sdf::GeometryType::CAPSULE:
            return meshes::CapsuleShape{geometry.CapsuleShape()->Radius(), geometry.CapsuleShape()->Length()};
        case ::sdf::GeometryType::PLANE: {
            const ::sdf::Plane& plane = *geometry.PlaneShape();
            return meshes::PlaneShape{toVector(plane.Normal()), {plane.Size().X(), plane.Size().Y()}};
        }
        case ::sdf::GeometryType::MESH: {
            const ::sdf::Mesh& mesh = *geometry.MeshShape();
            return meshes::MeshShape{mesh.Uri(), mesh.Submesh(), mesh.CenterSubmesh(), toVector(mesh.Scale()),
                                     mesh.FilePath()};
        }
        case ::sdf::GeometryType::HEIGHTMAP: {
            const ::sdf::Heightmap& map = *geometry.HeightmapShape();
            return meshes::HeightmapShape{map.Uri(), toVector(map.Size()), toVector(map.Position()), map.FilePath()};
        }
        default: break;
    }
    const ::sdf::ElementPtr element = geometry.Element();  // newer than this libsdformat
    const ::sdf::ElementPtr cone = element && element->HasElement("cone") ? element->FindElement("cone") : nullptr;
    if (cone) return meshes::ConeShape{cone->Get<double>("radius", 0.5).first, cone->Get<double>("length", 1.0).first};
    const ::sdf::ElementPtr other = element ? element->GetFirstElement() : nullptr;
    return meshes::OtherShape{other ? other->GetName() : ""};
}

/** @param is_urdf whether the alpha of the colour is the visual's transparency, which SDF gives apart */
Drawing getDrawing(const ::sdf::Visual& visual, bool is_urdf) {
    constexpr uint32_t for_all = 0xffffffff;  // every camera's mask
    const double alpha = is_urdf && visual.Material() ? static_cast<double>(visual.Material()->Diffuse().A()) : 1;
    return {std::max<double>(visual.Transparency(), 1 - alpha), visual.CastShadows(),
            visual.VisibilityFlags() != for_all && visual.VisibilityFlags() != 0, visual.VisibilityFlags() == 0};
}

/** Returns the places of a population's models as Gazebo classic has them (Population.cc): copies lie in a box of
 * `size` whose lowest corner is at `pose`, or in a cylinder about it. Random and even places are drawn, the same each
 * time, which `drawn` says. */
std::vector<glm::dvec3> getPlaces(::sdf::Element& population, std::string& drawn) {
    const auto vector = [](const ::sdf::ElementPtr& of, const char* key) {
        return of ? toVector(of->Get<ignition::math::Vector3d>(key, {}).first) : glm::dvec3(0);
    };
    constexpr int most = 10'000;
    const ::sdf::ElementPtr rule = population.FindElement("distribution"), box = population.FindElement("box"),
                            cylinder = population.FindElement("cylinder");
    const std::string type = rule ? rule->Get<std::string>("type", "random").first : "random";
    const glm::dmat4 world_from_region = toMatrix(population.Get<ignition::math::Pose3d>("pose", {}).first);
    const glm::dvec3 size = vector(box, "size"), step = vector(rule, "step");
    const int columns = std::clamp(rule ? rule->Get<int>("cols", 1).first : 1, 0, most);
    const int rows = std::clamp(rule ? rule->Get<int>("rows", 1).first : 1, 0, most);
    const int count =
        std::clamp(type == "grid" ? rows * columns : population.Get<int>("model_count", 1).first, 0, most);
    std::mt19937 engine(1);
    const auto draw = [&] { return static_cast<double>(engine()) / 4294967296.0; };
    const auto place = [&](int i) -> glm::dvec3 {
        if (type == "grid") return {step.x * (i % columns), step.y * (i / columns), 0};
        for (int axis = 0; axis < 3; ++axis)
            if (type == std::string("linear-") + "xyz"[axis]) {
                glm::dvec3 at = size / 2.0;
                at[axis] = size[axis] * i / count;
                return at;
            }
        if (box) return size * glm::dvec3(draw(), draw(), draw());
        if (!cylinder) return glm::dvec3(0);
        const double radius = cylinder->Get<double>("radius", 0.0).first * std::sqrt(draw());
        const double angle = 2 * std::numbers::pi * draw();
        return {radius * std::cos(angle), radius * std::sin(angle),
                cylinder->Get<double>("length", 0.0).first * (draw() - 0.5)};
    };
    if (type == "random" || type == "uniform") drawn = ", at places that are drawn, the same in each run";
    std::vector<glm::dvec3> places;
    for (int i = 0; i < count; ++i) places.emplace_back(world_from_region * glm::dvec4(place(i), 1));
    return places;
}

class SdfReader {
public:
    explicit SdfReader(const std::filesystem::path& file) : file_(std::filesystem::absolute(file)), builder_(file_) {}

    Scene read() {
        CerrCapture console;
        if (isUrdf(file_) && std::filesystem::is_regular_file(file_)) urdf_ = readUrdf(file_, toText(file_));
        for (const std::string& notice : urdf_.notices) builder_.notice(notice);
        const ::sdf::Root root = readSdfFile(file_, builder_, console, urdf_.text);
        if (const ::sdf::World* world = root.WorldByIndex(0))
            addWorld(*world);
        else
            addModel(*root.Model(), "", -1, glm::dmat4(1));
        if (!diagnostics_.empty()) throw types::ConfigError(std::move(diagnostics_));
        if (!unused_.empty())
            builder_.notice(fmt::format("not used: {}; a surface's echo is of its material", fmt::join(unused_, ", ")));
        addCount(root.WorldCount() > 1 ? root.WorldCount() - 1 : 0, "worlds omitted, the first of the file is read",
                 builder_.notices());
        return builder_.take();
    }

private:
    void addWorld(const ::sdf::World& world) {
        for (uint64_t i = 0; i < world.ModelCount(); ++i) addModel(*world.ModelByIndex(i), "", -1, glm::dmat4(1));
        addPopulations(*world.Element());
        addCount(world.ActorCount(), "actors omitted", builder_.notices());
        addCount(getChildren(*world.Element(), "road").size(), "roads omitted: drawn strips on the ground",
                 builder_.notices());
        if (world.Element()->HasElement("state"))
            builder_.notice("the poses of <state> are not used, the poses of the models are");
    }

    static std::vector<::sdf::ElementPtr> getChildren(::sdf::Element& element, const std::string& name) {
        std::vector<::sdf::ElementPtr> children;
        if (!element.HasElement(name)) return children;
        for (::sdf::ElementPtr child = element.FindElement(name); child; child = child->GetNextElement(name))
            children.push_back(child);
        return children;
    }

    /** Adds the copies of a model that Gazebo would place, as `<model>_clone_<i>`. */
    void addPopulations(::sdf::Element& world) {
        for (const ::sdf::ElementPtr& population : getChildren(world, "population")) {
            const std::string name = population->Get<std::string>("name");
            ::sdf::Model model;
            const ::sdf::ElementPtr element = population->FindElement("model");
            if (!element || !model.Load(element).empty() || model.Name().empty()) {
                builder_.notice(fmt::format("population {} is omitted: it has no model that can be read", name));
                continue;
            }
            std::string drawn;
            const std::vector<glm::dvec3> places = getPlaces(*population, drawn);
            for (size_t i = 0; i < places.size(); ++i)
                addModelAt(model, fmt::format("{}_clone_{}", model.Name(), i), -1,
                           glm::translate(glm::dmat4(1), places[i]));
            builder_.notice(fmt::format("population {}: {} times {}{}", name, places.size(), model.Name(), drawn));
        }
    }

    /** Adds a model. `scope` is the name of its container, followed by "::". */
    void addModel(const ::sdf::Model& model, const std::string& scope, int parent, const glm::dmat4& world_from_scope) {
        const std::string name = scope + model.Name();
        addModelAt(model, name, parent, world_from_scope * getPose(model, name));
    }

    void addModelAt(const ::sdf::Model& model, const std::string& name, int parent,
                    const glm::dmat4& world_from_model) {
        const std::string outer_matter = matter_;
        if (const std::string own = getMatter(*model.Element()); !own.empty()) matter_ = own;
        const int node = addNode(name, parent, world_from_model);
        const std::map<std::string, std::string> carriers = findCarriers(model);
        std::set<std::string> begun;
        const std::function<void(const std::string&)> addPart = [&](const std::string& part) {
            if (part.empty() || !begun.insert(part).second) return;
            int below = node;
            if (const auto carrier = carriers.find(part); carrier != carriers.end()) {
                addPart(getPart(model, carrier->second));
                const auto known = nodes_.find(name + "::" + carrier->second);
                if (known != nodes_.end()) below = known->second;  // else the attachment is circular
            }
            for (uint64_t i = 0; i < model.LinkCount(); ++i)
                if (model.LinkByIndex(i)->Name() == part)
                    return addLink(*model.LinkByIndex(i), name + "::", below, world_from_model);
            addModel(*model.ModelByName(part), name + "::", below, world_from_model);
        };
        for (uint64_t i = 0; i < model.LinkCount(); ++i) addPart(model.LinkByIndex(i)->Name());
        for (uint64_t i = 0; i < model.ModelCount(); ++i) addPart(model.ModelByIndex(i)->Name());
        matter_ = outer_matter;
    }

    /** Returns the material of a model's surface by DAVE's `surface_props`; empty: it has none. */
    std::string getMatter(const ::sdf::Element& model) {
        for (const char* unused :
             {"surface_props:biofouling_rating", "surface_props:roughness", "surface_props:distort_extent"})
            if (model.HasElement(unused)) unused_.insert(unused);
        const std::string name = model.Get<std::string>("surface_props:material", "").first;
        return types::lowered(name) == "metal" ? "steel" : name;
    }

    void addLink(const ::sdf::Link& link, const std::string& scope, int parent, const glm::dmat4& world_from_model) {
        const std::string name = scope + link.Name();
        const int node = addNode(name, parent, world_from_model * getPose(link, name));
        for (uint64_t i = 0; i < link.VisualCount(); ++i) {
            const ::sdf::Visual& visual = *link.VisualByIndex(i);
            const std::string visual_name = name + "::" + visual.Name();
            const glm::dmat4 link_from_visual = getPose(visual, visual_name);
            meshes::Look look = getLook(visual, visual_name);
            if (const auto named = urdf_.materials.find(link.Name());
                named != urdf_.materials.end() && i < named->second.size())
                look.name = named->second[i];
            meshes::Shape shape = getShape(*visual.Geom());
            if (auto* const mesh = std::get_if<meshes::MeshShape>(&shape); mesh && !urdf_.text.empty()) {
                mesh->named_in = file_;
                // libsdformat gives the packages of ROS as models.
                if (const std::string as_written =
                        "package" + mesh->uri.substr(std::min(mesh->uri.find(':'), mesh->uri.size()));
                    mesh->uri.starts_with("model://") && urdf_.text.find(as_written) != std::string::npos)
                    mesh->uri = as_written;
            }
            if (const types::Diagnostic fault = meshes::findFault(shape); !fault.message.empty())
                fail(*visual.Element(), fmt::format("{}.{}", visual_name, fault.path), fault.message);
            builder_.addVisual(visual_name, node, link_from_visual, shape, look,
                               getDrawing(visual, !urdf_.text.empty()));
        }
    }

    /** Returns the pose of a part in the frame of its container. */
    glm::dmat4 getPose(const auto& part, const std::string& name) {
        ignition::math::Pose3d pose;
        const ::sdf::Errors errors = part.SemanticPose().Resolve(pose);
        if (errors.empty()) return toMatrix(pose);
        if (!part.PoseRelativeTo().empty())
            fail(*part.Element(), name + ".pose",
                 fmt::format("relative to \"{}\" cannot be resolved: {}", part.PoseRelativeTo(),
                             errors.front().Message()));
        return toMatrix(part.RawPose());
    }

    int addNode(const std::string& name, int parent, const glm::dmat4& world_from_node) {
        return nodes_[name] = builder_.addNode(name, parent, world_from_node);
    }

    meshes::Look getLook(const ::sdf::Visual& visual, const std::string& name) {
        meshes::Look look;
        if (const ::sdf::Material* material = visual.Material()) look.name = material->ScriptName();
        if (!matter_.empty()) look.name = matter_;
        if (visual.Element()->Get<double>("laser_retro", 0.0).first > 0) unused_.insert("laser_retro");
        const ::sdf::ElementPtr tag = visual.Element()->FindElement("insonify:acoustics");
        if (!tag) return look;
        for (const ::sdf::ParamPtr& attribute : tag->GetAttributes())
            if (!attribute->GetKey().starts_with("xmlns"))  // names a prefix, no property
                look.acoustics[attribute->GetKey()] = getValue(attribute->GetAsString());
        for (::sdf::ElementPtr key = tag->GetFirstElement(); key; key = key->GetNextElement()) {
            if (!key->GetFirstElement()) look.acoustics[key->GetName()] = getValue(key->Get<std::string>());
            for (::sdf::ElementPtr of = key->GetFirstElement(); of; of = of->GetNextElement())
                look.acoustics[key->GetName() + "." + of->GetName()] = getValue(of->Get<std::string>());
        }
        types::Diagnostics diagnostics;
        const auto folder = std::filesystem::path(visual.Element()->FilePath()).parent_path();
        const Acoustics known = readAcoustics(look.acoustics, folder, diagnostics);
        if (known.table) look.acoustics["table"] = (folder / *known.table).string();
        for (const types::Diagnostic& diagnostic : diagnostics)
            fail(*visual.Element(), fmt::format("{}.insonify:acoustics.{}", name, diagnostic.path), diagnostic.message);
        return look;
    }

    void fail(const ::sdf::Element& element, const std::string& path, const std::string& message) {
        const bool is_file = urdf_.text.empty();  // else of SDF that was made of it
        diagnostics_.push_back({path, message, is_file ? element.FilePath() : file_.string(),
                                is_file ? element.LineNumber().value_or(0) : 0});
    }

    std::filesystem::path file_;
    meshes::WorldBuilder builder_;
    std::map<std::string, int> nodes_;  ///< By name in the file.
    Urdf urdf_;                         ///< Empty if the file is SDF.
    types::Diagnostics diagnostics_;
    std::string matter_;            ///< Material of the present model by `surface_props`; empty: none.
    std::set<std::string> unused_;  ///< Elements about surfaces that nothing is made of.
};

}  // namespace

Scene readSdf(const std::filesystem::path& file) { return SdfReader(file).read(); }

}  // namespace insonify::sdf
