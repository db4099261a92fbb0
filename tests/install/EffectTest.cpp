// An effect in a library outside of the tree, by the recipe of components/sonar/DEVELOP.md alone.
#include <gmock/gmock.h>

#include "tests/install/Outside.hpp"
#include "tests/support/Pages.hpp"
#include "tests/support/Python.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

/** The wall, with numbers of the effect. */
std::string deploymentWith(const std::string& effects) {
    return replaced(replaced(wall_deployment, "tasks:\n", "libraries: [build/afterglow.so]\ntasks:\n"),
                    "      range: 20\n", "      range: 20\n      effects: " + effects + "\n");
}

/** Builds the library of the page in the folder. */
void buildEffect(const TestFolder& folder) {
    install(folder);
    const insonify::test::Page page = insonify::test::readPage("components/sonar/DEVELOP.md");
    writeFile(folder / "afterglow.cpp", getCode(page, "cpp", "A new effect"));
    writeFile(folder / "CMakeLists.txt", R"(cmake_minimum_required(VERSION 3.22)
project(Afterglow CXX)
find_package(Insonify REQUIRED)
add_library(afterglow MODULE afterglow.cpp)
set_target_properties(afterglow PROPERTIES PREFIX "")
target_link_libraries(afterglow PRIVATE Insonify::core)
)");
    ASSERT_THAT(buildOutside(folder, folder / "prefix"), succeeds());
}

}  // namespace

TEST(EffectTest, ALibrarysEffectIsPlannedRenderedAndRefusedLikeOurs) {
    const WallFolder folder(deploymentWith("{afterglow: {kept: 0.5}}"));
    buildEffect(folder);
    const std::string insonify = folder / "prefix/bin/insonify";
    ASSERT_THAT(call(folder, {insonify, "run", "wall.yml", "--pings", "3", "--out", "out"}), succeeds());
    ASSERT_EQ(
        call(folder, {insonify, "log", "export", "out/wall.0.log", "--stream", "sonar.ping", "--to", "p.npz"}).code, 0);
    const std::string ratios =
        "import numpy; b = numpy.load('p.npz')['bins']; print(*[float((b[i] / b[0])[b[0] > 0].mean().round(6)) for i "
        "in (1, 2)])";
    EXPECT_EQ(python(folder, ratios).out, "1.5 1.75\n")
        << "half of it is left after each ping, of a wall that stands still";
    EXPECT_THAT(call(folder, {insonify, "plan", "wall.yml"}).out, HasSubstr("afterglow"));

    writeFile(folder / "wall.yml", deploymentWith("{}"));
    EXPECT_THAT(call(folder, {insonify, "plan", "wall.yml"}).out, HasSubstr("not configured"));
    const std::pair<const char*, const char*> refused[] = {
        {"{afterglow: {kept: 2}}", "effects.afterglow.kept: is 2; must be 0 to 1\n"},
        {"{afterglow: {kpet: 0.5, kept: 0.5}}", "did you mean kept?"},
        {"{afterglow: {}}", "effects.afterglow: has no kept"},
        {"{afterglw: {kept: 0.5}}", "did you mean afterglow?"}};
    for (const auto& [effects, why] : refused) {
        writeFile(folder / "wall.yml", deploymentWith(effects));
        EXPECT_THAT(call(folder, {insonify, "check", "wall.yml"}), isRefused(HasSubstr(why))) << effects << effects;
    }
}

TEST(EffectTest, AnEffectThatNoLibraryHasAddedIsRefused) {
    const WallFolder folder(
        replaced(wall_deployment, "      range: 20\n", "      range: 20\n      effects: {bubbles: {}}\n"));
    EXPECT_THAT(callInsonify(folder, {"check", "wall.yml"}),
                isRefused(HasSubstr("effects.bubbles: is no effect; effects are: edge_diffraction\n")));
    EXPECT_THAT(callInsonify(folder, {"check", "wall.yml", "--set", "sonar.effects.bubles.size=1"}),
                isRefused(HasSubstr("--set: tasks.sonar.properties.effects.bubles: is no effect;")));
}
