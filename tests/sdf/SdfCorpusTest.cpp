// Worlds, models and a sea floor from other sources, in the shared folder.
#include "tests/sdf/SdfFiles.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::sdf {

using namespace scene;
namespace {

const std::filesystem::path shared_data = test::shared_data;
const std::filesystem::path sdf_data = shared_data / "sdf";

struct SdfCorpusTest : SdfFiles {
    void SetUp() override {
        if (!std::filesystem::is_directory(sdf_data))
            GTEST_SKIP() << "NO WORLDS AT " << sdf_data << ": NOTHING WAS TESTED";
    }
    Variable models_{"INSONIFY_MODEL_PATH",
                     (sdf_data / "uuv/models").string() + ":" + (sdf_data / "dave/models").string()};
};

TEST_F(SdfCorpusTest, EveryWorldLoads) {
    size_t worlds = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(sdf_data)) {
        if (entry.path().extension() != ".world") continue;
        SCOPED_TRACE(entry.path());
        const auto geometry = loadScene(entry.path());
        expectSound(*geometry);
        EXPECT_FALSE(geometry->objects.empty());
        ++worlds;
    }
    EXPECT_GE(worlds, 7u);
}

TEST_F(SdfCorpusTest, EveryModelLoads) {
    size_t loaded = 0, mended = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(sdf_data)) {
        if (entry.path().extension() != ".sdf") continue;
        SCOPED_TRACE(entry.path());
        const auto geometry = loadScene(entry.path());
        expectSound(*geometry);
        ++loaded;
        mended += hasNotice(*geometry, "read without what a sonar does not need: line 7: ");
    }
    EXPECT_GE(loaded, 17u);
    EXPECT_EQ(mended, 2u);  // the two vases: a pose of three numbers
}

TEST_F(SdfCorpusTest, TheWorldsWithoutTheirModelsLoadWithNotices) {
    const Variable none("INSONIFY_MODEL_PATH", "");
    const auto geometry = loadScene(sdf_data / "uuv/worlds/munkholmen.world");
    EXPECT_TRUE(hasNotice(*geometry, "munkholmen.world:85: "));
    EXPECT_TRUE(hasNotice(*geometry, "an empty sea"));
}

TEST_F(SdfCorpusTest, TheCinderBlockInInchesHasItsSizeInMetres) {
    const Bounds bounds = getBounds(*loadScene(sdf_data / "dave/models/mossy_cinder_block/model.sdf"));
    const glm::dvec3 inches(51.36, 24, 24);  // of the .dae; the visual scales it by 1.1
    EXPECT_LT(glm::distance(bounds.high - bounds.low, inches * 0.0254 * 1.1), 1e-6);
}

TEST_F(SdfCorpusTest, TheIncludePoseMovesMangaliaToItsPlace) {
    const Bounds alone = getBounds(*loadScene(sdf_data / "uuv/models/mangalia/model.sdf"));
    const Scene scene = readScene(sdf_data / "uuv/worlds/mangalia.world");
    const auto& objects = scene.geometry->objects;
    Bounds placed;
    for (const types::Object& object : objects)
        if (object.name.starts_with("mangalia_terrain")) {
            const Bounds one = getBounds(*scene.geometry, object);
            placed = {glm::min(placed.low, one.low), glm::max(placed.high, one.high)};
        }
    const glm::dvec3 shift(-572.0074568380, 537.7086925743, 0);
    expectBounds(placed, alone.low + shift, alone.high + shift);
}

TEST_F(SdfCorpusTest, ARealSeaFloorOfSixteenBitsHasItsRelief) {
    const std::filesystem::path picture = shared_data / "bathymetry/navo_tile_257_16bit.png";
    if (!std::filesystem::exists(picture)) GTEST_SKIP() << "NO PICTURE AT " << picture << ": NOTHING WAS TESTED";
    const Variable of_data("INSONIFY_MODEL_PATH", picture.parent_path().string());
    const auto geometry = world(model("floor", "<heightmap><uri>file://" + picture.string() +
                                                   "</uri><size>512 512 0.975</size></heightmap>"))
                              .geometry;
    expectSound(*geometry);
    EXPECT_EQ(geometry->triangleCount(), 2u * 256 * 256);
    expectBounds(getBounds(*geometry), {-256, -256, 0}, {256, 256, 0.975});
}

}  // namespace
}  // namespace insonify::sdf
