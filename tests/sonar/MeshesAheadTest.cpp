#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "components/sonar/rays/SceneTrees.hpp"
#include "components/sonar/surfaces/MeshFacts.hpp"
#include "components/study/Shapes.hpp"
#include "tests/support/Priorities.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::sonar {
namespace {

/** Returns the schedulings of all threads of this process. */
std::vector<int> policies() {
    std::vector<int> all;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
        all.push_back(sched_getscheduler(std::stoi(task.path().filename().string())));
    return all;
}

types::MeshPtr getMesh(int rings) { return std::make_shared<const types::Mesh>(study::sphere(5, rings)); }

/** Laws of one material without a lobe. */
MaterialLaws laws() {
    MaterialLaws laws;
    laws.records.resize(1);
    return laws;
}

double seconds(const auto& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(MeshesAheadTest, ItsThreadHasNoRealtimePriority) {
    bool permitted = false;
    std::vector<int> found;
    std::thread([&] {
        permitted = test::useFifo(5);
        MeshesAhead ahead;
        ahead.take(std::make_shared<const std::vector<types::MeshPtr>>(1, getMesh(10)), laws());
        test::becomesTrue([&] {
            found = policies();
            return std::ranges::count(found, SCHED_FIFO) == 1;
        });
    }).join();
    if (!permitted) GTEST_SKIP() << "SKIPPED: SCHED_FIFO is not permitted";
    EXPECT_EQ(std::ranges::count(found, SCHED_FIFO), 1) << "only the caller";
    EXPECT_GE(found.size(), 3u);
}

TEST(MeshesAheadTest, ItsEndWaitsForOneMeshOnly) {
    std::vector<types::MeshPtr> meshes;
    for (int i = 0; i < 60; ++i) meshes.push_back(getMesh(100));
    const types::MeshPtr other = getMesh(100);
    const double one = seconds([&] {
        MeshTree(other).tree();
        MeshFacts facts(other);
        facts.triangles(), facts.planes(), facts.curves(glm::dmat3(1));
    });
    const double end = seconds([&] {
        MeshesAhead ahead;
        ahead.take(std::make_shared<const std::vector<types::MeshPtr>>(meshes), laws());
    });
    EXPECT_LT(end, 20 * one) << "of 60 meshes";
}

}  // namespace
}  // namespace insonify::sonar
