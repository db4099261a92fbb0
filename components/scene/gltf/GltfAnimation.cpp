#include "components/scene/gltf/GltfAnimation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "components/scene/UniqueNames.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::scene {
namespace {

constexpr size_t max_joints = 65'536;  ///< Max joints of a skin: indices have 16 bits [1].

bool isFiniteVector(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/** The list in the order of a mesh, empty where it is empty. */
template <class T>
std::vector<T> reordered(const std::vector<T>& list, const std::vector<uint32_t>& numbers) {
    std::vector<T> result;
    if (list.empty()) return result;
    result.reserve(numbers.size());
    for (const uint32_t number : numbers) result.push_back(list[number]);
    return result;
}

std::optional<AnimatedPath> getPath(const std::string& name) {
    static const std::map<std::string, AnimatedPath> paths{{"translation", AnimatedPath::Translation},
                                                           {"rotation", AnimatedPath::Rotation},
                                                           {"scale", AnimatedPath::Scale},
                                                           {"weights", AnimatedPath::Weights}};
    const auto found = paths.find(name);
    return found == paths.end() ? std::nullopt : std::optional(found->second);
}

/** Reads one animation. */
class AnimationReader {
public:
    AnimationReader(const GltfFile& gltf, const GltfAccessors& accessors, const std::vector<int>& node_in_scene,
                    size_t number, GltfAnimations& to)
        : gltf_(gltf),
          accessors_(accessors),
          node_in_scene_(node_in_scene),
          from_(gltf.model.animations[number]),
          here_(fmt::format("animations[{}]", number)),
          to_(to) {}

    Animation read() {
        for (size_t i = 0; i < from_.channels.size(); ++i)
            addChannel(from_.channels[i], fmt::format("{}.channels[{}]", here_, i));
        return std::move(animation_);
    }

private:
    void addChannel(const tinygltf::AnimationChannel& channel, const std::string& path) {
        const auto property = getPath(channel.target_path);
        if (!property) return void(++to_.other_paths);
        if (channel.sampler < 0 || static_cast<size_t>(channel.sampler) >= from_.samplers.size())
            fail(path + ".sampler",
                 fmt::format("is {}; the animation has {} samplers", channel.sampler, from_.samplers.size()));
        if (channel.target_node < 0) return void(++to_.other_paths);
        const auto& nodes = gltf_.model.nodes;
        const auto number = static_cast<size_t>(channel.target_node);
        if (number >= nodes.size())
            fail(path + ".target.node", fmt::format("is {}; the file has {} nodes", number, nodes.size()));
        size_t width = *property == AnimatedPath::Rotation ? 4 : 3;
        if (*property == AnimatedPath::Weights)
            width = getWeights(nodes[number], path, number);
        else if (!nodes[number].matrix.empty())
            fail(path + ".target.node", fmt::format("is nodes[{}], which has a matrix; an animated node must have "
                                                    "translation, rotation and scale in its place",
                                                    number));
        const KeyFrames keys = getKeys(channel.sampler, *property, width);
        const int node = node_in_scene_[number];
        if (node < 0) return void(++to_.outside_scene);
        const auto is_same = [&](const Channel& one) { return one.node == node && one.path == *property; };
        if (std::ranges::any_of(animation_.channels, is_same)) return void(++to_.doubled);
        animation_.duration = std::max(animation_.duration, keys.times.back());
        animation_.channels.push_back({node, *property, animation_.keys.size()});
        animation_.keys.push_back(keys);
    }

    size_t getWeights(const tinygltf::Node& node, const std::string& path, size_t number) const {
        const bool has_mesh = node.mesh >= 0 && static_cast<size_t>(node.mesh) < gltf_.model.meshes.size();
        const size_t count = has_mesh ? targetCount(gltf_, static_cast<size_t>(node.mesh)) : 0;
        if (count == 0)
            fail(path + ".target.path", fmt::format("is weights; nodes[{}] has no mesh with morph targets", number));
        return count;
    }

    KeyFrames getKeys(int number, AnimatedPath property, size_t width) const {
        const tinygltf::AnimationSampler& sampler = from_.samplers[static_cast<size_t>(number)];
        const std::string path = fmt::format("{}.samplers[{}]", here_, number);
        KeyFrames keys;
        keys.is_rotation = property == AnimatedPath::Rotation;
        keys.width = width;
        if (sampler.interpolation == "STEP")
            keys.interpolation = Interpolation::Step;
        else if (sampler.interpolation == "CUBICSPLINE")
            keys.interpolation = Interpolation::CubicSpline;
        else if (sampler.interpolation != "LINEAR" && !sampler.interpolation.empty())
            fail(path + ".interpolation",
                 fmt::format("is \"{}\"; may be LINEAR, STEP or CUBICSPLINE", sampler.interpolation));
        keys.times = getTimes(sampler.input, path + ".input");
        const size_t per_key = keys.interpolation == Interpolation::CubicSpline ? 3 : 1;
        const size_t per_element = property == AnimatedPath::Weights ? 1 : width;
        accessors_.componentType(sampler.output);  // refuses an accessor that does not exist
        const size_t count = gltf_.model.accessors[static_cast<size_t>(sampler.output)].count;
        if (count != keys.times.size() * per_key * width / per_element)  // before a bad count takes memory
            fail(path + ".output",
                 fmt::format("has {} elements; {} keys of {} values need {}", count, keys.times.size(), per_key,
                             keys.times.size() * per_key * width / per_element));
        keys.values = readValues(sampler.output, property, path + ".output");
        if (keys.is_rotation) normaliseRotations(keys, path + ".output");
        return keys;
    }

    std::vector<double> getTimes(int accessor, const std::string& path) const {
        if (accessors_.componentType(accessor) != TINYGLTF_COMPONENT_TYPE_FLOAT)
            fail(path, "is not of componentType 5126; times must be floats");
        const std::vector<float> read = accessors_.numbers(accessor, TINYGLTF_TYPE_SCALAR);
        std::vector<double> times(read.begin(), read.end());
        if (times.empty()) fail(path, "has no times; must have one at least");
        for (size_t i = 0; i < times.size(); ++i) {
            if (!std::isfinite(times[i]) || times[i] < 0)
                fail(path, fmt::format("is {} s at key {}; must be 0 or more", times[i], i));
            if (i > 0 && !(times[i] > times[i - 1]))
                fail(path, fmt::format("is {} s at key {}, and {} s at the key before; times must increase", times[i],
                                       i, times[i - 1]));
        }
        return times;
    }

    std::vector<double> readValues(int accessor, AnimatedPath property, const std::string& path) const {
        const bool may_be_whole = property == AnimatedPath::Rotation || property == AnimatedPath::Weights;
        const int component = accessors_.componentType(accessor);
        const bool is_scaled = gltf_.model.accessors[static_cast<size_t>(accessor)].normalized &&
                               component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        if (component != TINYGLTF_COMPONENT_TYPE_FLOAT && !(may_be_whole && is_scaled))
            fail(path, fmt::format("has componentType {}; must be 5126{}", component,
                                   may_be_whole ? ", or normalized integers of 8 or 16 bits" : ""));
        const int type = property == AnimatedPath::Rotation  ? TINYGLTF_TYPE_VEC4
                         : property == AnimatedPath::Weights ? TINYGLTF_TYPE_SCALAR
                                                             : TINYGLTF_TYPE_VEC3;
        const std::vector<float> read = accessors_.numbers(accessor, type);
        for (size_t i = 0; i < read.size(); ++i)
            if (!std::isfinite(read[i])) fail(path, fmt::format("has number {} that is not finite", i));
        return {read.begin(), read.end()};
    }

    /** Makes rotations of unit length; those of a cubic spline stay, for their tangents are given with them. */
    void normaliseRotations(KeyFrames& keys, const std::string& path) const {
        const bool is_cubic = keys.interpolation == Interpolation::CubicSpline;
        for (size_t i = 0; i < keys.times.size(); ++i) {
            double* const q = &keys.values[(is_cubic ? 3 * i + 1 : i) * 4];
            const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
            if (!(length > 1e-6))
                fail(path, fmt::format("has no length at key {}; must be unit quaternions x, y, z, w", i));
            for (int k = 0; k < 4 && !is_cubic; ++k) q[k] /= length;
        }
    }

    [[noreturn]] void fail(const std::string& path, const std::string& message) const {
        throw types::ConfigError(gltf_.name, path, message);
    }

    const GltfFile& gltf_;
    const GltfAccessors& accessors_;
    const std::vector<int>& node_in_scene_;
    const tinygltf::Animation& from_;
    std::string here_;
    GltfAnimations& to_;
    Animation animation_;
};

}  // namespace

GltfSkin readSkin(const GltfFile& gltf, const GltfAccessors& accessors, int skin, const std::string& path) {
    const auto fail = [&](const std::string& where, const std::string& message) {
        throw types::ConfigError(gltf.name, where, message);
    };
    const auto& skins = gltf.model.skins;
    if (skin < 0 || static_cast<size_t>(skin) >= skins.size())
        fail(path, fmt::format("is {}; the file has {} skins", skin, skins.size()));
    const tinygltf::Skin& from = skins[static_cast<size_t>(skin)];
    const std::string here = fmt::format("skins[{}]", skin);
    if (from.joints.empty()) fail(here + ".joints", "is empty; must name one node at least");
    for (size_t i = 0; i < from.joints.size(); ++i) {
        const int joint = from.joints[i];
        if (joint < 0 || static_cast<size_t>(joint) >= gltf.model.nodes.size())
            fail(fmt::format("{}.joints[{}]", here, i),
                 fmt::format("is {}; the file has {} nodes", joint, gltf.model.nodes.size()));
    }
    GltfSkin result{from.joints, std::vector<glm::dmat4>(from.joints.size(), glm::dmat4(1))};
    if (from.inverseBindMatrices < 0) return result;
    if (accessors.componentType(from.inverseBindMatrices) != TINYGLTF_COMPONENT_TYPE_FLOAT)
        fail(here + ".inverseBindMatrices", "are not of componentType 5126; must be floats");
    const size_t count = gltf.model.accessors[static_cast<size_t>(from.inverseBindMatrices)].count;
    if (count < from.joints.size() || count > max_joints)
        fail(here + ".inverseBindMatrices",
             fmt::format("are {}; the skin has {} joints, and may have {}", count, from.joints.size(), max_joints));
    const std::vector<float> numbers = accessors.numbers(from.inverseBindMatrices, TINYGLTF_TYPE_MAT4);
    for (size_t i = 0; i < result.joints.size(); ++i) {
        for (int k = 0; k < 16; ++k)
            result.joint_from_bind[i][k / 4][k % 4] = static_cast<double>(numbers[16 * i + static_cast<size_t>(k)]);
        for (int c = 0; c < 4; ++c) result.joint_from_bind[i][c][3] = c == 3;
        for (int k = 0; k < 16; ++k)
            if (!std::isfinite(result.joint_from_bind[i][k / 4][k % 4]))
                fail(fmt::format("{}.inverseBindMatrices[{}]", here, i), "has a number that is not finite");
    }
    return result;
}

size_t targetCount(const GltfFile& gltf, size_t mesh) {
    const auto& primitives = gltf.model.meshes[mesh].primitives;
    const size_t count = primitives.empty() ? 0 : primitives.front().targets.size();
    for (size_t i = 1; i < primitives.size(); ++i)
        if (primitives[i].targets.size() != count)
            throw types::ConfigError(
                gltf.name, fmt::format("meshes[{}].primitives[{}].targets", mesh, i),
                fmt::format("are {}; those of the mesh's first primitive are {}", primitives[i].targets.size(), count));
    return count;
}

std::vector<double> restWeights(const GltfFile& gltf, const tinygltf::Node& node, const std::string& path) {
    const auto mesh = static_cast<size_t>(node.mesh);
    const size_t count = targetCount(gltf, mesh);
    const bool of_node = !node.weights.empty();
    const std::vector<double>& given = of_node ? node.weights : gltf.model.meshes[mesh].weights;
    const std::string where = of_node ? path + ".weights" : fmt::format("meshes[{}].weights", mesh);
    if (!given.empty() && given.size() != count)
        throw types::ConfigError(gltf.name, where,
                                 fmt::format("has {} numbers; the mesh has {} morph targets", given.size(), count));
    for (const double weight : given)
        if (!std::isfinite(weight)) throw types::ConfigError(gltf.name, where, "has a number that is not finite");
    return given.empty() ? std::vector<double>(count, 0.0) : given;
}

GltfDeformation::GltfDeformation(const GltfFile& gltf, const GltfAccessors& accessors, size_t mesh, size_t joints)
    : gltf_(gltf), accessors_(accessors), joints_(joints) {
    raw_.joint_count = static_cast<uint32_t>(joints);
    raw_.targets.resize(targetCount(gltf, mesh));
    if (joints_ > 0) raw_.share_begin.push_back(0);
}

void GltfDeformation::fail(const std::string& path, const std::string& message) const {
    throw types::ConfigError(gltf_.name, path, message);
}

void GltfDeformation::add(const tinygltf::Primitive& primitive, const std::string& path, size_t count) {
    if (joints_ > 0) addShares(primitive, path, count);
    addTargets(primitive, path, count);
    next_ += static_cast<uint32_t>(count);
}

bool GltfDeformation::addSet(const tinygltf::Primitive& primitive, const std::string& path, int set,
                             std::vector<std::vector<types::JointShare>>& of_vertices) const {
    const std::string joints_name = fmt::format("JOINTS_{}", set), weights_name = fmt::format("WEIGHTS_{}", set);
    const auto joints = primitive.attributes.find(joints_name), weights = primitive.attributes.find(weights_name);
    const auto none = primitive.attributes.end();
    if (joints == none && weights == none) return false;
    if (joints == none || weights == none)
        fail(path + ".attributes", fmt::format("has no {}; a mesh with a skin needs both {} and {}",
                                               joints == none ? joints_name : weights_name, joints_name, weights_name));
    const int type = accessors_.componentType(joints->second);
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
        fail(path + ".attributes." + joints_name,
             fmt::format("has componentType {}; must be 5121 or 5123, indices of joints", type));
    const auto number = accessors_.vectors<glm::vec4>(joints->second);
    const auto weight = accessors_.vectors<glm::vec4>(weights->second);
    for (const auto& [name, size] : {std::pair(joints_name, number.size()), std::pair(weights_name, weight.size())})
        if (size != of_vertices.size())
            fail(path + ".attributes." + name,
                 fmt::format("has {} elements; POSITION has {}", size, of_vertices.size()));
    for (size_t i = 0; i < number.size(); ++i)
        for (int k = 0; k < 4; ++k) {
            if (!(weight[i][k] >= 0) || !std::isfinite(weight[i][k]))
                fail(path + ".attributes." + weights_name,
                     fmt::format("is {} at vertex {}; must be 0 or more", weight[i][k], i));
            if (weight[i][k] == 0) continue;
            if (number[i][k] >= static_cast<float>(joints_))
                fail(path + ".attributes." + joints_name,
                     fmt::format("is {} at vertex {}; the skin has {} joints", number[i][k], i, joints_));
            of_vertices[i].push_back({static_cast<uint32_t>(number[i][k]), weight[i][k]});
        }
    return true;
}

void GltfDeformation::addShares(const tinygltf::Primitive& primitive, const std::string& path, size_t count) {
    std::vector<std::vector<types::JointShare>> of_vertices(count);
    int sets = 0;
    while (addSet(primitive, path, sets, of_vertices)) ++sets;
    if (sets == 0) fail(path + ".attributes", "has no JOINTS_0 and no WEIGHTS_0; a node gives the mesh a skin");
    for (std::vector<types::JointShare>& shares : of_vertices) {
        double sum = 0;
        for (const types::JointShare& share : shares) sum += static_cast<double>(share.weight);
        if (shares.empty()) shares.push_back({0, 1}), ++unweighted_, sum = 1;
        for (const types::JointShare& share : shares)
            raw_.shares.push_back({share.joint, static_cast<float>(static_cast<double>(share.weight) / sum)});
        raw_.share_begin.push_back(static_cast<uint32_t>(raw_.shares.size()));
    }
}

void GltfDeformation::addTargets(const tinygltf::Primitive& primitive, const std::string& path, size_t count) {
    const auto append = [&](size_t target, const char* name, std::vector<glm::vec3>& list) {
        const auto found = primitive.targets[target].find(name);
        const std::string where = fmt::format("{}.targets[{}].{}", path, target, name);
        std::vector<glm::vec3> values;
        if (found != primitive.targets[target].end()) {
            values = accessors_.vectors<glm::vec3>(found->second);
            if (values.size() != count)
                fail(where, fmt::format("has {} elements; POSITION has {}", values.size(), count));
            for (size_t i = 0; i < count; ++i)
                if (!isFiniteVector(values[i])) fail(where, fmt::format("is not a finite number at vertex {}", i));
        }
        if (values.empty() && list.empty()) return;
        list.resize(next_, glm::vec3(0));
        list.insert(list.end(), values.begin(), values.end());
    };
    for (size_t target = 0; target < primitive.targets.size(); ++target) {
        append(target, "POSITION", raw_.targets[target].positions);
        append(target, "NORMAL", raw_.targets[target].normals);
        append(target, "TANGENT", raw_.targets[target].tangents);
    }
}

types::Deformation GltfDeformation::make(const types::Mesh& mesh, const std::vector<uint32_t>& numbers) const {
    types::Deformation result;
    result.positions = mesh.positions;
    result.normals = mesh.normals;
    result.tangents = mesh.tangents;
    result.joint_count = raw_.joint_count;
    if (!raw_.share_begin.empty()) {
        result.share_begin.push_back(0);
        for (const uint32_t number : numbers) {
            for (uint32_t i = raw_.share_begin[number]; i < raw_.share_begin[number + 1]; ++i)
                result.shares.push_back(raw_.shares[i]);
            result.share_begin.push_back(static_cast<uint32_t>(result.shares.size()));
        }
    }
    for (types::MorphTarget target : raw_.targets) {
        for (auto* const list : {&target.positions, &target.normals, &target.tangents}) {
            if (!list->empty()) list->resize(next_, glm::vec3(0));
            *list = reordered(*list, numbers);
        }
        result.targets.push_back(std::move(target));
    }
    return result;
}

GltfAnimations readAnimations(const GltfFile& gltf, const GltfAccessors& accessors,
                              const std::vector<int>& node_in_scene) {
    GltfAnimations result;
    UniqueNames names;
    for (size_t i = 0; i < gltf.model.animations.size(); ++i) {
        Animation animation = AnimationReader(gltf, accessors, node_in_scene, i, result).read();
        const std::string& name = gltf.model.animations[i].name;
        animation.name = names.add(name.empty() ? fmt::format("animation_{}", i) : name);
        result.all.push_back(std::move(animation));
    }
    return result;
}

}  // namespace insonify::scene
