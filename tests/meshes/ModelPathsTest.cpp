#include "components/meshes/FileMeshes.hpp"
#include "tests/sdf/SdfFiles.hpp"

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

}  // namespace
}  // namespace insonify::sdf
