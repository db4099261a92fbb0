#include <gtest/gtest.h>

#include "components/mcap/LogSource.hpp"
#include "components/pocolog/Copy.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

/** Calls, and lets pass what a reader of logs may throw. */
template <class Call>
void allowed(Call call) try {
    call();
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

void readAll(const Input& input) {
    allowed([&] { mcap::checkLog(input.file()); });
    allowed([&] {
        const auto log = mcap::openLog(input.file());
        for (const pocolog::SampleRef& at : log->samples())
            allowed([&] { EXPECT_LE(log->bytesOf(at).size(), size_t{1} << 30); });
    });
}

void readAndRepair(const Input& input) {
    readAll(input);
    allowed([&] {
        const auto to = input.file().parent_path() / "repaired.0.log";
        pocolog::copy({input.file()}, pocolog::AtDamage::Skip, {}, to);
        EXPECT_TRUE(mcap::openLog(to)->complete());
    });
}

TEST(LogFuzzTest, EveryPocologFileIsReadAsFarAsItIsOne) {
    push({"pocolog",
          "damaged.0.log",
          {"POCOSIM", "/base/samples/Sonar", "<typelib>", "</typelib>", "insonify_seed: 7\n"},
          readAndRepair});
}

TEST(LogFuzzTest, EveryMcapFileIsReadAsFarAsItIsOne) {
    push({"mcap",
          "damaged.0.mcap",
          {"\x89MCAP0\r\n", "lz4", "zstd", "cdr", "ros2msg", "sensor_msgs/msg/Image", "nav_msgs/msg/Odometry"},
          readAll});
}

}  // namespace
}  // namespace insonify::fuzz
