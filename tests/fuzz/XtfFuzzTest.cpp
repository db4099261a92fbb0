// External XTF files, read by `insonify log import`.
#include <gtest/gtest.h>

#include "components/output/XtfFile.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

void readXtf(const Input& input) try {
    output::XtfFile file(input.file());
    while (const auto line = file.next()) {
        EXPECT_NO_THROW(line->ping.validate());
        EXPECT_LE(line->ping.bins.size(), input.bytes().size());
        EXPECT_GE(line->record.altitude, 0);
    }
    for (const std::string& notice : file.notices()) expectOurWords(notice);
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

TEST(XtfFuzzTest, EveryFileIsPingsOrAnError) {
    push({"xtf", "line.xtf", {std::string("\xCE\xFA\0\0\x02\0", 6), std::string("\x7B\x01", 2)}, readXtf});
}

}  // namespace
}  // namespace insonify::fuzz
