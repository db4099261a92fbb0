// The wheel and the archive that scripts/package makes.
#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>

#include "tests/install/Outside.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

/** The file in build/packages with this end. */
std::string packed(const std::string& end) {
    for (const auto& entry : fs::directory_iterator(insonify::test::build_dir + std::string("/packages")))
        if (entry.path().filename().string().ends_with(end)) return entry.path();
    throw std::runtime_error("no package " + end);
}

/** The libraries of the system that a program loads. */
std::set<std::string> fromSystem(const TestFolder& folder, const std::string& program) {
    std::istringstream lines(call(folder, {"ldd", program}).out);
    std::set<std::string> names;
    for (std::string line; std::getline(lines, line);)
        if (const auto at = line.find("=> "); at != std::string::npos && line.find(folder.path()) == std::string::npos)
            names.insert(line.substr(1, line.find(".so") - 1));
    return names;
}

void runArchive(const WallFolder& folder) {
    const std::string archive = packed(".tar.zst"), name = fs::path(archive).stem().stem();
    ASSERT_EQ(call(folder, {"tar", "--zstd", "-xf", archive}).code, 0);
    const std::string program = folder / (name + "/bin/insonify");
    EXPECT_THAT(call(folder, {"env", "-i", program, "run", "wall.yml", "--pings", "1", "--out", "out"}), succeeds());
    EXPECT_TRUE(fs::exists(folder / "out"));

    const fs::path package = folder / (name + "/insonify");
    std::vector<std::string> programs = {package / "bin/insonify"};
    for (const auto& entry : fs::directory_iterator(package / "lib/insonify")) programs.push_back(entry.path());
    EXPECT_GT(programs.size(), 8u);
    for (const std::string& each : programs)
        for (const std::string& library : fromSystem(folder, each))
            EXPECT_THAT(library, testing::MatchesRegex("lib(c|m|dl|rt|pthread|resolv|gcc_s|stdc\\+\\+|z|expat)"))
                << each;
    EXPECT_THAT(call(folder, {"env", "-i", program, "device", "list"}).out,
                HasSubstr((package / "share/doc/insonify/components/device/README.md\n").string()));
    const fs::path licences = package / "../insonify.libs/licences";
    EXPECT_GT(std::distance(fs::directory_iterator(licences), {}), 20);
    for (const char* compiled_in : {"libcli11-dev.txt", "libglm-dev.txt", "libjs-three.txt", "nlohmann-json3-dev.txt"})
        EXPECT_TRUE(fs::exists(licences / compiled_in)) << compiled_in;
    EXPECT_THAT(call(folder, {"env", "-i", program, "scene", "make", "--list"}).err, HasSubstr("INSONIFY_PYTHON="))
        << "an archive has no pip";
    EXPECT_THAT(
        call(folder, {program, "check", std::string(insonify::test::source_dir) + "/deploy/survey_mission.yml"}).err,
        HasSubstr("the component library survey, which is not in wheels and archives"));
}

void runWheel(const WallFolder& folder) {
    const std::string wheel = packed(".whl");
    EXPECT_THAT(wheel, HasSubstr("-py3-none-manylinux_2_"));
    ASSERT_EQ(call(folder, {"/usr/bin/python3", "-m", "venv", "--system-site-packages", "env"}).code, 0);
    ASSERT_THAT(call(folder, {"env/bin/pip", "install", "--no-index", "--no-deps", wheel}), succeeds());
    EXPECT_THAT(call(folder, {"env/bin/insonify", "run", "wall.yml", "--pings", "1", "--out", "out"}), succeeds());
    const Outcome stepped =
        call(folder, {"env/bin/python", "-c",
                      "import insonify, glob\n"
                      "ping = insonify.Simulation('wall.yml').step(insonify.Pose([0, 0, 0]))\n"
                      "[log] = glob.glob('out/wall.0.log')\n"
                      "print(insonify.__file__, ping.bins.max() > 0, len(insonify.read_log(log)) > 0)"});
    EXPECT_THAT(stepped.out, testing::AllOf(HasSubstr("/env/lib/"), HasSubstr("True True"))) << stepped.err;
}

/** Returns the names of the libraries in a list of what a package consists of; each has a version and licences. */
std::set<std::string> readLibraries(const std::string& end) {
    const json list = json::parse(readFile(packed(end)));
    EXPECT_EQ(list["bomFormat"], "CycloneDX");
    EXPECT_EQ(list["metadata"]["component"]["name"], "insonify");
    std::set<std::string> names;
    for (const json& each : list["components"]) {
        EXPECT_NE(each["version"], "") << each;
        EXPECT_THAT(each["purl"].get<std::string>(), testing::StartsWith("pkg:")) << each;
        EXPECT_FALSE(each.value("licenses", json::array()).empty()) << each;
        EXPECT_TRUE(names.insert(each["name"]).second) << each;
    }
    EXPECT_EQ(list["dependencies"].size(), list["components"].size() + 1);
    return names;
}

}  // namespace

TEST(PackageTest, TheArchiveRunsFromItsFolderAndTheWheelInAnyPython) {
    const WallFolder folder;
    const std::string script = insonify::test::source_dir + std::string("/scripts/package");
    const Outcome made = call(folder, {script});
    if (made.err.find("No matching distribution") != std::string::npos)
        GTEST_SKIP() << "NOT TESTED: auditwheel and what else makes wheels cannot be had from PyPI";
    ASSERT_EQ(made.code, 0) << made.err;
    runArchive(folder);
    runWheel(folder);

    using testing::Contains, testing::StartsWith;
    for (const char* end : {"-deb.sbom.json", "64.sbom.json"}) {
        const std::set<std::string> libraries = readLibraries(end);
        for (const char* library : {"libyaml-cpp", "libembree", "libboost1.", "libcli11-dev", "libglm-dev",
                                    "libjs-three", "nlohmann-json3-dev"})
            EXPECT_THAT(libraries, Contains(StartsWith(library))) << end;
        EXPECT_FALSE(libraries.contains("libgtest-dev")) << end;
    }
    const std::string packages = insonify::test::build_dir + std::string("/packages");
    EXPECT_THAT(call(folder, {"sh", "-c", "cd " + packages + " && sha256sum --check --strict SHA256SUMS"}), succeeds());
    std::istringstream sums(readFile(packages + "/SHA256SUMS"));
    EXPECT_EQ(std::count(std::istreambuf_iterator<char>(sums), {}, '\n') + 1,
              std::distance(fs::directory_iterator(packages), {}));
    EXPECT_EQ(call(folder, {script, "rpm"}).code, 2) << "what it may be is said";
}
