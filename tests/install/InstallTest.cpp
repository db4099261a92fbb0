// The files that `cmake --install` puts in a prefix work without sources and build.
#include <gmock/gmock.h>

#include "tests/install/Outside.hpp"
#include "tests/meshes/Dae.hpp"
#include "tests/support/Needs.hpp"
#include "tests/support/Pages.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

const std::string with_the_component = replaced(
    wall_deployment +
        "  - {from: sonar.ping, to: mean.ping}\n"
        "  - {from: mean.mean, to: log.mean, policy: {type: buffer, size: 64}}\n",
    "tasks:\n",
    "libraries: [build/mean_echo.so]\ntasks:\n  mean: {type: example::MeanEchoTask, properties: {beyond: 2}}\n");

}  // namespace

TEST(InstallTest, AProjectOutsideBuildsAComponentThatTheInstalledCommandRuns) {
    const WallFolder folder(with_the_component);
    install(folder);
    const insonify::test::Page page = insonify::test::readPage("components/framework/README.md");
    writeFile(folder / "CMakeLists.txt", getCode(page, "cmake", "Use it from a project of your own"));
    writeFile(folder / "mean_echo.cpp", getCode(page, "cpp", "A component of your own"));
    ASSERT_THAT(buildOutside(folder, folder / "prefix"), succeeds());

    const std::string insonify = folder / "prefix/bin/insonify";
    ASSERT_THAT(call(folder, {insonify, "run", "wall.yml", "--pings", "2", "--out", "out"}), succeeds());
    ASSERT_EQ(
        call(folder, {insonify, "log", "export", "out/wall.0.log", "--stream", "mean.mean", "--to", "mean.csv"}).code,
        0);
    // The wall is at 10 m and all other bins are 0, so the mean is between 0 and 1.
    std::istringstream rows(readFile(folder / "mean.csv"));
    std::string row;
    std::getline(rows, row);
    EXPECT_EQ(row, "time,value");
    int count = 0;
    for (; std::getline(rows, row); ++count) {
        const double mean = std::stod(row.substr(row.find(',') + 1));
        EXPECT_GT(mean, 0) << row;
        EXPECT_LT(mean, 1) << row;
    }
    EXPECT_EQ(count, 2);

    // The command's own reader refuses values that the component's property may not have.
    EXPECT_THAT(call(folder, {insonify, "run", "wall.yml", "--set", "mean.beyond=-1"}),
                isRefused(HasSubstr("tasks.mean.properties.beyond")));
}

TEST(InstallTest, TheExamplesRunFromThePrefix) {
    const TestFolder folder;
    install(folder);
    const std::string insonify = folder / "prefix/bin/insonify";
    EXPECT_THAT(call(folder, {insonify, "run", folder / "prefix/share/insonify/deploy/minimal.yml", "--out", "out"}),
                succeeds());
    EXPECT_TRUE(fs::exists(folder / "out/fan_000000.png"));
    EXPECT_THAT(call(folder, {"ldd", insonify}).out, testing::Not(HasSubstr(insonify::test::build_dir)));
}

TEST(InstallTest, TheServiceIsInstalledWhereSystemdSearches) {
    const TestFolder folder;
    install(folder);
    EXPECT_EQ(readFile(folder / "prefix/lib/systemd/system/insonify.service"),
              readFile(fs::path(insonify::test::source_dir) / "deploy/insonify.service"));
    EXPECT_TRUE(fs::exists(folder / "prefix/share/man/man1/insonify.1")) << "which the service names";
}

TEST(InstallTest, ReadsMeshesInAProcessFromThePrefix) {
    INSONIFY_NEEDS("sdf");
    const TestFolder folder;
    install(folder);
    writeFile(folder / "plate.dae", insonify::meshes::Dae().text());
    writeFile(folder / "plate.world", R"(<sdf version="1.9"><world name="w"><model name="plate"><static>true</static>
<link name="l"><visual name="v"><geometry><mesh><uri>plate.dae</uri></mesh></geometry></visual></link></model></world></sdf>
)");
    const std::vector<std::string> words{folder / "prefix/bin/insonify", "scene", "plate.world", "--json"};
    const Outcome read = call(folder, words);
    ASSERT_EQ(read.code, 0) << read.err;
    const json scene = json::parse(read.out);
    EXPECT_EQ(scene["triangles"], 2);
    EXPECT_EQ(scene["bounds"]["max"], json::parse("[1, 2, 3]"));

    fs::path reader;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "prefix/lib"))
        if (entry.path().filename() == "insonify-read-mesh") reader = entry.path();
    ASSERT_FALSE(reader.empty());
    fs::remove(reader);
    writeFile(reader, "#!/bin/sh\nexit 7\n");
    fs::permissions(reader, fs::perms::owner_all);
    EXPECT_THAT(call(folder, words).out, HasSubstr("plate.dae cannot be read: its reader ended with 7"))
        << "another reader than the prefix's was taken";
}

TEST(InstallTest, AFirstDeploymentIsMadeAndRunsAndTheManualPageIsThere) {
    const TestFolder folder;
    install(folder);
    const std::string insonify = folder / "prefix/bin/insonify";
    ASSERT_THAT(call(folder, {insonify, "init", "dive", "--sonar", "micron"}), succeeds());
    EXPECT_THAT(call(folder, {insonify, "run", "dive", "--pings", "2", "--out", "out"}), succeeds());
    EXPECT_TRUE(fs::exists(folder / "out/micron.0.log"));
    EXPECT_EQ(readFile(folder / "prefix/share/man/man1/insonify.1"), call(folder, {insonify, "man"}).out);
}

TEST(InstallTest, FindsEachComponentsLibraryWithItsDependencies) {
    const TestFolder folder;
    install(folder);
    std::string project = "cmake_minimum_required(VERSION 3.22)\nproject(Outside CXX)\nset(all";
    for (const auto& library : fs::directory_iterator(folder / "prefix/include/insonify/components"))
        project += " " + library.path().filename().string();
    project += R"()
find_package(Insonify 0.1 REQUIRED COMPONENTS ${all})
foreach(component types ${all})
  add_executable(use_${component} main.cpp)
  target_link_libraries(use_${component} Insonify::${component})
endforeach()
)";
    writeFile(folder / "CMakeLists.txt", project);
    writeFile(folder / "main.cpp", "int main() {}\n");
    EXPECT_THAT(buildOutside(folder, folder / "prefix"), succeeds());
}

TEST(InstallTest, RefusesAnUnknownComponentByItsName) {
    const TestFolder folder;
    install(folder);
    writeFile(folder / "CMakeLists.txt",
              "cmake_minimum_required(VERSION 3.22)\nproject(Outside CXX)\n"
              "find_package(Insonify REQUIRED COMPONENTS sonar radar)\n");
    const Outcome outcome = buildOutside(folder, folder / "prefix");
    EXPECT_NE(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("has no component radar"));
}
