// .aris files, read by `insonify log import`.
#include <gtest/gtest.h>

#include "components/output/ArisFile.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

void readAris(const Input& input) try {
    output::ArisFile file(input.file());
    while (const auto frame = file.next()) {
        EXPECT_NO_THROW(frame->ping.validate());
        EXPECT_GE(frame->altitude, 0);
        EXPECT_GE(frame->window_start, 0);
    }
    for (const std::string& notice : file.notices()) expectOurWords(notice);
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

TEST(ArisFuzzTest, EveryFileIsPingsOrAnError) {
    push({"aris", "dive.aris", {std::string("\x44\x44\x46\x05", 4), std::string("\x01\0\0\0", 4)}, readAris});
}

}  // namespace
}  // namespace insonify::fuzz
