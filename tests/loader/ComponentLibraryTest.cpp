// Component libraries in the command and in Python: present, absent and broken.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "components/loader/ComponentLibrary.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/Needs.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::deployer {
namespace {

using testing::HasSubstr, testing::Not;
namespace fs = std::filesystem;

const fs::path build = test::build_dir, parts = build / "tests/loader/parts", components = build / "lib/insonify";

std::string getDeployment(const std::string& type) {
    return "tasks:\n  a: {type: " + type + ", activity: {period: 0.1}}\n";
}

/** An installed Insonify in its own folder, so that libraries may be absent or broken. */
struct ComponentLibraryTest : testing::Test {
    ComponentLibraryTest() {
        fs::create_directories(folder_ / "lib/insonify");
        fs::create_directories(folder_ / "parts");
        fs::copy_file(fs::canonical(build / "lib/libinsonify.so"), folder_ / "lib/libinsonify.so.0.1");
    }
    void add(const std::string& name) const { fs::copy_file(components / (name + ".so"), installed(name)); }
    fs::path installed(const std::string& name) const { return folder_ / "lib/insonify" / (name + ".so"); }
    /** In addition to the user's own folder of components. */
    Outcome call(std::vector<std::string> words, const std::string& path = "") const {
        std::vector<std::string> all{"env", "LD_LIBRARY_PATH=" + (folder_ / "lib").string(),
                                     "INSONIFY_COMPONENT_PATH=" + path, build / "bin/insonify"};
        all.insert(all.end(), words.begin(), words.end());
        return Process(std::move(all), folder_.path()).wait();
    }
    Outcome check(const std::string& type, const std::string& path = "") const {
        writeFile(folder_ / "a.yml", getDeployment(type));
        return call({"check", "a.yml"}, path);
    }
    std::string partsOfUser() const { return folder_ / "parts"; }
    void give(const std::string& part) const {
        fs::copy_file(parts / (part + ".so"), folder_ / "parts" / (part + ".so"));
    }
    /** Expects that a library of this name with these bytes is one error at the place of its type, without a crash. */
    void expectRefused(const std::string& bytes, const std::string& why) const {
        writeFile(folder_ / "parts/mine.so", bytes);
        EXPECT_THAT(check("mine::Task", partsOfUser()),
                    isRefused(AllOf(HasSubstr("a.yml:2:13: tasks.a.type: is mine::Task: "),
                                    HasSubstr("parts/mine.so: " + why))));
    }

    /** Makes a simulation in Python with an additional task: prints "made", or its error. */
    Outcome simulate(const std::string& type) const {
        writeFile(folder_ / "wall.gltf", wallGltf());
        writeFile(folder_ / "a.yml", replaced(wall_deployment, "tasks:\n",
                                              "tasks:\n  more: {type: " + type + ", activity: {period: 0.1}}\n"));
        return Process(
                   {"env", "LD_LIBRARY_PATH=" + (folder_ / "lib").string(), "INSONIFY_COMPONENT_PATH=" + partsOfUser(),
                    "PYTHONPATH=" + (build / "python").string(), "/usr/bin/python3", "-c",
                    "import insonify\ntry:\n    insonify.Simulation('a.yml')\n    print('made')\n"
                    "except insonify.ConfigError as error:\n    print(error)\n"},
                   folder_.path())
            .wait();
    }

    const TestFolder folder_;
};

TEST_F(ComponentLibraryTest, AUsersLibraryIsLoadedByTheNamespaceOfAType) {
    give("one_type");
    EXPECT_THAT(check("one_type::CounterTask", partsOfUser()), succeeds());
    EXPECT_THAT(call({"describe"}, partsOfUser()).out, HasSubstr("one_type::CounterTask"));
    EXPECT_THAT(call({"schema"}, partsOfUser()).out, HasSubstr("one_type::CounterTask"));
    EXPECT_THAT(call({"completion", "bash"}, partsOfUser()).out, HasSubstr("one_type::CounterTask"));
    EXPECT_THAT(check("one_type::CountTask", partsOfUser()).err, HasSubstr("did you mean one_type::CounterTask?"));
}

TEST_F(ComponentLibraryTest, TheWorkingFolderIsNotSearched) {
    for (const char* place : {"one_type.so", "insonify/one_type.so"}) {
        fs::create_directories((folder_ / place).parent_path());
        fs::copy_file(parts / "one_type.so", folder_ / place);
    }
    EXPECT_THAT(check("one_type::CounterTask").err, HasSubstr("is one_type::CounterTask; known: "));
    for (const char* relative : {".", "insonify", ":", "/nowhere:.", "/nowhere::/nowhere"}) {
        EXPECT_THAT(check("one_type::CounterTask", relative),
                    isRefused(HasSubstr("INSONIFY_COMPONENT_PATH: has the folder \"")))
            << relative << relative;
    }
    EXPECT_EQ(check("../one_type::CounterTask", folder_.path()).code, 2);
}

TEST_F(ComponentLibraryTest, RefusesALibraryOfAnotherVersionBeforeItRuns) {
    give("other_version");
    EXPECT_THAT(check("other_version::Task", partsOfUser()),
                isRefused(AllOf(HasSubstr("other_version.so: is for Insonify 0.0.9 00000000; this is 0.1.0 "),
                                HasSubstr("rebuild it"))));
    give("no_interface");
    EXPECT_THAT(check("no_interface::Task", partsOfUser()).err, HasSubstr("has no line INSONIFY_COMPONENT_LIBRARY"));
}

TEST_F(ComponentLibraryTest, AMissingSymbolIsNamed) {
    give("missing_symbol");
    EXPECT_THAT(check("missing_symbol::Task", partsOfUser()),
                isRefused(AllOf(HasSubstr("missing_symbol.so: cannot be loaded: "), HasSubstr("neverWritten"))));
}

TEST_F(ComponentLibraryTest, RefusesBrokenLibrariesWithoutACrash) {
    const std::string whole = readFile(parts / "one_type.so");
    expectRefused("", "cannot be loaded: it is no shared object");
    expectRefused("INPUT(/etc/passwd)\n", "cannot be loaded: it is no shared object");
    for (const size_t length : {size_t{4}, size_t{63}})
        expectRefused(whole.substr(0, length), "cannot be loaded: it is no shared object");
    for (const size_t length : {size_t{64}, size_t{500}, whole.size() / 4, whole.size() / 2})
        expectRefused(whole.substr(0, length), "cannot be loaded: it is cut short");
    std::string other = whole;
    other[18] = static_cast<char>(0xB7);  // for another processor
    expectRefused(other, "cannot be loaded: ");
    fs::remove(folder_ / "parts/mine.so");
    fs::create_directories(folder_ / "parts/mine.so");
    EXPECT_THAT(check("mine::Task", partsOfUser()).err, HasSubstr("cannot be loaded: it is no file"));
}

TEST_F(ComponentLibraryTest, RefusesTwoLibrariesOfOneName) {
    give("one_type");
    fs::create_directories(folder_ / "more");
    fs::copy_file(parts / "one_type.so", folder_ / "more/one_type.so");
    const std::string both = partsOfUser() + ":" + (folder_ / "more").string();
    EXPECT_THAT(check("one_type::CounterTask", both),
                isRefused(HasSubstr("is the component library one_type, and so is ")));
    fs::remove(folder_ / "more/one_type.so");
    fs::create_symlink(folder_ / "parts/one_type.so", folder_ / "more/one_type.so");
    EXPECT_EQ(check("one_type::CounterTask", both).code, 0) << "the same file";
}

TEST(InstallationTest, ThePartThatIsMissingIsNamedByWhatInstallsItThere) {
    using loader::Installation;
    const Folder folder;
    for (const char* file : {"clone/build/build.ninja", "wheel/insonify/__init__.py", "prefix/lib/x"}) {
        fs::create_directories((folder / file).parent_path());
        writeFile(folder / file, "");
    }
    fs::create_directories(folder / "archive/insonify.libs");
    EXPECT_EQ(loader::findInstallation(folder / "clone/build/lib/libinsonify.so"), Installation::Clone);
    EXPECT_EQ(loader::findInstallation(folder / "wheel/insonify/lib/libinsonify.so"), Installation::Wheel);
    EXPECT_EQ(loader::findInstallation(folder / "archive/insonify/lib/libinsonify.so"), Installation::Wheel);
    EXPECT_EQ(loader::findInstallation(folder / "prefix/lib/libinsonify.so"), Installation::Prefix);
    EXPECT_EQ(loader::findInstallation("/usr/local/lib/libinsonify.so"), Installation::Prefix);
    EXPECT_EQ(loader::findInstallation("/usr/lib/x86_64-linux-gnu/libinsonify.so.0.1"), Installation::DebianPackage);
    EXPECT_THAT(loader::absence("dds", Installation::Clone),
                testing::EndsWith("not here; `scripts/setup dds` installs it"));
    EXPECT_THAT(loader::absence("dds", Installation::DebianPackage),
                testing::ContainsRegex("`apt install ./insonify-dds_[0-9.]+_(amd|arm)64.deb` installs it: "
                                       "`scripts/package` has made that file"));
    EXPECT_THAT(loader::absence("survey", Installation::Wheel),
                testing::ContainsRegex("not in wheels and archives; it is in insonify-survey_[0-9.]+_(amd|arm)64.deb"));
}

TEST_F(ComponentLibraryTest, PagesAreNamedByTheirPathInTheInstallation) {
    const std::string page = "components/sonar/EFFECTS.md";
    const auto describe = [&] { return call({"describe", "sonar::SonarTask"}); };
    EXPECT_THAT(describe(), prints(HasSubstr("focus, clock (" + page + ");"))) << "it is not installed";
    for (const char* file : {"share/doc/insonify/components/sonar/EFFECTS.md", "share/insonify/deploy/near.yml"}) {
        fs::create_directories((folder_ / file).parent_path());
        writeFile(folder_ / file, "");
    }
    EXPECT_THAT(describe(),
                prints(HasSubstr("focus, clock (" + (folder_ / "share/doc/insonify" / page).string() + ");")));
    const std::string absent = std::string(" and components/none.") + "md";
    const std::string in_clone = test::source_dir + ("/" + page);
    EXPECT_EQ(loader::locatePages("see " + page + ", " + page + absent), "see " + in_clone + ", " + in_clone + absent);
}

TEST_F(ComponentLibraryTest, ExamplesAreFoundFromEveryFolder) {
    EXPECT_THAT(call({"examples"}), isRefused(HasSubstr("examples: are not part of this installation")));
    EXPECT_THAT(call({"check", "deploy/near.yml"}), isRefused(HasSubstr("deploy/near.yml: cannot be opened")));
    const fs::path shared = folder_ / "share/insonify/deploy";
    fs::create_directories(shared);
    writeFile(shared / "near.yml", "# A wall near by: the shortest example.\n" + wall_deployment);
    writeFile(shared / "wall.gltf", wallGltf());
    EXPECT_THAT(call({"examples"}).out,
                testing::AllOf(HasSubstr("deploy/near.yml                  A wall near by\n"),
                               HasSubstr("They are in " + (folder_ / "share/insonify").string())));
    EXPECT_THAT(call({"run", "deploy/near.yml", "--pings", "1", "--out", "out"}), succeeds());
    EXPECT_TRUE(fs::exists(folder_ / "out/wall.0.log"));
    EXPECT_THAT(call({"scene", "deploy/wall.gltf"}).out, HasSubstr("triangles: 2"));
    fs::create_directories(folder_ / "deploy");
    writeFile(folder_ / "deploy/near.yml", "tasks: {}\n");
    EXPECT_THAT(call({"check", "deploy/near.yml"}).out + call({"check", "deploy/near.yml"}).err,
                Not(HasSubstr("sonar::SonarTask")))
        << "a file of the user comes first";
}

TEST_F(ComponentLibraryTest, ReportsHowToInstallAnAbsentLibrary) {
    const std::string nav =
        "which needs the component library nav, which is not here; `scripts/setup nav` and then `cmake --install "
        "build` "
        "install it, in the clone that this is from";
    EXPECT_THAT(check("nav::ImuTask"), isRefused(HasSubstr("a.yml:2:13: tasks.a.type: is nav::ImuTask, " + nav)));
    writeFile(folder_ / "b.world", "<sdf version='1.9'><world name='w'></world></sdf>\n");
    EXPECT_THAT(call({"scene", "b.world"}),
                isRefused(HasSubstr("b.world: needs the component library sdf, which is not here")));
    writeFile(folder_ / "hull.ply", "ply\n");
    EXPECT_THAT(
        call({"scene", "hull.ply"}),
        isRefused(HasSubstr("hull.ply: needs the component library meshes, which is not here; `scripts/setup ")));
    for (const char* command : {"study", "dataset", "device"}) {
        EXPECT_THAT(call({command, "error", "--scene", "flat_bottom"}),
                    isRefused(HasSubstr(std::string(command) + ": is in the component library " + command +
                                        ", which is not here")))
            << command;
    }
    EXPECT_THAT(call({"--help"}).out, HasSubstr("(not installed)"));
    EXPECT_THAT(call({"describe", "nav::ImuTask"}),
                isRefused(HasSubstr("nav::ImuTask: is in the component library nav, which is not here")));
    for (const char* list : {"describe", "schema"})
        EXPECT_THAT(call({list}).out, testing::AllOf(HasSubstr("sonar::SonarTask"), Not(HasSubstr("nav::ImuTask"))));
    add("nav");
    EXPECT_THAT(call({"describe", "nav::ImuTask"}).out, HasSubstr("ports"));
    EXPECT_EQ(check("nav::ImuTask").err.find("not here"), std::string::npos);
}

TEST_F(ComponentLibraryTest, ReportsAPropertyThatNeedsAnAbsentLibraryBeforeAnyPing) {
    writeFile(folder_ / "wall.gltf", wallGltf());
    writeFile(folder_ / "a.sdf", "<sdf/>\n");
    const std::string file = "file: wall.gltf", sonar = "  sonar:\n";
    for (const auto& [property, library] : std::map<std::string, std::string>{
             {"bathymetry: {file: floor.tif}", "survey"}, {"gazebo: {world: sea}", "gazebo"}, {"file: a.sdf", "sdf"}}) {
        writeFile(folder_ / "a.yml", replaced(wall_deployment, file, property));
        EXPECT_THAT(call({"check", "a.yml"}), isRefused(HasSubstr("needs the component library " + library +
                                                                  ", which is not here; `scripts/setup ")))
            << property;
    }
    const std::string picture = "  fan: {type: output::FanImageTask, properties: {video: fan.mp4}}\n";
    writeFile(folder_ / "a.yml",
              replaced(wall_deployment, sonar, picture + sonar) + "  - {from: sonar.ping, to: fan.ping}\n");
    EXPECT_THAT(call({"run", "a.yml", "--pings", "1"}),
                isRefused(HasSubstr("tasks.fan.properties.video: needs the component library video, which is not")));
    INSONIFY_NEEDS("video");
    add("video");
    EXPECT_EQ(call({"run", "a.yml", "--pings", "2"}).code, 0);
}

TEST_F(ComponentLibraryTest, AptDoesNotInstallLibrariesForAPythonPackage) {
    writeFile(folder_ / "__init__.py", "");
    EXPECT_THAT(check("nav::ImuTask").err,
                HasSubstr("nav, which is not in wheels and archives; it is in insonify-nav_"));
}

TEST_F(ComponentLibraryTest, TheCoreIsNotLinkedWithLibrariesOfComponents) {
    const std::string linked = Process({"ldd", build / "bin/insonify"}, folder_.path()).wait().out;
    ASSERT_THAT(linked, HasSubstr("libinsonify.so"));
    EXPECT_LE(std::ranges::count(linked, '\n'), 40) << linked;
    for (const char* library : {"gdal", "assimp", "sdformat", "ddsc", "zmq", "protobuf", "boost", "snappy", "avcodec",
                                "opencv_videoio", "opencv_imgcodecs"})
        EXPECT_THAT(linked, Not(HasSubstr(library)));
}

TEST_F(ComponentLibraryTest, PythonReportsTheSameErrorsAsTheCommand) {
    if (!fs::exists(build / "python/insonify")) GTEST_SKIP() << "SKIPPED: the Python module is not built";
    EXPECT_THAT(simulate("nav::ImuTask").out, HasSubstr("needs the component library nav, which is not here"));
    add("nav");
    EXPECT_THAT(simulate("nav::ImuTask").out, HasSubstr("tasks.more: input port pose")) << "it is loaded, and checked";
}

TEST_F(ComponentLibraryTest, PythonLoadsALibraryThatIsLinkedWithNothing) {
    if (!fs::exists(build / "python/insonify")) GTEST_SKIP() << "SKIPPED: the Python module is not built";
    give("one_type");
    const Outcome outcome = simulate("one_type::CounterTask");
    EXPECT_EQ(outcome.out, "made\n") << outcome.err;
}

TEST_F(ComponentLibraryTest, TheListHasInstalledAbsentAndBrokenLibraries) {
    add("nav");
    writeFile(installed("study"), "no library\n");
    const std::string list = call({"libraries"}).out;
    EXPECT_THAT(list, HasSubstr("nav        here     a DVL"));
    EXPECT_THAT(list, HasSubstr("viewer     absent   the live view"));
    EXPECT_THAT(list, HasSubstr("study      broken   "));
    EXPECT_THAT(call({"--help"}).err, HasSubstr("notice: ")) << "a broken library does not prevent other commands";
    EXPECT_EQ(call({"study"}).code, 2);
    EXPECT_EQ(call({"describe"}).code, 0);
}

TEST(ComponentTableTest, HasEveryLibraryThatThisBuildMakes) {
    size_t made = 0;
    for (const auto& entry : fs::directory_iterator(components)) {
        if (entry.path().extension() != ".so") continue;
        ++made;
        EXPECT_NE(loader::findComponent(entry.path().stem().string()), nullptr) << entry.path();
    }
    EXPECT_GT(made, 0u);
}

TEST_F(ComponentLibraryTest, ListsTheMissingLibrariesOfADeployment) {
    add("nav");
    writeFile(folder_ / "a.yml", R"(tasks:
  scene: {type: scene::SceneTask, properties: {file: tank.world, bathymetry: {file: floor.tif}}}
  sea: {type: scene::SceneTask, properties: {gazebo: {world: sea}}}
  imu: {type: nav::ImuTask}
  ros: {type: dds::PublisherTask}
  fan: {type: output::FanImageTask, properties: {file: fan.mp4}}
)");
    EXPECT_EQ(call({"libraries", "a.yml"}).out, "dds\ngazebo\nsdf\nsurvey\nvideo\n");
    writeFile(installed("nav"), "no library\n");
    EXPECT_EQ(call({"libraries", "a.yml"}).out, "dds\ngazebo\nnav\nsdf\nsurvey\nvideo\n") << "a broken one too";
}

TEST_F(ComponentLibraryTest, ASceneOrVideoNeedsTheLibraryOfItsEnding) {
    const std::map<std::string, std::string> needed{{"a.world", "sdf\n"},  {"a.sdf", "sdf\n"},   {"a.urdf", "sdf\n"},
                                                    {"a.URDF", "sdf\n"},   {"a.Sdf", "sdf\n"},   {"a.obj", "meshes\n"},
                                                    {"a.STL", "meshes\n"}, {"a.glb", ""},        {"a.GLTF", ""},
                                                    {"a.avi", "video\n"},  {"a.MP4", "video\n"}, {"a.sdf.txt", ""}};
    for (const auto& [file, library] : needed) {
        writeFile(folder_ / "a.yml", "tasks:\n  a: {type: scene::SceneTask, properties: {file: " + file + "}}\n");
        EXPECT_EQ(call({"libraries", "a.yml"}).out, library) << file;
    }
}

}  // namespace
}  // namespace insonify::deployer
