// Recordings of other makers' sonars, read by `insonify log import`.
#include <gtest/gtest.h>

#include "components/device/PingViewerLog.hpp"
#include "components/recordings/ArisFile.hpp"
#include "components/recordings/GlfFile.hpp"
#include "components/recordings/JsfFile.hpp"
#include "components/recordings/XtfFile.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

/** @tparam File reads one format. */
template <class File>
void readRecording(const Input& input) try {
    File file(input.file());
    while (const auto next = file.next()) {
        EXPECT_NO_THROW(next->ping.validate());
        if (std::is_same_v<File, recordings::XtfFile>) {
            EXPECT_LE(next->ping.bins.size(), 20 * input.bytes().size());  // of two sides, resampled by at most 10
        }
        EXPECT_GE(next->altitude, 0);
        EXPECT_GE(next->window_start, 0);
    }
    for (const std::string& notice : file.notices()) expectOurWords(notice);
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

TEST(ArisFuzzTest, EveryFileIsPingsOrAnError) {
    push({"aris",
          "dive.aris",
          {std::string("\x44\x44\x46\x05", 4), std::string("\x01\0\0\0", 4)},
          readRecording<recordings::ArisFile>});
}

TEST(GlfFuzzTest, EveryFileIsPingsOrAnError) {
    push({"glf",
          "dive.glf",
          {std::string("PK\3\4", 4), std::string("*\2", 2), std::string("\x01\0\xEF\xEF", 4),
           std::string("\xDE\xDE", 2), std::string("\x78\x9C", 2)},
          readRecording<recordings::GlfFile>});
}

TEST(JsfFuzzTest, EveryFileIsPingsOrAnError) {
    push({"jsf",
          "line.jsf",
          {std::string("\x01\x16\x0D\0\x50\0\0\x14", 8), std::string("\x01\x16", 2)},
          readRecording<recordings::JsfFile>});
}

TEST(PingViewerFuzzTest, EveryFileIsPingsOrAnError) {
    push({"ping_viewer",
          "20240229-235959500.bin",
          {std::string("\0\0\0\x18\0", 5), std::string("\0\0\0\x0C", 4), std::string("\xFF\xFF\xFF\xFF", 4),
           std::string("\0\x32\0\x33\0:", 6), std::string("BR", 2), std::string("\xFC\x08", 2),
           std::string("\x14\x05", 2)},
          readRecording<device::PingViewerReader>});
}

TEST(XtfFuzzTest, EveryFileIsPingsOrAnError) {
    push({"xtf",
          "line.xtf",
          {std::string("\xCE\xFA\0\0\x02\0", 6), std::string("\x7B\x01", 2)},
          readRecording<recordings::XtfFile>});
}

}  // namespace
}  // namespace insonify::fuzz
