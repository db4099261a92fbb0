#include "components/scene/GltfAnimation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "components/scene/GltfDeformation.hpp"
#include "components/scene/UniqueNames.hpp"
#include "types/ConfigError.hpp"

namespace insonify::scene {
namespace {

std::optional<AnimatedPath> pathOf(const std::string& name) {
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
        const auto property = pathOf(channel.target_path);
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
            width = weightsOf(nodes[number], path, number);
        else if (!nodes[number].matrix.empty())
            fail(path + ".target.node", fmt::format("is nodes[{}], which has a matrix; an animated node must have "
                                                    "translation, rotation and scale in its place",
                                                    number));
        const KeyFrames keys = keysOf(channel.sampler, *property, width);
        const int node = node_in_scene_[number];
        if (node < 0) return void(++to_.outside_scene);
        const auto is_same = [&](const Channel& one) { return one.node == node && one.path == *property; };
        if (std::ranges::any_of(animation_.channels, is_same)) return void(++to_.doubled);
        animation_.duration = std::max(animation_.duration, keys.times.back());
        animation_.channels.push_back({node, *property, animation_.keys.size()});
        animation_.keys.push_back(keys);
    }

    size_t weightsOf(const tinygltf::Node& node, const std::string& path, size_t number) const {
        const bool has_mesh = node.mesh >= 0 && static_cast<size_t>(node.mesh) < gltf_.model.meshes.size();
        const size_t count = has_mesh ? targetCount(gltf_, static_cast<size_t>(node.mesh)) : 0;
        if (count == 0)
            fail(path + ".target.path", fmt::format("is weights; nodes[{}] has no mesh with morph targets", number));
        return count;
    }

    KeyFrames keysOf(int number, AnimatedPath property, size_t width) const {
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
        keys.times = timesOf(sampler.input, path + ".input");
        const size_t per_key = keys.interpolation == Interpolation::CubicSpline ? 3 : 1;
        const size_t per_element = property == AnimatedPath::Weights ? 1 : width;
        accessors_.componentType(sampler.output);  // refuses an accessor that does not exist
        const size_t count = gltf_.model.accessors[static_cast<size_t>(sampler.output)].count;
        if (count != keys.times.size() * per_key * width / per_element)  // before a bad count takes memory
            fail(path + ".output",
                 fmt::format("has {} elements; {} keys of {} values need {}", count, keys.times.size(), per_key,
                             keys.times.size() * per_key * width / per_element));
        keys.values = valuesOf(sampler.output, property, path + ".output");
        if (keys.is_rotation) normaliseRotations(keys, path + ".output");
        return keys;
    }

    std::vector<double> timesOf(int accessor, const std::string& path) const {
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

    std::vector<double> valuesOf(int accessor, AnimatedPath property, const std::string& path) const {
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
