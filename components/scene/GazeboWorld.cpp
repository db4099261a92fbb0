#include "components/scene/GazeboWorld.hpp"

#include <atomic>
#include <map>
#include <mutex>
#include <tuple>

#include "components/loader/ComponentLibrary.hpp"
#include "components/scene/Scene.hpp"

namespace insonify::scene {
namespace {

std::atomic<WorldReader>& givenReader() {
    static std::atomic<WorldReader> reader = nullptr;
    return reader;
}

/** The reader of the component library. */
WorldReader worldReader() {
    if (const WorldReader given = givenReader()) return given;
    return loader::load("gazebo").entry<void(const GazeboConfig&, const std::filesystem::path&, Scene&)>(
        "insonify_read_world");
}

}  // namespace

void GazeboConfig::check(types::Diagnostics& diagnostics) const {
    if (world.empty()) diagnostics.push_back({"world", "is missing; give the name of a world that Gazebo runs"});
}

std::shared_ptr<const Scene> sharedWorld(const GazeboConfig& config, const std::filesystem::path& folder) {
    using Key = std::tuple<std::string, std::string, std::filesystem::path>;
    static std::mutex mutex;
    static std::map<Key, std::weak_ptr<const Scene>> worlds;
    const Key key(config.world, config.partition, folder);
    const std::lock_guard alone(mutex);
    std::erase_if(worlds, [](const auto& each) { return each.second.expired(); });
    if (const auto known = worlds.find(key); known != worlds.end())
        if (auto scene = known->second.lock()) return scene;
    Scene read;
    worldReader()(config, folder, read);
    noteRounding(read.geometry);
    auto scene = std::make_shared<const Scene>(std::move(read));
    worlds[key] = scene;
    return scene;
}

WorldSonars readWorldSonars(const std::filesystem::path& file) {
    WorldSonars read;
    loader::load("sdf").entry<void(const std::filesystem::path&, WorldSonars&)>("insonify_read_sonars")(file, read);
    return read;
}

std::string requestSdf(const GazeboConfig& config) {
    std::string text;
    loader::load("gazebo").entry<void(const GazeboConfig&, std::string&)>("insonify_request_sdf")(config, text);
    return text;
}

void setWorldReader(WorldReader reader) { givenReader() = reader; }

}  // namespace insonify::scene
