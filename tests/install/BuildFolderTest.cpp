// Build folders of scripts/build and their installation, in small copies of the clone; only a header is built.
#include <gmock/gmock.h>

#include "tests/install/Outside.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

/** A copy of what is configured, without tests and deployments. */
void copyClone(const fs::path& to) {
    fs::create_directories(to);
    const fs::path root = insonify::test::source_dir;
    for (const char* name : {"components", "types", "scripts", "shaders"})
        fs::copy(root / name, to / name, fs::copy_options::recursive);
    fs::create_directories(to / "tests");
    for (const char* name : {"CMakeLists.txt", "README.md", "CHANGELOG.md", "LICENSE", "tests/CMakeLists.txt"})
        fs::copy(root / name, to / name);
}

/** Runs scripts/build in a clone. */
Outcome build(const TestFolder& folder, const std::string& clone, const std::string& target = "insonify_version",
              const std::vector<std::string>& before = {}) {
    std::vector<std::string> words = before;
    for (const std::string& word : {clone + "/scripts/build", std::string("build"), std::string("--"), target})
        words.push_back(word);
    return call(folder, words);
}

/** The built header, which has a hash of all headers of the sources. */
std::string built(const TestFolder& folder, const std::string& clone) {
    return readFile(folder / (clone + "/build/include/insonify_version.hpp"));
}

std::string cached(const TestFolder& folder, const std::string& clone, const std::string& name) {
    std::istringstream lines(readFile(folder / (clone + "/build/CMakeCache.txt")));
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(name + ":")) return line.substr(line.find('=') + 1);
    return "";
}

void edit(const TestFolder& folder, const std::string& clone) {
    std::ofstream(folder / (clone + "/types/Sonar.hpp"), std::ios::app) << "// edited in " << clone << "\n";
}

/** A compiler that calls itself version 11. */
void writeOldCompiler(const fs::path& file) {
    writeFile(file, "#!/bin/sh\nexec c++ -U__GNUC__ -D__GNUC__=11 \"$@\"\n");
    fs::permissions(file, fs::perms::owner_all);
}

}  // namespace

TEST(BuildFolderTest, ACopiedCloneCompilesItsOwnSources) {
    const TestFolder folder;
    copyClone(folder / "a");
    ASSERT_THAT(build(folder, "a"), succeeds());
    const std::string of_a = built(folder, "a");
    ASSERT_FALSE(of_a.empty());
    ASSERT_EQ(call(folder, {"cp", "-a", "a", "b:1"}).code, 0);
    edit(folder, "b:1");
    const Outcome outcome = build(folder, "b:1");
    ASSERT_THAT(outcome, succeeds());
    EXPECT_THAT(outcome.err, HasSubstr("was configured for the clone " + (folder / "a").string()));
    EXPECT_NE(built(folder, "b:1"), of_a) << "the edit was ignored";
    EXPECT_EQ(built(folder, "a"), of_a);
    EXPECT_THAT(readFile(folder / "b:1/build/build.ninja"), Not(HasSubstr((folder / "a/").string())));
    EXPECT_EQ(build(folder, "b:1").err, "") << "configured from new once";
}

TEST(BuildFolderTest, ARenamedCloneBuildsAndKeepsItsOptions) {
    const TestFolder folder;
    copyClone(folder / "a");
    ASSERT_THAT(call(folder, {INSONIFY_CMAKE, "-S", "a", "-B", "a/build", "-G", "Unix Makefiles",
                              "-DINSONIFY_UNITY=OFF", "-DCMAKE_BUILD_TYPE=Debug"}),
                succeeds());
    ASSERT_THAT(build(folder, "a"), succeeds());
    const std::string name = "b, c's (d) & e=1";
    fs::rename(folder / "a", folder / name);
    edit(folder, name);
    ASSERT_THAT(build(folder, name), succeeds());
    EXPECT_EQ(cached(folder, name, "CMAKE_HOME_DIRECTORY"), folder / name);
    EXPECT_EQ(cached(folder, name, "CMAKE_GENERATOR"), "Unix Makefiles");
    EXPECT_EQ(cached(folder, name, "INSONIFY_UNITY"), "OFF");
    EXPECT_EQ(cached(folder, name, "CMAKE_BUILD_TYPE"), "Debug");
}

TEST(BuildFolderTest, FoldersThatWereConfiguredByHandKeepTheirGenerator) {
    const TestFolder folder;
    copyClone(folder / "a");
    for (const std::string generator : {"Unix Makefiles", "Ninja Multi-Config", "Ninja"}) {
        fs::remove_all(folder / "a/build");
        ASSERT_THAT(call(folder, {INSONIFY_CMAKE, "-S", "a", "-B", "a/build", "-G", generator}), succeeds());
        ASSERT_THAT(build(folder, "a"), succeeds()) << generator;
        EXPECT_EQ(cached(folder, "a", "CMAKE_GENERATOR"), generator);
        EXPECT_FALSE(built(folder, "a").empty());
    }
}

TEST(BuildFolderTest, AnInterruptedConfigurationIsRepeated) {
    const TestFolder folder;
    copyClone(folder / "a");
    ASSERT_THAT(build(folder, "a"), succeeds());
    fs::remove(folder / "a/build/targets");
    fs::remove(folder / "a/build/build.ninja");
    EXPECT_THAT(build(folder, "a"), succeeds());
    fs::remove(folder / "a/build/CMakeCache.txt");
    EXPECT_THAT(build(folder, "a"), succeeds());
}

TEST(BuildFolderTest, ATargetOfChangedSourcesIsKnown) {
    const TestFolder folder;
    copyClone(folder / "a");
    ASSERT_THAT(build(folder, "a"), succeeds());
    const Outcome unknown = build(folder, "a", "added");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(unknown.err, HasSubstr("added: is no target of CMake on this system"));
    std::ofstream(folder / "a/types/CMakeLists.txt", std::ios::app) << "add_custom_target(added)\n";
    fs::last_write_time(folder / "a/types/CMakeLists.txt", fs::file_time_type::clock::now() + std::chrono::seconds(1));
    EXPECT_THAT(build(folder, "a", "added"), succeeds());
}

TEST(BuildFolderTest, AnOldCompilerIsRefusedAndAnotherOneIsTaken) {
    const TestFolder folder;
    if (!call(folder, {"c++", "--version"}).out.starts_with("c++"))
        GTEST_SKIP() << "NOT TESTED: the compiler is not g++";
    copyClone(folder / "a");
    writeOldCompiler(folder / "g++-11");
    const std::string old = "CXX=" + (folder / "g++-11").string();
    const Outcome refused = build(folder, "a", "insonify_version", {"env", old});
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("needs g++ 12 or newer"), HasSubstr("CXX=g++-12")));
    EXPECT_THAT(build(folder, "a", "insonify_version", {"env", "CXX=c++"}), succeeds()) << "as the message says";
    EXPECT_EQ(build(folder, "a", "insonify_version", {"env", old}).code, 1) << "and back";
    EXPECT_THAT(build(folder, "a"), succeeds());
}

TEST(BuildFolderTest, BuildsInOneFolderWaitForEachOther) {
    const TestFolder folder;
    copyClone(folder / "a");
    ASSERT_THAT(build(folder, "a"), succeeds());
    const Outcome waited =
        call(folder, {"bash", "-c",
                      "exec 9>a/build/.lock; flock 9; a/scripts/build build -- insonify_version 9>&- & "
                      "sleep 0.5; echo freed; exec 9>&-; wait $!; echo \"ended with $?\""});
    EXPECT_THAT(waited.err, HasSubstr("waits for another build in build"));
    EXPECT_THAT(waited.out, testing::StartsWith("freed\n"));
    EXPECT_THAT(waited.out, HasSubstr("ended with 0"));
}

TEST(BuildFolderTest, NothingIsInstalledBeforeTheCommandIsBuilt) {
    const TestFolder folder;
    copyClone(folder / "a");
    ASSERT_THAT(build(folder, "a"), succeeds());
    const Outcome refused = call(folder, {INSONIFY_CMAKE, "--install", "a/build", "--prefix", folder / "prefix"});
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("bin/insonify is not built"), HasSubstr("scripts/setup insonify")));
    EXPECT_FALSE(fs::exists(folder / "prefix"));
}

TEST(BuildFolderTest, ThePartsThatAreBuiltAreInstalled) {
    const TestFolder folder;
    copyClone(folder / "a");
    ASSERT_THAT(build(folder, "a"), succeeds());
    // As after `scripts/run` and `scripts/setup study`: the command, its core and one part.
    fs::create_directories(folder / "a/build/lib/insonify");
    for (const char* name : {"bin/insonify", "lib/libinsonify.so", "lib/libinsonify.so.0.1", "lib/libinsonify.so.0.1.0",
                             "lib/insonify/study.so"})
        fs::copy(fs::path(insonify::test::build_dir) / name, folder / "a/build" / name,
                 fs::copy_options::copy_symlinks);
    fs::copy(insonify::test::sourceFile("deploy"), folder / "a/deploy");  // without its folders
    const Outcome installed = call(folder, {INSONIFY_CMAKE, "--install", "a/build", "--prefix", folder / "prefix"});
    ASSERT_THAT(installed, succeeds());
    EXPECT_THAT(installed.out,
                AllOf(HasSubstr("Not built and omitted: "), HasSubstr("libraries for find_package(Insonify)"),
                      HasSubstr(" dds, "), testing::Not(HasSubstr(" study, ")), HasSubstr("the manual page")));
    EXPECT_THAT(call(folder, {folder / "prefix/bin/insonify", "--version"}), succeeds());
    fs::create_directories(folder / "use");
    writeFile(folder / "use/CMakeLists.txt",
              "cmake_minimum_required(VERSION 3.22)\nproject(Outside CXX)\nfind_package(Insonify REQUIRED)\n");
    const Outcome used = call(folder, {INSONIFY_CMAKE, "-S", "use", "-B", "use/build",
                                       "-DCMAKE_PREFIX_PATH=" + (folder / "prefix").string()});
    EXPECT_EQ(used.code, 1);
    EXPECT_THAT(used.err, HasSubstr("was installed before all of it was"));
}
