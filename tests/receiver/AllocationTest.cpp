#include <gmock/gmock.h>

#include "components/receiver/ReceiverTask.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::receiver {
namespace {

TEST(AllocationTest, AReceiverAllocatesNothingAfterTheFirstPings) {
    for (const Output output : {Output::Intensity, Output::Amplitude, Output::LevelDb, Output::Code}) {
        ReceiverTask task("receiver");
        test::Writer<types::SonarPtr> in;
        test::Reader<types::SonarPtr> out;
        in.port.connectTo(task.intensity, {});
        task.ping.connectTo(out.port, {});
        ReceiverConfig config;
        config.tvg.emplace().log_coefficient = 40;
        config.blanking.emplace().range_min = 0.5;
        config.output = output;
        task.config.set(config);
        ASSERT_TRUE(task.configure());
        ASSERT_TRUE(task.start());
        const auto cycle = [&](int64_t time) {
            in.port.write(test::shared(test::pingOf(16, 100, 1, time)));
            task.update();
        };
        EXPECT_THAT(test::allocationsAfterTheFirst(task, cycle), testing::IsEmpty());
        EXPECT_EQ(task.ping.written(), 99u);
    }
}

}  // namespace
}  // namespace insonify::receiver
