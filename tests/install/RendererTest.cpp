// A program outside of the tree that renders a ping, with neither the framework nor yaml-cpp.
#include <gmock/gmock.h>

#include "tests/install/Outside.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;
using testing::Not;

namespace {

const char* const program = R"(#include <cstdio>
#include <memory>

#include "components/sonar/renderer/SonarRenderer.hpp"
using namespace insonify;

int main() {
    types::Mesh wall;  // square to the sonar, 10 m ahead
    wall.positions = {{10, -20, -20}, {10, 20, -20}, {10, 20, 20}, {10, -20, 20}};
    wall.indices = {0, 2, 1, 0, 3, 2};
    wall.clusters = {{.first_index = 0, .index_count = 6, .material = 0}};
    auto scene = std::make_shared<types::Geometry>();
    scene->meshes.push_back(wall);
    scene->materials.emplace_back();
    scene->objects.push_back({.name = "wall", .mesh = 0});

    sonar::SonarConfig config;
    config.range = 20;
    config.visibility = sonar::Visibility::Cpu;
    sonar::SonarRenderer renderer(config, scene);
    types::Snapshot snapshot;
    snapshot.geometry = scene;
    types::Sonar ping;
    renderer.render(snapshot, ping);
    size_t loudest = 0;
    for (size_t k = 0; k < ping.bin_count; ++k)
        if (ping.bins[128 * ping.bin_count + k] > ping.bins[128 * ping.bin_count + loudest]) loudest = k;
    std::printf("%.1f m\n", ping.binStart(double(loudest)));
}
)";

}  // namespace

TEST(RendererTest, ThirtyLinesRenderAPingWithoutTheFrameworkAndYaml) {
    const TestFolder folder;
    install(folder);
    writeFile(folder / "main.cpp", program);
    writeFile(folder / "CMakeLists.txt", R"(cmake_minimum_required(VERSION 3.22)
project(Renderer CXX)
find_package(Insonify REQUIRED COMPONENTS sonar)
add_executable(renderer main.cpp)
target_link_libraries(renderer PRIVATE Insonify::sonar)
)");
    ASSERT_THAT(buildOutside(folder, folder / "prefix"), succeeds());
    EXPECT_EQ(call(folder, {folder / "build/renderer"}).out, "10.0 m\n");
    const std::string link = readFile(folder / "build/CMakeFiles/renderer.dir/link.txt");
    EXPECT_THAT(link, HasSubstr("insonify_sonar"));
    for (const char* none : {"framework", "yaml", "_tasks"}) EXPECT_THAT(link, Not(HasSubstr(none)));
    EXPECT_THAT(call(folder, {"ldd", folder / "build/renderer"}).out, Not(HasSubstr("yaml")));
}
