#include "components/receiver/ReceiverTask.hpp"
#include "tests/support/PingAllocations.hpp"

namespace insonify::receiver {
namespace {

TEST(AllocationTest, AReceiverAllocatesNothingAfterTheFirstPings) {
    for (const Output output : {Output::Intensity, Output::Amplitude, Output::LevelDb, Output::Code}) {
        ReceiverConfig config;
        config.tvg.emplace().log_coefficient = 40;
        config.blanking.emplace().range_min = 0.5;
        config.output = output;
        test::expectNoAllocation(config, &ReceiverTask::intensity, &ReceiverTask::ping);
    }
}

}  // namespace
}  // namespace insonify::receiver
