// Functions are short and have few branches: at most 60 lines and 20 ways through, as lizard counts them.
#include <gmock/gmock.h>

#include "tests/support/Folder.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

namespace insonify {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

struct FunctionTest : ::testing::Test {
    void SetUp() override {
        if (!pythonHas("lizard")) GTEST_SKIP() << "python has no lizard; scripts/setup installs it";
    }
    /** The functions below a folder that are too long or have too many branches, a line each. */
    std::string tooMuchIn(const std::string& folder) const {
        return pythonSays("-m lizard --languages cpp --warnings_only --length 60 --CCN 20 " + folder,
                          folder_ / "answer.txt");
    }

    const Folder folder_;
};

TEST_F(FunctionTest, NoneIsLongOrHasManyBranches) {
    for (const char* folder : {"types", "components", "tests"})
        EXPECT_THAT(tooMuchIn(test::sourceFile(folder)), IsEmpty()) << folder;
}

TEST_F(FunctionTest, TheRuleRefusesWhatItShould) {
    std::string lines, branches;
    for (int i = 0; i < 60; ++i) lines += "    call();\n";
    for (int i = 0; i < 20; ++i) branches += "    if (wrong()) return;\n";
    std::filesystem::create_directory(folder_ / "wrong");
    std::ofstream(folder_ / "wrong" / "wrong.cpp")
        << "void tooLong() {\n" + lines + "}\nvoid tooBranched() {\n" + branches + "}\nvoid good() { call(); }\n";
    EXPECT_THAT(tooMuchIn(folder_ / "wrong"), AllOf(HasSubstr("tooLong has 62"), HasSubstr("tooBranched has"),
                                                    HasSubstr(" 21 CCN"), Not(HasSubstr("good"))));
}

}  // namespace
}  // namespace insonify
