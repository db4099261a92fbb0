// CMake's configuration on systems that lack packages, or that have others as well.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/install/Outside.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;
using testing::Not;

namespace {

/** An optional package: its name in CMAKE_DISABLE_FIND_PACKAGE_, what messages call it, and the targets that need it.
 */
struct Package {
    std::string name, word;
    std::vector<std::string> targets;
};
const std::vector<Package> packages = {
    {"assimp", "assimp (libassimp-dev)", {"insonify_read_mesh", "meshes_test", "sdf_test"}},
    {"Boost",
     "Boost (libboost-dev)",
     {"insonify_device", "insonify_mavlink", "insonify_study", "insonify_viewer", "oculus_bench", "viewer_test"}},
    {"cppzmq", "cppzmq (cppzmq-dev)", {"insonify_gazebo", "gazebo_test"}},
    {"CycloneDDS", "CycloneDDS 0.10 (cyclonedds-dev)", {"insonify_dds", "dds_test", "dds_bench"}},
    {"fastrtps", "", {"dds_fast_peer"}},
    {"GDAL", "GDAL (libgdal-dev)", {"insonify_survey", "survey_test"}},
    {"geographiclib", "GeographicLib (libgeographiclib-dev)", {}},
    {"GTest", "GTest::gmock", {"acoustics_test", "framework_bench"}},
    {"ignition-msgs8", "ignition-msgs8", {}},
    {"ignition-transport11", "ignition-transport11", {}},
    {"OpenCV_imgcodecs", "INSONIFY_OPENCV_IMGCODECS", {"deployer_test", "output_test", "viewer_test"}},
    {"OpenCV_videoio", "OpenCV's videoio (libopencv-dev)", {"insonify_video", "output_test"}},
    {"Protobuf", "Protobuf (libprotobuf-dev)", {"insonify_gazebo", "gazebo_test"}},
    {"sdformat12", "sdformat12 (libsdformat-dev)", {"insonify_sdf", "sdf_test", "meshes_test"}},
    {"Snappy", "Snappy (libsnappy-dev)", {"insonify_device", "device_test", "fuzz_test", "mavlink_test", "nav_test"}},
    {"sqlite3", "SQLite (libsqlite3-dev)", {}},
    {"tinyxml2", "tinyxml2 (libtinyxml2-dev)", {"insonify_sdf", "sdf_test"}},
    {"libzmq", "ZeroMQ (libzmq3-dev)", {"insonify_gazebo", "gazebo_test"}},
};

/** A build folder of this source folder, which is configured again and again. */
class BuildFolder {
public:
    /** Configures with these options and none of those before. */
    Outcome configure(const std::vector<std::string>& options) const {
        std::vector<std::string> words{INSONIFY_CMAKE,
                                       "-S",
                                       insonify::test::source_dir,
                                       "-B",
                                       "build",
                                       "-G",
                                       "Ninja",
                                       "-U",
                                       "CMAKE_DISABLE_FIND_PACKAGE_*",
                                       "--no-warn-unused-cli"};
        words.insert(words.end(), options.begin(), options.end());
        return call(folder_, words);
    }
    std::set<std::string> targets() const {
        std::istringstream lines(readFile(folder_ / "build/targets"));
        std::set<std::string> all;
        for (std::string line; std::getline(lines, line);) all.insert(line);
        return all;
    }
    std::string rules() const { return readFile(folder_ / "build/build.ninja"); }
    const TestFolder& folder() const { return folder_; }

private:
    TestFolder folder_;
};

std::string hidden(const std::string& name) { return "-DCMAKE_DISABLE_FIND_PACKAGE_" + name + "=ON"; }

/** Configures without these packages, with tests and without, and expects a build that is whole. */
void expectWhole(const BuildFolder& build, const std::vector<const Package*>& absent) {
    std::vector<std::string> options;
    std::string names;
    for (const Package* package : absent) {
        options.push_back(hidden(package->name));
        names += package->name + " ";
    }
    SCOPED_TRACE("without " + names);
    for (const bool tests : {true, false}) {
        options.push_back(tests ? "-DINSONIFY_TESTS=ON" : "-DINSONIFY_TESTS=OFF");
        const Outcome outcome = build.configure(options);
        options.pop_back();
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        const std::set<std::string> targets = build.targets();
        EXPECT_TRUE(targets.contains("insonify"));
        for (const Package* package : absent)
            for (const std::string& target : package->targets) EXPECT_FALSE(targets.contains(target)) << target;
        if (!tests) {
            for (const std::string& target : targets) EXPECT_FALSE(target.ends_with("_test")) << target;
        }
        // A target that is absent would be linked by its name.
        for (const char* plain : {"-linsonify_", "-lopencv_", "-lfastrtps"})
            EXPECT_THAT(build.rules(), Not(HasSubstr(plain)));
        if (tests && absent.size() == 1) {
            EXPECT_THAT(outcome.out, HasSubstr(absent[0]->word));
        }
    }
}

/** Writes a package's CMake file of this version, as it would be in another prefix. */
void writePackage(const fs::path& prefix, const std::string& name, const std::string& version) {
    const fs::path folder = prefix / "lib/cmake" / name;
    fs::create_directories(folder);
    writeFile(folder / (name + "-config.cmake"), "add_library(" + name + " INTERFACE IMPORTED)\n");
    writeFile(folder / (name + "-config-version.cmake"),
              "set(PACKAGE_VERSION " + version +
                  ")\nif(NOT PACKAGE_FIND_VERSION VERSION_GREATER PACKAGE_VERSION)\n  set(PACKAGE_VERSION_COMPATIBLE "
                  "TRUE)\nendif()\n");
}

void writeBoost(const fs::path& prefix, const std::string& number) {
    fs::create_directories(prefix / "include/boost");
    writeFile(prefix / "include/boost/beast.hpp", "");
    writeFile(prefix / "include/boost/version.hpp", "#define BOOST_VERSION " + number + "\n");
}

void writeOpenCv(const fs::path& prefix) {
    fs::create_directories(prefix / "include/opencv4/opencv2/core");
    fs::create_directories(prefix / "lib");
    for (const char* header : {"core.hpp", "imgproc.hpp"}) writeFile(prefix / "include/opencv4/opencv2" / header, "");
    writeFile(prefix / "include/opencv4/opencv2/core/version.hpp",
              "#define CV_VERSION_MAJOR    4\n#define CV_VERSION_MINOR    9\n#define CV_VERSION_REVISION 0\n");
}

}  // namespace

TEST(ConfigureTest, EachOptionalPackageMayBeAbsent) {
    const BuildFolder build;
    for (const Package& package : packages) expectWhole(build, {&package});
}

TEST(ConfigureTest, EachOptionalPackageMayBeThereAlone) {
    const BuildFolder build;
    for (const Package& alone : packages) {
        std::vector<const Package*> others;
        for (const Package& package : packages)
            if (&package != &alone) others.push_back(&package);
        expectWhole(build, others);
    }
}

TEST(ConfigureTest, OfSeveralPackagesTheMissingOneIsNamed) {
    const BuildFolder build;
    const std::string without_snappy = build.configure({hidden("Snappy")}).out;
    EXPECT_THAT(without_snappy, HasSubstr("No Snappy (libsnappy-dev): stand-ins"));
    EXPECT_THAT(without_snappy, Not(HasSubstr("No Boost")));
    EXPECT_THAT(build.configure({hidden("Snappy"), hidden("Boost")}).out,
                HasSubstr("No Snappy (libsnappy-dev), no Boost (libboost-dev): stand-ins"));
    EXPECT_THAT(build.configure({hidden("cppzmq")}).out, HasSubstr("No cppzmq (cppzmq-dev): gazebo"));
}

TEST(ConfigureTest, AnOmittedComponentSaysWhyWhenItIsBuilt) {
    const BuildFolder build;
    ASSERT_EQ(build.configure({hidden("GDAL")}).code, 0);
    EXPECT_THAT(
        call(build.folder(), {INSONIFY_CMAKE, "--build", "build", "--target", "insonify_component_survey"}),
        prints(HasSubstr(
            "survey cannot be built on this system and is omitted. No GDAL (libgdal-dev): surveys are not read")));
}

TEST(ConfigureTest, HeadersAndLibrariesAreOfOnePrefix) {
    const BuildFolder build;
    const fs::path prefix = build.folder() / "prefix";
    const std::string option = "-DCMAKE_PREFIX_PATH=" + prefix.string();
    writeOpenCv(prefix);
    writeBoost(prefix, "108300");
    const Outcome headers_only = build.configure({option});
    EXPECT_EQ(headers_only.code, 1);
    EXPECT_THAT(headers_only.err, HasSubstr("prefix/include/opencv4 has headers of OpenCV, but"));

    for (const char* library : {"libopencv_core.so", "libopencv_imgproc.so"}) writeFile(prefix / "lib" / library, "");
    const Outcome whole = build.configure({option});
    ASSERT_EQ(whole.code, 0) << whole.err;
    EXPECT_THAT(whole.out, HasSubstr("From " + prefix.string() + ": OpenCV 4.9, Boost 1.83\n"));
    EXPECT_THAT(whole.out, HasSubstr("No OpenCV's videoio")) << "of the system";
    EXPECT_THAT(build.rules(), HasSubstr((prefix / "lib/libopencv_imgproc.so").string()));
    EXPECT_THAT(build.rules(), Not(HasSubstr("-gnu/libopencv_")));
    if (build.targets().contains("insonify_device")) {
        EXPECT_THAT(build.rules(), HasSubstr("-isystem " + (prefix / "include").string() + "\n"));
    }

    fs::remove_all(prefix);
    const Outcome removed = build.configure({option});
    ASSERT_EQ(removed.code, 0) << removed.err;
    EXPECT_THAT(build.rules(), Not(HasSubstr(prefix.string() + "/lib"))) << "places that no longer exist are forgotten";
}

TEST(ConfigureTest, VersionsThatAreTooOldAreNotTaken) {
    const BuildFolder build;
    const fs::path prefix = build.folder() / "prefix";
    const std::string option = "-DCMAKE_PREFIX_PATH=" + prefix.string();
    writePackage(prefix, "yaml-cpp", "0.6.3");
    writePackage(prefix, "fmt", "7.1.3");
    const Outcome passed_over = build.configure({option});
    ASSERT_EQ(passed_over.code, 0) << "the system has newer ones: " << passed_over.err;
    EXPECT_THAT(passed_over.out, Not(HasSubstr("From " + prefix.string())));

    writeBoost(prefix, "106501");
    const Outcome refused = build.configure({option});
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.err, testing::AllOf(HasSubstr("prefix/include is 1.65"), HasSubstr("Insonify needs 1.74")));
}

TEST(ConfigureTest, LibrariesOfTheBuildAreFoundRelativeToPrograms) {
    const BuildFolder build;
    ASSERT_EQ(build.configure({"-DINSONIFY_TESTS=ON"}).code, 0);
    // The linker divides the argument at commas, and the loader the path at colons.
    const std::string rules = build.rules();
    size_t count = 0;
    for (size_t at = rules.find("-rpath,"); at != std::string::npos; at = rules.find("-rpath,", at + 1), ++count)
        EXPECT_EQ(rules.substr(at + 7, 9), "\"\\$$ORIGI") << rules.substr(at, 80);
    EXPECT_GT(count, 2u);
}

TEST(ConfigureTest, ThePresetIsTheBuildOfTheScripts) {
    const json presets = json::parse(readFile(insonify::test::sourceFile("CMakePresets.json")));
    ASSERT_EQ(presets["configurePresets"].size(), 1u);
    const json& preset = presets["configurePresets"][0];
    EXPECT_EQ(preset["generator"], "Ninja");
    EXPECT_EQ(preset["binaryDir"], "${sourceDir}/build");
    EXPECT_EQ(preset["cacheVariables"]["CMAKE_BUILD_TYPE"], "Release");
    const TestFolder folder;
    EXPECT_THAT(
        call(folder, {INSONIFY_CMAKE, "-S", insonify::test::source_dir, "--preset", "default", "-B", "build", "-N"}),
        succeeds());
}
