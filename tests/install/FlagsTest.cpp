// Flags of users and of distributions.
#include <gmock/gmock.h>

#include "tests/install/Outside.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
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
