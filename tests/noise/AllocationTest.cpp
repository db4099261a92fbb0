#include <gmock/gmock.h>

#include "components/noise/NoiseTask.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::noise {
namespace {

types::SonarPtr pingAt(int64_t time) {
    types::Sonar ping;
    ping.time = {time};
    ping.beam_count = 16;
    ping.bin_count = 100;
    ping.bearings.resize(16);
    ping.timestamps.resize(16);
    ping.bins.assign(1600, 1);
    return std::make_shared<const types::Sonar>(ping);
}

TEST(AllocationTest, NoiseAllocatesNothingAfterTheFirstPings) {
    for (const SpeckleLaw law : {SpeckleLaw::Rayleigh, SpeckleLaw::Gamma, SpeckleLaw::K, SpeckleLaw::Gaussian}) {
        NoiseTask task("noise");
        test::Writer<types::SonarPtr> in;
        test::Reader<types::SonarPtr> out;
        in.port.connectTo(task.clean, {});
        task.noisy.connectTo(out.port, {});
        NoiseConfig config;
        config.speckle.emplace().law = law;
        config.additive.emplace();
        config.ambient.emplace().level_db = -60;
        task.config.set(config);
        ASSERT_TRUE(task.configure());
        ASSERT_TRUE(task.start());
        const auto cycle = [&](int64_t time) {
            in.port.write(pingAt(time));
            task.update();
        };
        cycle(1);
        EXPECT_THAT(test::allocationsOn(task,
                                        [&] {
                                            for (int64_t time = 2; time < 100; ++time) cycle(time);
                                        }),
                    testing::IsEmpty());
        EXPECT_EQ(task.noisy.written(), 99u);
    }
}

}  // namespace
}  // namespace insonify::noise
