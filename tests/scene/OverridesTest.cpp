#include "components/scene/Acoustics.hpp"
#include "tests/scene/SceneFiles.hpp"

namespace insonify::scene {
namespace {

struct OverridesTest : SceneFiles {
    /** Two walls of one mesh and material, the second below a group. */
    Scene walls() const {
        return readScene(write("walls.gltf", gltf(R"("scenes":[{"nodes":[0,1]}],
            "nodes":[{"mesh":0,"name":"near"},{"name":"group","children":[2]},{"mesh":0,"name":"far"}],
            "materials":[{"name":"stone"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)" +
                                                  triangle())));
    }
    static Acoustics lambert(double db) {
        Acoustics acoustics;
        acoustics.lambert_db = db;
        return acoustics;
    }
    static float getLambert(const types::Geometry& geometry, size_t object) {
        const types::Mesh& mesh = geometry.meshes.at(static_cast<size_t>(geometry.objects.at(object).mesh));
        return geometry.materials.at(static_cast<size_t>(mesh.clusters.at(0).material)).lambert_db;
    }
    types::Diagnostics diagnostics_;
};

TEST_F(OverridesTest, WithoutAnyTheGeometryIsTheSame) {
    const Scene scene = walls();
    EXPECT_EQ(overrideMaterials(scene, {}, diagnostics_), scene.geometry);
}

TEST_F(OverridesTest, AMaterialChangesInAllMeshes) {
    const auto geometry = overrideMaterials(walls(), {{"stone", lambert(-9)}}, diagnostics_);
    EXPECT_TRUE(diagnostics_.empty());
    EXPECT_FLOAT_EQ(getLambert(*geometry, 0), -9);
    EXPECT_FLOAT_EQ(getLambert(*geometry, 1), -9);
}

TEST_F(OverridesTest, AModelOverridesItsSubtreeAndPrecedesItsMaterial) {
    const auto geometry = overrideMaterials(walls(), {{"group", lambert(-3)}, {"stone", lambert(-9)}}, diagnostics_);
    EXPECT_TRUE(diagnostics_.empty());
    expectSound(*geometry);
    EXPECT_FLOAT_EQ(getLambert(*geometry, 0), -9);
    EXPECT_FLOAT_EQ(getLambert(*geometry, 1), -3);
}

TEST_F(OverridesTest, AnUnknownNameIsADiagnosticThatListsTheKnown) {
    overrideMaterials(walls(), {{"stoone", lambert(-9)}}, diagnostics_);
    ASSERT_EQ(diagnostics_.size(), 1u);
    EXPECT_EQ(diagnostics_[0].path, "materials.stoone");
    EXPECT_NE(diagnostics_[0].message.find("may be far, group, near, stone"), std::string::npos)
        << diagnostics_[0].message;
}

}  // namespace
}  // namespace insonify::scene
