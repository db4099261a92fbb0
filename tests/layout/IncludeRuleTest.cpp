// The include rule of components/README.md, checked in the sources.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/layout/Sources.hpp"

using namespace insonify::layout;

namespace {

/** Folders from which the files of a folder may include. */
const std::map<std::string, std::set<std::string>> neighbours = {
    {"dataset", {"console", "log", "output", "pose"}},
    {"dds", {"ros"}},
    {"device", {"console", "output", "recordings", "sonars"}},  // readJson, ByteFile
    {"framework", {"loader"}},
    {"gazebo", {"meshes", "ros", "scene"}},
    {"log", {"ros"}},
    {"logger", {"log"}},
    {"mavlink", {"device"}},  // its network
    {"meshes", {"loader", "scene"}},
    {"noise", {"acoustics"}},
    {"output", {"loader", "recordings"}},
    {"recordings", {"loader", "receiver"}},  // CodeConfig
    {"replay", {"log"}},
    {"scene", {"acoustics", "loader"}},
    {"sdf", {"meshes", "scene"}},
    {"sonar", {"acoustics", "gpu", "shaders"}},
    {"study", {"acoustics", "noise", "output", "receiver", "recordings", "scene", "sonar"}},
    {"sonars", {"framework"}},
    {"survey", {"scene"}},
    {"video", {"output"}},
    {"viewer", {"console", "ros"}},
    {"worlds", {"console", "loader"}},
};

/** Folders that a file may include from, besides its own and `types`. */
std::set<std::string> getNeighbours(const Source& source) {
    const auto found = neighbours.find(source.folder());
    std::set<std::string> allowed = found == neighbours.end() ? std::set<std::string>() : found->second;
    if (source.isTaskHalf()) allowed.insert("framework");
    if (source.isCommandHalf()) allowed.insert("console");
    const std::set<std::string> pose_listeners = {"dds", "gazebo", "mavlink"};
    if (source.isTaskHalf() && pose_listeners.contains(source.folder())) allowed.insert("pose");
    return allowed;
}

/** "pocolog" for components/log/pocolog/...: a format of logs; empty for the common part. */
std::string backEnd(const Source& source) {
    const std::string log = "components/log/";
    const size_t end = source.path.find('/', log.size());
    return source.path.starts_with(log) && end != std::string::npos ? source.path.substr(log.size(), end - log.size())
                                                                    : "";
}

/** Log formats are hidden behind the common part: no other folder includes a format, and no format includes another. */
bool reachesBehindTheLog(const Source& source, const Source& target) {
    const std::string own = backEnd(source), wanted = backEnd(target);
    return !wanted.empty() && (source.folder() != "log" || (!own.empty() && own != wanted));
}

/** Whether files of this kind may include everything but the program. */
bool mayIncludeAll(const Source& source) {
    const std::set<std::string> all{"command", "deployer", "python"};
    return all.contains(source.folder()) || source.isLibraryEntry() || source.isCommandHalf();
}

bool mayInclude(const Source& source, const Source& target) {
    const std::string from = source.folder(), to = target.folder();
    if (reachesBehindTheLog(source, target) || (to == "command" && from != "command")) return false;
    if (mayIncludeAll(source)) return true;
    if (from == to)
        return from == "framework" || source.isTaskHalf() || !(target.isTaskHalf() || target.isCommandHalf());
    const std::set<std::string> of_any_program = {"Thread"};
    if (to == "types") return from != "gpu" || of_any_program.contains(target.stem());
    if ((from == "study" || from == "dataset") && target.isTaskHalf()) return false;
    return from != "types" && from != "gpu" && getNeighbours(source).contains(to);
}

std::vector<Source> ourSources() {
    std::vector<Source> all = sourcesIn("components", {".hpp", ".cpp"});
    for (Source& source : sourcesIn("types", {".hpp", ".cpp"})) all.push_back(std::move(source));
    return all;
}

}  // namespace

TEST(IncludeRuleTest, ComponentsMeetInTypesOnly) {
    for (const Source& source : ourSources())
        for (const Include& include : includes(source))
            EXPECT_TRUE(!include.ours || mayInclude(source, {include.target, {}}))
                << source.path << " includes " << include.target;
}

TEST(IncludeRuleTest, EveryThirdPartyPackageHasItsHomes) {
    const std::multimap<std::string, std::string> homes = {
        {"tiny_gltf.h", "scene"},
        {"meshoptimizer.h", "scene"},
        {"stb", "scene"},
        {"opencv2/", "output"},
        {"EGL/", "gpu"},
        {"GL/", "gpu"},
        {"epoxy/", "gpu"},
        {"yaml-cpp/", "framework"},
        {"yaml-cpp/", "log"},
        {"CLI/", "command"},
        {"CLI/", "dataset"},
        {"CLI/", "device"},
        {"CLI/", "study"},
        {"nlohmann/", "console"},
        {"CLI/", "console"},
        {"nlohmann/", "viewer"},
        {"boost/", "viewer"},
        {"embree4/", "sonar"},
        {"embree3/", "sonar"},
        {"sdf/", "sdf"},
        {"assimp/", "meshes"},
        {"tinyxml2.h", "sdf"},
        {"lz4frame.h", "log"},
        {"zstd.h", "log"},
        {"sqlite3.h", "log"},
        {"GeographicLib/", "types"},
        {"dds/", "dds"},
        {"png.h", "output"},
        {"boost/", "device"},
        {"nlohmann/", "device"},
        {"snappy.h", "device"},
        {"zmq", "gazebo"},
        {"stb", "meshes"},
        {"gdal", "survey"},
        {"opencv2/", "video"},
        {"opencv2/", "study"},
        {"google/protobuf/", "gazebo"},
    };
    const auto livesIn = [&](const std::string& prefix, const std::string& folder) {
        const auto [first, last] = homes.equal_range(prefix);
        return std::any_of(first, last, [&](const auto& home) { return home.second == folder; });
    };
    for (const Source& source : ourSources())
        for (const Include& include : includes(source))
            for (const auto& [prefix, home] : homes)
                EXPECT_TRUE(include.ours || !include.target.starts_with(prefix) || livesIn(prefix, source.folder()))
                    << source.path << " includes " << include.target;
}

TEST(IncludeRuleTest, TheRuleRefusesWhatItShould) {
    const auto allowed = [](const char* from, const char* to) { return mayInclude({from, {}}, {to, {}}); };
    EXPECT_FALSE(allowed("components/noise/Speckle.hpp", "components/framework/Port.hpp"));
    EXPECT_FALSE(allowed("components/noise/NoiseTask.hpp", "components/sonar/Plan.hpp"));
    EXPECT_FALSE(allowed("components/noise/Speckle.cpp", "components/noise/NoiseTask.hpp"));
    EXPECT_FALSE(allowed("types/samples/Sonar.hpp", "components/gpu/Context.hpp"));
    EXPECT_FALSE(allowed("components/gpu/Context.hpp", "types/samples/Sonar.hpp"));
    EXPECT_TRUE(allowed("components/gpu/Context.cpp", "types/Thread.hpp"));
    EXPECT_FALSE(allowed("components/noise/NoiseTask.cpp", "components/log/Reader.hpp"));
    EXPECT_FALSE(allowed("components/study/error/ErrorStudy.cpp", "components/sonar/tasks/PingTask.hpp"));
    EXPECT_TRUE(allowed("components/study/error/ErrorStudy.cpp", "components/sonar/renderer/SonarRenderer.hpp"));
    EXPECT_TRUE(allowed("components/study/commands/ErrorCommand.cpp", "components/console/Json.hpp"));
    EXPECT_TRUE(allowed("components/study/commands/ErrorCommand.cpp", "components/study/error/ErrorStudy.hpp"));
    EXPECT_FALSE(allowed("components/study/error/ErrorStudy.cpp", "components/console/Json.hpp"));
    EXPECT_FALSE(allowed("components/study/error/ErrorStudy.cpp", "components/study/commands/StudyCommand.hpp"));
    EXPECT_TRUE(allowed("components/study/commands/ErrorCommand.cpp", "components/deployer/Pipeline.hpp"));
    EXPECT_FALSE(allowed("components/console/Json.cpp", "components/framework/Port.hpp"));
    EXPECT_FALSE(allowed("components/noise/NoiseTask.cpp", "components/console/Json.hpp"));
    EXPECT_TRUE(allowed("components/noise/NoiseTask.cpp", "components/noise/Speckle.hpp"));
    EXPECT_TRUE(allowed("components/noise/Noise.cpp", "components/acoustics/AmbientNoise.hpp"));
    EXPECT_FALSE(allowed("components/acoustics/Water.hpp", "components/sonar/config/SonarConfig.hpp"));
    EXPECT_FALSE(allowed("components/receiver/Receiver.cpp", "components/acoustics/Water.hpp"));
    EXPECT_FALSE(allowed("components/ros/Cdr.hpp", "components/log/Writer.hpp"));
    EXPECT_FALSE(allowed("components/logger/LoggerTask.cpp", "components/log/pocolog/Writer.hpp"));
    EXPECT_FALSE(allowed("components/command/LogCommand.cpp", "components/log/mcap/Reader.hpp"));
    EXPECT_FALSE(allowed("components/python/Interface.cpp", "components/command/RunCommand.hpp"));
    EXPECT_FALSE(allowed("components/deployer/log/Import.cpp", "components/command/Summary.hpp"));
    EXPECT_FALSE(allowed("components/log/mcap/Reader.cpp", "components/log/pocolog/Wire.hpp"));
    EXPECT_TRUE(allowed("components/log/Reader.cpp", "components/log/pocolog/Reader.hpp"));
    EXPECT_TRUE(allowed("components/log/pocolog/Reader.cpp", "components/log/Reader.hpp"));
    EXPECT_FALSE(allowed("components/viewer/Server.cpp", "components/framework/Port.hpp"));
    EXPECT_TRUE(allowed("components/dataset/Store.cpp", "components/console/Json.hpp"));
    EXPECT_FALSE(allowed("components/dataset/Samples.cpp", "components/framework/config/ConfigReader.hpp"));
    EXPECT_FALSE(allowed("components/dataset/SampleFiles.cpp", "components/output/FanImageTask.hpp"));
    EXPECT_TRUE(allowed("components/viewer/Messages.cpp", "components/ros/Cdr.hpp"));
    EXPECT_TRUE(allowed("components/logger/LoggerTask.cpp", "components/log/Writer.hpp"));
    EXPECT_TRUE(allowed("components/log/mcap/SampleWriter.cpp", "components/ros/Cdr.hpp"));
    EXPECT_FALSE(allowed("components/dds/Node.cpp", "components/framework/Port.hpp"));
    EXPECT_TRUE(allowed("components/dds/Node.cpp", "components/ros/Cdr.hpp"));
    EXPECT_TRUE(allowed("components/gazebo/PoseTask.hpp", "components/pose/ListenerTask.hpp"));
    EXPECT_FALSE(allowed("components/gazebo/Subscriptions.hpp", "components/pose/Trajectory.hpp"));
    EXPECT_TRUE(allowed("components/sonar/renderer/SonarRenderer.cpp", "components/gpu/Context.hpp"));
    EXPECT_TRUE(allowed("components/command/main.cpp", "components/noise/NoiseTask.hpp"));
}
