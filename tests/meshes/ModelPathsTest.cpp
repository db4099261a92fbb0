#include <gmock/gmock.h>
#include <sys/stat.h>

#include "components/meshes/ModelPaths.hpp"
#include "tests/sdf/SdfFiles.hpp"
#include "tests/support/Draw.hpp"

namespace insonify::sdf {

using namespace scene;
namespace {

struct ModelPathsTest : SdfFiles {
    ModelPathsTest() {
        for (const char* folder : {"one", "two", "gazebo", "sdf", "world"})
            std::filesystem::create_directories(folder_ / folder);
    }
    std::string at(const std::string& path) const { return (folder_ / path).string(); }
    std::string find(const std::string& uri, const std::string& named_in = "world/a.world") const {
        const auto found = meshes::ModelPaths(folder_ / "world/a.world").find(uri, folder_ / named_in);
        return found ? found->lexically_relative(folder_).string() : "";
    }
};

TEST_F(ModelPathsTest, SearchesFoldersInTheOrderOfTheVariablesAndTheWorldLast) {
    const Variable ours("INSONIFY_MODEL_PATH", at("one") + "::" + at("two")), gazebo("GAZEBO_MODEL_PATH", at("gazebo")),
        sdf("SDF_PATH", at("sdf"));
    for (const char* folder : {"world", "sdf", "gazebo", "two", "one"}) {
        std::filesystem::create_directories(folder_ / folder / "buoy");
        EXPECT_EQ(find("model://buoy"), std::string(folder) + "/buoy");
    }
}

TEST_F(ModelPathsTest, AnIncludeFollowsTheSameOrder) {
    const Variable ours("INSONIFY_MODEL_PATH", at("one")), sdf("SDF_PATH", at("sdf"));
    writeModel("sdf/buoy", model("from_sdf_path", box_));
    writeModel("one/buoy", model("from_insonify", box_));
    const Scene scene = world("<include><uri>model://buoy</uri></include>");
    EXPECT_GE(findNode(scene, "from_insonify"), 0);
}

TEST_F(ModelPathsTest, FindsFileUrisAndPaths) {
    write("world/a.dae", "");
    write("one/b.dae", "");
    const Variable ours("INSONIFY_MODEL_PATH", at("one"));
    EXPECT_EQ(find("file://" + at("one/b.dae")), "one/b.dae");
    EXPECT_EQ(find(at("one/b.dae")), "one/b.dae");
    EXPECT_EQ(find("file://b.dae"), "one/b.dae");
    EXPECT_EQ(find("a.dae"), "world/a.dae");
    EXPECT_EQ(find("../one/b.dae"), "world/../one/b.dae");
    EXPECT_EQ(find("b.dae", "one/model.sdf"), "one/b.dae");
    for (const char* uri :
         {"", "model://", "model://none", "file:///none", "https://fuel.gazebosim.org/b.dae", "c.dae"})
        EXPECT_EQ(find(uri), "") << uri;
}

TEST_F(ModelPathsTest, FilesOutsideOfThePlacesAreNotFound) {
    for (const char* file : {"world/own.dae", "world/sub/own.dae", "one/a.dae", "secret.dae", "source/b.dae"})
        write(file, "");
    std::filesystem::create_symlink(folder_ / "secret.dae", folder_ / "world/link.dae");
    std::filesystem::create_symlink(folder_ / "source/b.dae", folder_ / "one/b.dae");
    EXPECT_EQ(find("sub/../own.dae"), "world/sub/../own.dae");
    EXPECT_EQ(find(at("world/own.dae")), "world/own.dae");
    for (const std::string& uri : {std::string("../secret.dae"), at("secret.dae"), "file://" + at("secret.dae"),
                                   std::string("model://../secret.dae"), std::string("%2e%2e/secret.dae"),
                                   std::string("sub/../../secret.dae"), std::string("link.dae"), at("one/a.dae")})
        EXPECT_EQ(find(uri), "") << uri;
    EXPECT_THAT(meshes::ModelPaths(folder_ / "world/a.world").searched("x"),
                testing::HasSubstr("files outside of these are not read"));
    const meshes::ModelPaths anywhere(folder_ / "world/a.world", meshes::ModelPaths::Reach::Anywhere);
    EXPECT_EQ(anywhere.find(at("secret.dae"), {}), folder_ / "secret.dae") << "as a Gazebo that runs names it";
    const Variable ours("INSONIFY_MODEL_PATH", at("one"));
    EXPECT_EQ(find(at("one/a.dae")), "one/a.dae");
    EXPECT_EQ(find("b.dae"), "one/b.dae") << "a link in a folder of the user, as colcon --symlink-install makes it";
    EXPECT_EQ(find("model://../secret.dae"), "");
    // A pipe or a device in the folder would be waited for.
    ASSERT_EQ(mkfifo((folder_ / "world/pipe.dae").c_str(), 0600), 0);
    EXPECT_EQ(find("pipe.dae"), "");
}

TEST_F(ModelPathsTest, APathWithPercentSignsIsTriedAsItStandsThenDecoded) {
    write("world/10% b.dae", "");
    write("world/c d.dae", "");
    write("world/c%20d.dae", "");
    EXPECT_EQ(find("10% b.dae"), "world/10% b.dae");
    EXPECT_EQ(find("c%20d.dae"), "world/c%20d.dae");
    std::filesystem::remove(folder_ / "world/c%20d.dae");
    EXPECT_EQ(find("c%20d.dae"), "world/c d.dae");
    for (const char* uri : {"%", "%2", "%zz", "%00"}) EXPECT_EQ(find(uri), "") << uri;
}

TEST_F(ModelPathsTest, PackagesOfRosAreFoundInInstalledPrefixesAndInSources) {
    write("install/share/hull/meshes/a.dae", "");
    write("ws/src/deep/er/keel/package.xml", "<package><name> keel </name></package>");
    write("ws/src/deep/er/keel/b.dae", "");
    write("ws/src/other_folder/package.xml", "<package><name>rudder</name></package>");
    write("ws/src/other_folder/c.dae", "");
    EXPECT_EQ(find("package://keel/b.dae"), "");
    const Variable ament("AMENT_PREFIX_PATH", at("none") + ":" + at("install")), ros("ROS_PACKAGE_PATH", at("ws/src"));
    for (const char* scheme : {"package://", "model://"}) {
        EXPECT_EQ(find(std::string(scheme) + "hull/meshes/a.dae"), "install/share/hull/meshes/a.dae");
        EXPECT_EQ(find(std::string(scheme) + "keel/b.dae"), "ws/src/deep/er/keel/b.dae");
        EXPECT_EQ(find(std::string(scheme) + "rudder/c.dae"), "ws/src/other_folder/c.dae");
        EXPECT_EQ(find(std::string(scheme) + "other_folder/c.dae"), "") << "its name is another";
    }
}

TEST_F(ModelPathsTest, AWorldInARepositoryFindsItsModelsAndPackages) {
    write("repo/worlds/models/crate/model.sdf", "");
    write("repo/worlds/here/w.world", "");
    write("repo/rov_description/package.xml", "<package><name>rov_description</name></package>");
    write("repo/rov_description/meshes/rov.dae", "");
    write("outside.dae", "");
    const auto found = [&](const std::string& uri) {
        const auto at =
            meshes::ModelPaths(folder_ / "repo/worlds/here/w.world").find(uri, folder_ / "repo/worlds/here/w.world");
        return at ? at->lexically_relative(folder_).string() : "";
    };
    EXPECT_EQ(found("model://crate"), "") << "without a root nothing above the world is searched";
    std::filesystem::create_directories(folder_ / "repo/.git");
    EXPECT_EQ(found("model://crate"), "repo/worlds/models/crate");
    EXPECT_EQ(found("package://rov_description/meshes/rov.dae"), "repo/rov_description/meshes/rov.dae");
    write("repo/objects/far/below/buoy/model.config", "");
    write("repo/objects/far/below/buoy/meshes/b.dae", "");
    EXPECT_EQ(found("model://outside.dae"), "");
    EXPECT_EQ(found("model://buoy"), "repo/objects/far/below/buoy");
    EXPECT_EQ(found("buoy"), "repo/objects/far/below/buoy") << "as some includes name it";
    EXPECT_EQ(found("model://buoy/meshes/b.dae"), "repo/objects/far/below/buoy/meshes/b.dae");
    EXPECT_EQ(found("buoy/meshes/b.dae"), "") << "a relative path";
    EXPECT_EQ(found("model://here"), "repo/worlds/here");
    EXPECT_EQ(found("model://worlds_"), "");
}

TEST_F(ModelPathsTest, PackagesThatAreLinkedIntoAWorkspaceAreFoundAndBuildFoldersAreNotSearched) {
    write("elsewhere/hull/package.xml", "<name>hull</name>");
    write("elsewhere/hull/a.dae", "");
    write("ws/build/CMakeCache.txt", "");
    write("ws/build/copy/package.xml", "<name>keel</name>");
    write("ws/build/copy/b.dae", "");
    write("ws/src/deep/keel/package.xml", "<name>keel</name>");
    write("ws/src/deep/keel/b.dae", "");
    std::filesystem::create_directory_symlink(folder_ / "elsewhere/hull", folder_ / "ws/src/hull");
    std::filesystem::create_directory_symlink(folder_ / "ws", folder_ / "ws/src/circle");
    const Variable ros("ROS_PACKAGE_PATH", at("ws"));
    EXPECT_EQ(find("package://hull/a.dae"), "ws/src/hull/a.dae");
    EXPECT_EQ(find("package://keel/b.dae"), "ws/src/deep/keel/b.dae");
}

TEST_F(ModelPathsTest, ModelsOfFuelAreTakenFromGazebosCaches) {
    const Variable home("HOME", at("home"));
    const std::string cache = "home/.gz/fuel/fuel.gazebosim.org/openrobotics/models/";
    for (const char* version : {"2", "9", "10", "x"}) write(cache + "cave circle 01/" + version + "/model.config", "");
    write(cache + "cave circle 01/9/meshes/a.dae", "");
    write("home/.ignition/fuel/fuel.ignitionrobotics.org/someone/models/old/1/model.config", "");
    const std::string url = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Cave%20Circle%2001";
    EXPECT_EQ(find(url), cache + "cave circle 01/10") << "the newest";
    EXPECT_EQ(find(url + "/tip"), cache + "cave circle 01/10");
    EXPECT_EQ(find(url + "/2"), cache + "cave circle 01/2");
    EXPECT_EQ(find(url + "/9/files/meshes/a.dae"), cache + "cave circle 01/9/meshes/a.dae");
    EXPECT_EQ(find(url + "/9/files/meshes/b.dae"), "");
    EXPECT_EQ(find("https://fuel.gazebosim.org/1.0/Someone/models/Old"),
              "home/.ignition/fuel/fuel.ignitionrobotics.org/someone/models/old/1")
        << "from the cache of its former host";
    EXPECT_EQ(find("https://app.gazebosim.org/OpenRobotics/fuel/models/Cave%20Circle%2001"),
              cache + "cave circle 01/10")
        << "as the page of the model has it";
    for (const char* uri :
         {"https://", "https://a/models", "https://a/b/models/", "https://fuel.gazebosim.org/1.0/x/models/y",
          "http://a/b/c/d/e", "https://a/../../models/b"})
        EXPECT_EQ(find(uri), "") << uri;
    const Variable named("GZ_FUEL_CACHE_PATH", at("cache"));
    write("cache/fuel.gazebosim.org/openrobotics/models/cave circle 01/3/model.config", "");
    EXPECT_EQ(find(url), "cache/fuel.gazebosim.org/openrobotics/models/cave circle 01/3");
}

TEST_F(ModelPathsTest, AModelOfFuelMayNameItsFilesByItsOwnName) {
    write("post/2/model.config", "");
    write("post/2/meshes/a.dae", "");
    EXPECT_EQ(find("model://post/meshes/a.dae", "post/2/model.sdf"), "post/2/meshes/a.dae");
    EXPECT_EQ(find("model://post/meshes/b.dae", "post/2/model.sdf"), "");
    EXPECT_EQ(find("model://crate", "post/2/model.sdf"), "") << "a missing model is not the one that names it";
}

/** Random trees of packages, models and caches, of which some are missing: what is there is found, and nothing else. */
TEST_F(ModelPathsTest, WhatIsThereIsFoundInRandomTrees) {
    const test::Seeds seeds(30);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        test::Draw draw(seed);
        const std::string root = "tree" + std::to_string(seed) + "/";
        std::map<std::string, std::string> there;  // file by uri
        for (int i = 0; i < 12; ++i) {
            const std::string name = "p" + std::to_string(i), file = name + ".dae";
            std::string place = root + "src/";
            for (int depth = draw.upTo(4); depth > 0; --depth)
                place += std::string(1, static_cast<char>('a' + depth)) + "/";
            if (draw.once(3)) continue;  // is missing
            if (draw.once(2)) {
                write(place + name + "/package.xml", "<name>" + name + "</name>");
                there["package://" + name + "/" + file] = place + name + "/" + file;
            } else {
                place = root + "models/";
                there["model://" + name + "/" + file] = place + name + "/" + file;
            }
            write(place + name + "/" + file, "");
        }
        const Variable ros("ROS_PACKAGE_PATH", at(root + "src")), models("GAZEBO_MODEL_PATH", at(root + "models"));
        for (int i = 0; i < 12; ++i)
            for (const char* scheme : {"package://", "model://"}) {
                const std::string name = "p" + std::to_string(i), rest = name + "/" + name + ".dae";
                const auto a = there.find("package://" + rest), b = there.find("model://" + rest);
                const std::string expected = a != there.end() ? a->second : b != there.end() ? b->second : "";
                EXPECT_EQ(find(scheme + rest), expected) << seed;
            }
    }
}

}  // namespace
}  // namespace insonify::sdf
