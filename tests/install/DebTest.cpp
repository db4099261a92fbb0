// The Debian packages that `cpack -G DEB` makes.
#include <gmock/gmock.h>

#include "tests/install/Outside.hpp"
#include "tests/support/Pages.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::AllOf, testing::HasSubstr;

namespace {

/** insonify_*.deb or insonify-dev_*.deb in the folder `packages`. */
std::string package(const TestFolder& folder, const std::string& name) {
    for (const auto& entry : fs::directory_iterator(folder / "packages"))
        if (entry.path().filename().string().starts_with(name + "_")) return entry.path();
    throw std::runtime_error("no package " + name);
}

/** Expects the licences of the libraries that are compiled in, as the list of contents names them, in the copyright of
 *  each package. */
void expectLicences(const TestFolder& folder) {
    const Outcome listed = call(folder, {"/usr/bin/python3", "-c",
                                         "import json, os, sys\n"
                                         "source = sys.argv[1]\n"
                                         "os.chdir(source)\n"
                                         "sys.path.insert(0, source + '/scripts/packaging')\n"
                                         "import sbom\n"
                                         "print(json.dumps(sbom.compiled_in()))",
                                         insonify::test::source_dir});
    ASSERT_EQ(listed.code, 0) << listed.err;
    const json libraries = json::parse(listed.out);
    ASSERT_GT(libraries.size(), 4u);
    for (const char* name : {"insonify", "insonify-dev", "insonify-nav", "python3-insonify"}) {
        const std::string text = readFile(folder / ("root/usr/share/doc/" + std::string(name) + "/copyright"));
        EXPECT_THAT(text, HasSubstr("Apache License")) << name;
        for (const json& library : libraries) {
            EXPECT_THAT(text, HasSubstr("\n" + library["name"].get<std::string>() + " ")) << name;
            for (const json& licence : library["licenses"])
                EXPECT_THAT(text, HasSubstr(licence["license"]["name"].get<std::string>())) << name << library["name"];
        }
    }
}

}  // namespace

TEST(DebTest, ThePackagesUnpackToACommandThatRunsAndAProjectThatBuilds) {
    const WallFolder folder;
    for (const char* tool : {"dpkg-deb", "dpkg-shlibdeps"})
        if (call(folder, {tool, "--version"}).code != 0) GTEST_SKIP() << "there is no " << tool << " on this system";
    ASSERT_THAT(call(folder, {INSONIFY_CPACK, "-G", "DEB", "--config",
                              std::string(insonify::test::build_dir) + "/CPackConfig.cmake", "-B", "packages"}),
                succeeds());
    for (const char* name : {"insonify", "insonify-dev", "insonify-nav", "python3-insonify"})
        ASSERT_EQ(call(folder, {"dpkg-deb", "-x", package(folder, name), "root"}).code, 0);

    EXPECT_TRUE(fs::exists(folder / "root/usr/lib/systemd/system/insonify.service"));
    expectLicences(folder);
    EXPECT_THAT(call(folder, {folder / "root/usr/bin/insonify", "describe", "sonar::SonarTask"}).out,
                HasSubstr((folder / "root/usr/share/doc/insonify/components/sonar/EFFECTS.md").string()));

    const std::string depends = call(folder, {"dpkg-deb", "-f", package(folder, "insonify"), "Depends"}).out;
    for (const char* needed : {"libc6 (>=", "libyaml-cpp", "libepoxy0", "libopencv-core", "libegl1", "libgl1-mesa-dri"})
        EXPECT_THAT(depends, HasSubstr(needed));
    EXPECT_THAT(call(folder, {"dpkg-deb", "-f", package(folder, "insonify-dev"), "Depends"}).out,
                AllOf(HasSubstr("insonify (="), HasSubstr("pkg-config"), HasSubstr("libgeographiclib-dev")))
        << "what find_package(Insonify) asks for";

    EXPECT_THAT(call(folder, {"dpkg-deb", "-f", package(folder, "insonify-dds"), "Depends"}).out,
                AllOf(HasSubstr("insonify (="), HasSubstr("libddsc")));
    EXPECT_THAT(depends, testing::Not(HasSubstr("libddsc"))) << "of a component library alone";
    const Outcome listed = call(folder, {folder / "root/usr/bin/insonify", "libraries"});
    EXPECT_THAT(listed.out, AllOf(HasSubstr("nav        here"), HasSubstr("dds        absent")));

    EXPECT_THAT(call(folder, {folder / "root/usr/bin/insonify", "run", "wall.yml", "--pings", "1", "--out", "out"}),
                succeeds());
    const Outcome stepped =
        call(folder,
             {"env", "PYTHONPATH=" + (folder / "root/usr/lib/python3/dist-packages").string(),
              "LD_LIBRARY_PATH=" + (folder / "root/usr/lib").string(), "/usr/bin/python3", "-c",
              "import insonify; print(insonify.Simulation('wall.yml').step(insonify.Pose([0, 0, 0])).bins.max() > 0)"});
    EXPECT_EQ(stepped.out, "True\n") << stepped.err;
    EXPECT_THAT(call(folder, {"dpkg-deb", "-f", package(folder, "python3-insonify"), "Depends"}).out,
                AllOf(HasSubstr("insonify (="), HasSubstr("python3-numpy")));

    const insonify::test::Page page = insonify::test::readPage("components/framework/README.md");
    writeFile(folder / "CMakeLists.txt", getCode(page, "cmake", "Use it from a project of your own"));
    writeFile(folder / "mean_echo.cpp", getCode(page, "cpp", "A component of your own"));
    EXPECT_THAT(buildOutside(folder, folder / "root/usr"), succeeds());
}
