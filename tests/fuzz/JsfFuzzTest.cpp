// External JSF files, read by `insonify log import`.
#include <gtest/gtest.h>

#include "components/output/JsfFile.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

void readJsf(const Input& input) try {
    output::JsfFile file(input.file());
    while (const auto line = file.next()) {
        EXPECT_NO_THROW(line->ping.validate());
        EXPECT_GE(line->record.altitude, 0);
    }
    for (const std::string& notice : file.notices()) expectOurWords(notice);
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

TEST(JsfFuzzTest, EveryFileIsPingsOrAnError) {
    push({"jsf", "line.jsf", {std::string("\x01\x16\x0D\0\x50\0\0\x14", 8), std::string("\x01\x16", 2)}, readJsf});
}

}  // namespace
}  // namespace insonify::fuzz
