// .glf files of a Gemini, read by `insonify log import`.
#include <gtest/gtest.h>

#include "components/output/GlfFile.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

void readGlf(const Input& input) try {
    output::GlfFile file(input.file());
    while (const auto frame = file.next()) {
        EXPECT_NO_THROW(frame->ping.validate());
        EXPECT_GE(frame->altitude, 0);
        EXPECT_GE(frame->window_start, 0);
    }
    for (const std::string& notice : file.notices()) expectOurWords(notice);
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

TEST(GlfFuzzTest, EveryFileIsPingsOrAnError) {
    push({"glf",
          "dive.glf",
          {std::string("PK\3\4", 4), std::string("*\2", 2), std::string("\x01\0\xEF\xEF", 4),
           std::string("\xDE\xDE", 2), std::string("\x78\x9C", 2)},
          readGlf});
}

}  // namespace
}  // namespace insonify::fuzz
