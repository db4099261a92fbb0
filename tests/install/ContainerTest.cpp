// deploy/Dockerfile. It is built where a person does so; here it is held against what it is made of.
#include <gmock/gmock.h>

#include <set>

#include "tests/install/Outside.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

const fs::path root = insonify::test::source_dir;

std::set<std::string> wordsIn(const std::string& text) {
    std::istringstream words(text);
    return {std::istream_iterator<std::string>(words), {}};
}

/** From after the first `begin` up to the next `end`. */
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
    const size_t from = text.find(begin);
    if (from == std::string::npos) throw std::runtime_error("there is no " + begin);
    return text.substr(from + begin.size(), text.find(end, from + begin.size()) - from - begin.size());
}

std::set<std::string> packagesOfTheRecipe() {
    std::set<std::string> packages =
        wordsIn(between(readFile(root / "deploy/Dockerfile"), "--no-install-recommends \\\n", "COPY"));
    packages.erase("\\");
    return packages;
}

}  // namespace

TEST(ContainerTest, TheRecipeBuildsWithPackagesOfTheSetup) {
    const std::set<std::string> known = wordsIn(between(readFile(root / "scripts/setup"), "packages=(\n", ")\n"));
    const std::set<std::string> packages = packagesOfTheRecipe();
    for (const std::string& package : packages) EXPECT_TRUE(known.contains(package)) << package;
    const std::set<std::string> of_tests = {"libfastrtps-dev", "libgmock-dev", "libgtest-dev", "pybind11-dev",
                                            "python3-dev"};  // and of the Python module
    for (const std::string& package : known) {               // all that may be compiled or linked against
        if (!package.ends_with("-dev") || of_tests.contains(package)) continue;
        EXPECT_TRUE(packages.contains(package)) << package;
    }
}

TEST(ContainerTest, WhatItRunsIsTheDebianPackageAsAUserOfItsOwn) {
    const std::string recipe = readFile(root / "deploy/Dockerfile");
    const std::string run = recipe.substr(recipe.rfind("FROM debian:bookworm-slim\n"));
    EXPECT_THAT(run, HasSubstr("/tmp/insonify_*.deb"));
    EXPECT_THAT(run, HasSubstr("\nUSER insonify\n"));
    EXPECT_THAT(run, HasSubstr("ENTRYPOINT [\"insonify\"]"));
    EXPECT_THAT(wordsIn(readFile(root / "deploy/Dockerfile.dockerignore")), testing::IsSupersetOf({".git", "build*"}));
}

TEST(ContainerTest, AUserWithoutAHomeRunsTheCommand) {
    const TestFolder folder;
    install(folder);
    const Outcome ran = call(
        folder, {"env", "--ignore-environment", "HOME=/nowhere", "XDG_CACHE_HOME=/tmp", folder / "prefix/bin/insonify",
                 "run", folder / "prefix/share/insonify/deploy/minimal.yml", "--out", "out"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(fs::exists(folder / "out/fan_000000.png"));
}
