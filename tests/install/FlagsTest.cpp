// Flags of users and of distributions.
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/install/Outside.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using json = nlohmann::json;
using testing::HasSubstr;

TEST(FlagsTest, CodeForVectorsOfOneKindCompilesForEveryProcessor) {
#ifndef __x86_64__
    GTEST_SKIP() << "NOT TESTED: this processor has other vectors";
#endif
    const TestFolder folder;
    const fs::path root = insonify::test::source_dir;
    size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root / "components")) {
        if (entry.path().extension() != ".cpp" || readFile(entry.path()).find("<immintrin.h>") == std::string::npos)
            continue;
        ++count;
        for (const char* processor : {"x86-64", "skylake", "skylake-avx512"})
            EXPECT_THAT(call(folder, {"c++", "-std=c++20", "-O0", std::string("-march=") + processor,
                                      "-I" + root.string(), "-I" + std::string(insonify::test::build_dir) + "/include",
                                      "-S", "-o", "/dev/null", entry.path()}),
                        succeeds())
                << processor;
    }
    EXPECT_GT(count, 0u);
}

TEST(FlagsTest, WarningsAreNoErrorsWithFlagsOfAUser) {
    const TestFolder folder;
    ASSERT_THAT(call(folder, {"env", "CXXFLAGS=-Og", INSONIFY_CMAKE, "-S", insonify::test::source_dir, "-B", "build",
                              "-G", "Ninja"}),
                succeeds());
    EXPECT_THAT(readFile(folder / "build/build.ninja"),
                testing::AllOf(HasSubstr(" -Og "), testing::Not(HasSubstr("-Werror"))));
}

/** The link-time optimiser loses symbols of assembler code, and takes the versions of a member function for several
 *  processors for two definitions. */
TEST(FlagsTest, WhatTheLinkTimeOptimiserDoesNotSeeIsCompiledWithoutIt) {
    const std::regex unseen(
        R"(\n *__asm__\(|INSONIFY_VECTOR_CLONES (__attribute__\(\(flatten\)\) )?[\w:<> ]+ \w+::\w+\()");
    std::map<std::string, std::string> commands;
    const std::regex together(R"~(#include "([^"]*)")~");  // files of a unity build
    for (const json& each : json::parse(readFile(fs::path(insonify::test::build_dir) / "compile_commands.json"))) {
        const std::string file = each.at("file");
        commands[file] = each.at("command");
        const std::string text = file.find("/Unity/unity_") != file.npos ? readFile(file) : "";
        for (std::sregex_iterator part(text.begin(), text.end(), together), end; part != end; ++part)
            commands[(*part)[1]] = each.at("command");
    }
    size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(insonify::test::source_dir) / "components")) {
        if (entry.path().extension() != ".cpp" || !std::regex_search(readFile(entry.path()), unseen)) continue;
        EXPECT_THAT(commands[entry.path()], HasSubstr(" -fno-lto")) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 4u);
}
