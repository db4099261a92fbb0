#include <gmock/gmock.h>

#include "components/noise/NoiseTask.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::noise {
namespace {

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
            in.port.write(test::shared(test::pingOf(16, 100, 1, time)));
            task.update();
        };
        EXPECT_THAT(test::allocationsAfterTheFirst(task, cycle), testing::IsEmpty());
        EXPECT_EQ(task.noisy.written(), 99u);
    }
}

}  // namespace
}  // namespace insonify::noise
