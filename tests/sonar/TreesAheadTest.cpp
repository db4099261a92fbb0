// Trees of a scene at rest are built before the sonar needs them, on another thread, and change no ping.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <thread>

#include "components/sonar/rays/RayVisibility.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Hills.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::sonar {
namespace {

types::GeometryPtr hilly(int cells) {
    return test::makeScene({test::hills(cells), test::sphere(1, 12)}, 0, {{}, {30, 0, -5}});
}

size_t threads() {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return static_cast<size_t>(std::distance(begin(tasks), end(tasks)));
}

std::vector<glm::dvec3> circle(const glm::dvec3& centre, double radius, int turns) {
    std::vector<glm::dvec3> places;
    for (int i = 0; i < 120 * turns; ++i) {
        const double angle = 2 * std::numbers::pi * i / 120;
        places.push_back(centre + radius * glm::dvec3(std::cos(angle), std::sin(angle), 0.3 * std::sin(3 * angle + 1)));
    }
    return places;
}

std::vector<glm::dvec3> line(const glm::dvec3& from, const glm::dvec3& to, double step) {
    std::vector<glm::dvec3> places;
    const double length = glm::distance(from, to);
    for (double way = 0; way <= length; way += step) places.push_back(from + (to - from) * (way / length));
    return places;
}

/** Returns the number of trees that this thread builds after the first ping of a way, where the other thread has all
 *  the time that it needs between pings. */
size_t builtByPings(const types::GeometryPtr& geometry, const std::vector<glm::dvec3>& way) {
    RayVisibility visibility(*geometry);
    visibility.place(test::makeSnapshot(geometry, way.front()));
    const size_t before = StillTree::builtByThisThread();
    for (const glm::dvec3& place : way) {
        visibility.place(test::makeSnapshot(geometry, place));
        EXPECT_TRUE(test::becomesTrue([&] { return visibility.hasTreesAhead(); }));
    }
    return StillTree::builtByThisThread() - before;
}

SonarConfig fan() {
    SonarConfig config = test::getSonar(
        {.beams = 16, .width_deg = 90, .height_deg = 40, .bins = 100, .bin = 0.5, .rows = 32, .columns = 2});
    config.visibility = Visibility::Cpu;
    return config;
}

TEST(TreesAheadTest, PingsBuildNoTreeOnAWayOverBordersAndCorners) {
    const types::GeometryPtr geometry = hilly(40);
    EXPECT_EQ(builtByPings(geometry, circle({256, 256, -5}, 20, 3)), 0u) << "over four cells";
    EXPECT_EQ(builtByPings(geometry, circle({256, 256, -256}, 20, 3)), 0u) << "over eight cells";
    EXPECT_EQ(builtByPings(geometry, circle({256, 100, -256}, 5, 3)), 0u) << "hovers at 256 m depth";
    EXPECT_EQ(builtByPings(geometry, line({-700, 31, -5}, {1100, 31, -5}, 2)), 0u) << "2 m/s at 1 Hz over borders";
    EXPECT_EQ(builtByPings(geometry, line({-100, -90, -5}, {900, 950, -5}, 2)), 0u) << "next to corners";
}

TEST(TreesAheadTest, PingsAreThoseOfNewRenderers) {
    const types::GeometryPtr geometry = hilly(60);
    SonarRenderer renderer(fan(), geometry);
    std::vector<glm::dvec3> way = circle({256, 256, -5}, 12, 1), on = line({200, 240, -5}, {330, 262, -5}, 1.3);
    way.insert(way.end(), on.begin(), on.end());
    for (size_t i = 0; i < way.size(); ++i) {
        const types::Snapshot snapshot = test::makeSnapshot(geometry, way[i], 0.1 * static_cast<double>(i), 0.4);
        types::Sonar ping;
        renderer.render(snapshot, ping);
        if (i % 7 != 0) continue;
        EXPECT_GT(*std::ranges::max_element(ping.bins), 0);
        ASSERT_EQ(ping.bins, test::makePing(fan(), snapshot).bins) << i;
    }
}

/** Processor time of the pings right behind a border: a tree of the floor takes far longer than a ping. */
TEST(TreesAheadTest, NoPingTakesTheTimeOfATree) {
    const types::GeometryPtr geometry = hilly(400);
    SonarRenderer renderer(fan(), geometry, {.threads = 1});
    const double tree = test::processorSeconds([&] {
        RayVisibility(*geometry).place(test::makeSnapshot(geometry, {200, 10, -5}));
    });
    std::vector<double> times;
    double slowest = 0;
    for (const glm::dvec3& place : line({200, 10, -5}, {300, 10, -5}, 0.5)) {
        types::Sonar ping;
        times.push_back(
            test::processorSeconds([&] { renderer.render(test::makeSnapshot(geometry, place, 0, 0.4), ping); }));
        if (std::abs(place.x - 256) < 2) slowest = std::max(slowest, times.back());
        if (place.x > 225 && place.x < 256) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::ranges::nth_element(times, times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2));
    const double median = times[times.size() / 2];
    EXPECT_LT(slowest, median + tree / 2) << "median " << 1e3 * median << " ms, a tree " << 1e3 * tree << " ms";
}

TEST(TreesAheadTest, ASonarAtRestOrThatJumpsStartsNoThread) {
    const types::GeometryPtr geometry = hilly(10);
    RayVisibility visibility(*geometry);
    const size_t before = threads();
    for (int i = 0; i < 5; ++i) visibility.place(test::makeSnapshot(geometry, {255, 255, -5}));
    for (const double x : {-300, 400, 255, 700, 300}) visibility.place(test::makeSnapshot(geometry, {x, 250, -5}));
    for (int i = 0; i < 50; ++i) visibility.place(test::makeSnapshot(geometry, {300 + i, 0.0 + i, -5}));
    EXPECT_EQ(threads(), before) << "nothing to build in the middle of a cell either";
    visibility.place(test::makeSnapshot(geometry, {350, 225, -5}));
    visibility.place(test::makeSnapshot(geometry, {350, 226, -5}));
    EXPECT_EQ(threads(), before + 1);
}

TreesAhead::Objects copies(const types::Mesh& mesh, int count) {
    const auto shared = std::make_shared<const types::Mesh>(mesh);
    return std::make_shared<const std::vector<TreeObject>>(static_cast<size_t>(count),
                                                           TreeObject{shared, glm::dmat4(1), 0});
}

/** Returns how many origins about a corner of eight cells are needed. */
int neededAtACorner(TreesAhead& ahead, const TreesAhead::Objects& objects) {
    ahead.follow({250, 250, -250}, objects);
    ahead.follow({250, 250, -251}, objects);
    int count = 0;
    for (const double x : {0, 512})
        for (const double y : {0, 512})
            for (const double z : {0, -512}) count += ahead.needs({x, y, z});
    return count;
}

TEST(TreesAheadTest, TheNumberOfTrianglesInTreesIsBounded) {
    const types::Mesh mesh = test::hills(100);
    const auto triangles = static_cast<int>(mesh.indices.size() / 3);
    for (const auto& [count, expected] : {std::pair(1, 8), std::pair(16'000'000 / 5 / triangles, 5),
                                          std::pair(16'000'000 / 3 / triangles, 3), std::pair(900, 2)}) {
        TreesAhead ahead;
        EXPECT_EQ(neededAtACorner(ahead, copies(mesh, count)), expected) << count * triangles << " triangles";
        EXPECT_TRUE(ahead.needs({0, 0, 0})) << "its own, the nearest";
    }
}

TEST(TreesAheadTest, AWayAlongTheEdgeOfItsReachAsksOnce) {
    TreesAhead ahead;
    const auto objects = copies(test::hills(4), 1);
    int asked = 0;
    for (int i = 0; i < 100; ++i) asked += ahead.follow({256 - TreesAhead::near + (i % 2 ? 1.0 : -1.0), 0, 0}, objects);
    EXPECT_EQ(asked, 1);
    for (double x = 230; x < 256 + TreesAhead::kept - 1; x += 1) asked += ahead.follow({x, 0, 0}, objects);
    EXPECT_EQ(asked, 1) << "both cells on the whole way";
    for (double x = 256 + TreesAhead::kept - 1; x < 400; x += 1) asked += ahead.follow({x, 0, 0}, objects);
    EXPECT_EQ(asked, 2) << "drops the one behind";
    EXPECT_FALSE(ahead.needs({0, 0, 0}));
}

TEST(TreesAheadTest, OtherObjectsAreAskedForOnce) {
    TreesAhead ahead;
    const types::Mesh mesh = test::hills(4);
    const auto objects = copies(mesh, 2);
    ahead.follow({240, 0, 0}, objects);
    EXPECT_TRUE(ahead.follow({241, 0, 0}, objects));
    const auto same = std::make_shared<const std::vector<TreeObject>>(*objects);
    EXPECT_FALSE(ahead.follow({242, 0, 0}, same)) << "an equal list, as of a scene whose tiles have changed";
    EXPECT_TRUE(ahead.follow({243, 0, 0}, copies(mesh, 3)));
    const auto others = copies(mesh, 4);
    EXPECT_TRUE(ahead.follow({243, 0, 0}, others)) << "it rests, and gives up the trees of objects that are gone";
    EXPECT_FALSE(ahead.needs(originNear({243, 0, 0})));
    EXPECT_FALSE(ahead.follow({243, 0, 0}, others)) << "it rests";
    EXPECT_TRUE(ahead.follow({244, 0, 0}, others));
    EXPECT_TRUE(ahead.follow({-5000, 0, 0}, others)) << "it jumps";
    EXPECT_FALSE(ahead.needs(originNear({244, 0, 0})));
}

TEST(TreesAheadTest, ATreeThatNobodyWaitsForIsGivenUp) {
    const auto objects = copies(test::hills(30), 3);
    const auto tree = StillTree::of(*objects);
    const std::atomic<bool> quits{true};
    EXPECT_THROW(tree->tree(&quits), std::runtime_error);
    EXPECT_NO_THROW(tree->tree()) << "it is built for the next who asks";
}

TEST(TreesAheadTest, TheFirstMotionOfAMovableObjectBuildsNoTree) {
    const types::GeometryPtr geometry = hilly(40);
    for (const bool is_known : {true, false}) {
        types::Snapshot rest = test::makeSnapshot(geometry, {20, 0, -5});
        if (is_known) rest.movable = std::make_shared<const std::vector<uint32_t>>(1, 1u);
        types::Snapshot moved = rest;
        moved.moved = {{1, glm::translate(glm::dmat4(1), {28, 1, -5})}};
        SonarRenderer renderer(fan(), geometry, {.threads = 1});
        types::Sonar ping;
        renderer.render(rest, ping);
        const size_t before = StillTree::builtByThisThread();
        renderer.render(moved, ping);
        EXPECT_EQ(StillTree::builtByThisThread() - before, is_known ? 0u : 1u);
        EXPECT_GT(*std::ranges::max_element(ping.bins), 0);
        EXPECT_EQ(ping.bins, test::makePing(fan(), moved).bins);
    }
}

}  // namespace
}  // namespace insonify::sonar
