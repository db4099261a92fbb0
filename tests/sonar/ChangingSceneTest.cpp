// Scenes that change from ping to ping: the data that a renderer keeps, and pings compared with those of a new
// renderer.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include "components/scene/Bathymetry.hpp"
#include "components/scene/Clusters.hpp"
#include "components/scene/Scene.hpp"
#include "components/sonar/rays/SceneTrees.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/surfaces/MeshFacts.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Needs.hpp"
#include "tests/support/Surfaces.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::sonar {
namespace {

using Random = std::mt19937_64;

double evenly(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

SonarConfig wideFan(int rows = 32, int columns = 2) {
    SonarConfig config;
    config.visibility = Visibility::Cpu;
    config.frequency_khz = 400;
    config.beam_count = 32;
    config.bin_count = 120;
    config.range = 25;
    config.field_of_view_deg = 100;
    config.beam_height_deg = 40;
    config.quality.rows = rows;
    config.quality.columns_per_beam = columns;
    return config;
}

/** Writes a survey of posts 1 m apart, hilly, whose first post is at easting and northing 0. */
std::string survey(const Folder& folder, int columns, int rows) {
    std::vector<float> values;
    for (int row = rows - 1; row >= 0; --row)
        for (int column = 0; column < columns; ++column)
            values.push_back(static_cast<float>(-10 + std::sin(0.31 * column) * std::cos(0.23 * row)));
    std::ofstream(folder / "floor.hdr") << fmt::format(
        "ncols {}\nnrows {}\nxllcenter 0\nyllcenter 0\ncellsize 1\nbyteorder LSBFIRST\n", columns, rows);
    std::ofstream(folder / "floor.flt")
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(float)));
    return (folder / "floor.flt").string();
}

/** A block in the world, and the material of a survey's floor. */
types::GeometryPtr withFloor(const types::GeometryPtr& geometry) {
    scene::Scene scene;
    scene.geometry = geometry;
    scene::Bathymetry::addMaterials(scene, {});
    return scene.geometry;
}

std::unique_ptr<scene::Bathymetry> makeFloor(const std::string& file, double reach, int tile) {
    scene::BathymetryConfig config;
    config.easting = config.northing = 0;
    config.reach = reach;
    config.tile = tile;
    return std::make_unique<scene::Bathymetry>(config, file);
}

std::vector<float> binsWith(SonarRenderer& renderer, const types::Snapshot& snapshot) {
    types::Sonar ping;
    renderer.render(snapshot, ping);
    return ping.bins;
}

size_t threads() {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return static_cast<size_t>(std::distance(begin(tasks), end(tasks)));
}

/** Sonars with one effect each that uses the scene in its own way. */
std::vector<std::pair<std::string, SonarConfig>> sonars() {
    SonarConfig plain = wideFan(), coherent = wideFan(), mirrors = wideFan(), pattern = wideFan(), means = wideFan();
    coherent.speckle.emplace().coherent = true;
    mirrors.multipath.emplace().surface.emplace();
    mirrors.multipath->bounces = 2;
    pattern.beam_pattern.emplace().receive.azimuth.emplace().width_deg = 5;
    means.model = Model::Cerqueira2017;
    return {{"plain", plain}, {"coherent", coherent}, {"mirrors", mirrors}, {"pattern", pattern}, {"means", means}};
}

TEST(ChangingSceneTest, AMissionOverTilesMatchesNewRenderersForEachTile) {
    const Folder folder;
    const std::string file = survey(folder, 120, 700);
    const types::GeometryPtr rest = withFloor(test::makeScene({test::block()}, -10, {{30, -60, -9}}));
    for (const auto& [name, config] : sonars()) {
        const auto floor = makeFloor(file, 30, 6);
        const auto fresh_floor = makeFloor(file, 30, 6);
        std::unique_ptr<SonarRenderer> kept;
        types::GeometryPtr before;
        int changes = 0;
        double received = 0;
        for (double way = 40; way < 660; way += 3) {
            types::Snapshot snapshot = test::makeSnapshot(floor->about({way, -60, -4}, rest), {way, -60, -4}, 0, 0.5);
            snapshot.ahead = floor->ahead();
            snapshot.water_surface = 0;
            if (!kept) kept = std::make_unique<SonarRenderer>(config, snapshot.geometry);
            const bool changed = snapshot.geometry != std::exchange(before, snapshot.geometry);
            changes += changed;
            EXPECT_FALSE(kept->setGeometry(snapshot.geometry)) << "the plan is the same";
            const std::vector<float> bins = binsWith(*kept, snapshot);
            for (const float bin : bins) received += static_cast<double>(bin);
            if (!changed || changes % 7 != 1) continue;
            snapshot.geometry = fresh_floor->about({way, -60, -4}, rest);
            snapshot.ahead = nullptr;
            SonarRenderer anew(config, snapshot.geometry);
            ASSERT_EQ(bins, binsWith(anew, snapshot)) << name << " at " << way;
        }
        EXPECT_GT(changes, 100) << name;
        EXPECT_GT(received, 0) << name;
    }
}

TEST(ChangingSceneTest, ObjectsThatAppearDisappearAndMoveMatchNewRenderers) {
    Random random(8);
    for (const auto& [name, config] : sonars())
        for (int trial = 0; trial < 4; ++trial) {
            auto always = std::make_shared<types::Geometry>(*test::surfaces());
            SonarRenderer kept(config, always);
            for (int step = 0; step < 8; ++step) {
                auto geometry = std::make_shared<types::Geometry>(*always);
                for (size_t mesh = 0; mesh < 3; ++mesh) {
                    if (evenly(random, 0, 1) < 0.4) continue;
                    const glm::dvec3 at(evenly(random, 4, 18), evenly(random, -6, 6), evenly(random, -3, 1));
                    geometry->objects.push_back({fmt::format("new {}", mesh), static_cast<int>(mesh),
                                                 glm::translate(glm::dmat4(1), at), evenly(random, 0, 1) < 0.7});
                }
                types::Snapshot snapshot = test::makeSnapshot(geometry, {0, 0, 0}, evenly(random, -0.5, 0.5));
                snapshot.water_surface = 3;
                snapshot.moved = {{1, glm::translate(glm::dmat4(1), {evenly(random, 6, 12), 2, -1})}};
                kept.setGeometry(geometry);
                SonarRenderer anew(config, geometry);
                ASSERT_EQ(binsWith(kept, snapshot), binsWith(anew, snapshot)) << name << ' ' << trial << ' ' << step;
            }
        }
}

TEST(ChangingSceneTest, AMaterialOfANewObjectChangesThePlanAndThePings) {
    const auto bare = std::make_shared<types::Geometry>(*test::makeScene({test::ground(-4), test::sphere(1, 30)}, -20));
    bare->objects[1].world_from_object = glm::translate(glm::dmat4(1), {8, 0, -1});
    auto shiny = std::make_shared<types::Geometry>(*bare);
    shiny->materials.push_back(shiny->materials[0]);
    shiny->materials[1].lambert_db = 0;
    shiny->materials[1].reflection = 0.8f;
    shiny->materials[1].roughness_slope = 0.1f;
    shiny->meshes[1].clusters[0].material = 1;
    EXPECT_EQ(shiny->meshes.shared(0), bare->meshes.shared(0));
    EXPECT_NE(shiny->meshes.shared(1), bare->meshes.shared(1));
    SonarRenderer kept(wideFan(), bare), of_bare(wideFan(), bare), of_shiny(wideFan(), shiny);
    kept.setQuality(48, 3);
    of_bare.setQuality(48, 3);
    of_shiny.setQuality(48, 3);
    for (int turn = 0; turn < 3; ++turn) {
        EXPECT_EQ(kept.setGeometry(bare), turn > 0);
        EXPECT_EQ(binsWith(kept, test::makeSnapshot(bare)), binsWith(of_bare, test::makeSnapshot(bare)));
        EXPECT_TRUE(kept.setGeometry(shiny));
        EXPECT_EQ(binsWith(kept, test::makeSnapshot(shiny)), binsWith(of_shiny, test::makeSnapshot(shiny)));
        EXPECT_EQ(kept.renderPlan().config.rows(), 48) << "quality is kept";
    }
    EXPECT_NE(binsWith(of_bare, test::makeSnapshot(bare)), binsWith(of_shiny, test::makeSnapshot(shiny)));
}

TEST(ChangingSceneTest, KeepsMeshesTreesAndThreads) {
    const Folder folder;
    const auto floor = makeFloor(survey(folder, 120, 300), 30, 8);
    const types::GeometryPtr rest = withFloor(test::makeScene({test::block()}, -10, {{30, -60, -9}}));
    types::GeometryPtr before = floor->about({60, -60, -4}, rest);
    SonarRenderer renderer(wideFan(), before);
    binsWith(renderer, test::makeSnapshot(before, {60, -60, -4}, 0, 0.5));
    size_t running = 0;
    for (double way = 61; way < 200; way += 1) {
        types::Snapshot snapshot = test::makeSnapshot(floor->about({way, -60, -4}, rest), {way, -60, -4}, 0, 0.5);
        snapshot.ahead = floor->ahead();
        std::vector<std::weak_ptr<MeshFacts>> kept;
        std::vector<std::weak_ptr<MeshTree>> trees;
        for (size_t i = 0; i < before->meshes.size(); ++i) {
            kept.push_back(MeshFacts::of(before->meshes.shared(i)));
            trees.push_back(MeshTree::of(before->meshes.shared(i)));
        }
        renderer.setGeometry(snapshot.geometry);
        binsWith(renderer, snapshot);
        size_t same = 0;
        for (size_t i = 0; i < snapshot.geometry->meshes.size(); ++i)
            for (size_t k = 0; k < before->meshes.size(); ++k)
                if (snapshot.geometry->meshes.shared(i) == before->meshes.shared(k)) {
                    ++same;
                    EXPECT_FALSE(kept[k].expired()) << "the renderer has what was made of the mesh";
                    EXPECT_EQ(MeshFacts::of(snapshot.geometry->meshes.shared(i)), kept[k].lock());
                    EXPECT_EQ(trees[k].expired(), k == 0) << "the block is in the tree of objects at rest";
                }
        EXPECT_GE(same, before->meshes.size() * 2 / 3) << "except the tiles that are left behind";
        if (way > 70 && running == 0) running = threads();
        if (running > 0) {
            EXPECT_EQ(threads(), running);
        }
        before = snapshot.geometry;
    }
}

/** A sonar that chooses its quality. */
struct ChosenQualityTest : test::TaskBench<SonarTask, types::SnapshotPtr, types::SonarPtr> {
    ChosenQualityTest() : TaskBench(&SonarTask::snapshot, &SonarTask::ping) {}
};

TEST_F(ChosenQualityTest, IsKeptForTheNextTile) {
    const Folder folder;
    const auto floor = makeFloor(survey(folder, 120, 300), 30, 8);
    const types::GeometryPtr rest = withFloor(test::makeScene({test::block()}, -10, {{30, -60, -9}}));
    SonarConfig config = wideFan();
    config.quality = {};
    config.quality.target_error = 0.01;
    startWith(config);
    std::set<types::GeometryPtr> scenes;
    std::pair<int, int> chosen;
    for (int i = 0; i < 40; ++i) {
        const glm::dvec3 at(60 + 2.5 * i, -60, -4);
        auto snapshot = std::make_shared<types::Snapshot>(test::makeSnapshot(floor->about(at, rest), at, 0, 0.5));
        snapshot->time.microseconds += 1'000'000 * i;
        scenes.insert(snapshot->geometry);
        ASSERT_TRUE(answerTo(snapshot)) << task_.lastError();
        const types::Plan& plan = *task_.plan();
        if (i == 0) chosen = {plan.rows, plan.columns_per_beam};
        EXPECT_EQ(std::pair(plan.rows, plan.columns_per_beam), chosen) << i;
        EXPECT_EQ(std::ranges::count_if(plan.notices, [](const auto& n) { return n.text.starts_with("quality:"); }), 1)
            << i;
    }
    EXPECT_GT(scenes.size(), 8u);
    const Quality coarsest;
    EXPECT_NE(chosen, std::pair(coarsest.rows, coarsest.columns_per_beam)) << "else nothing could be forgotten";
}

TEST(ChangingSceneTest, TwoSonarsOfAScenesFileHaveItsMeshesAndFactsOnce) {
    INSONIFY_NEEDS("sdf");
    const Folder folder;
    std::ofstream(folder / "box.sdf") << "<sdf version='1.7'><world name='w'><model name='m'><link name='l'><visual "
                                         "name='v'><geometry><box><size>1 1 "
                                         "1</size></box></geometry></visual></link></model></world></sdf>";
    const auto one = scene::sharedScene(folder / "box.sdf"), other = scene::sharedScene(folder / "box.sdf");
    EXPECT_EQ(one, other);
    SonarRenderer first(wideFan(), one->geometry), second(wideFan(16, 2), other->geometry);
    const std::weak_ptr<MeshFacts> facts = MeshFacts::of(one->geometry->meshes.shared(0));
    EXPECT_FALSE(facts.expired());
    std::ofstream(folder / "box.sdf", std::ios::app) << "\n";
    EXPECT_NE(scene::sharedScene(folder / "box.sdf"), one) << "the file has changed";
}

}  // namespace
}  // namespace insonify::sonar
