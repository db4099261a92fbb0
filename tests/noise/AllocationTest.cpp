#include "components/noise/NoiseTask.hpp"
#include "tests/support/PingAllocations.hpp"

namespace insonify::noise {
namespace {

TEST(AllocationTest, NoiseAllocatesNothingAfterTheFirstPings) {
    for (const SpeckleLaw law : {SpeckleLaw::Rayleigh, SpeckleLaw::Gamma, SpeckleLaw::K, SpeckleLaw::Gaussian}) {
        NoiseConfig config;
        config.speckle.emplace().law = law;
        config.additive.emplace();
        config.ambient.emplace().level_db = -60;
        test::expectNoAllocation(config, &NoiseTask::clean, &NoiseTask::noisy);
        if (law != SpeckleLaw::Rayleigh && law != SpeckleLaw::K) continue;
        config.filter = FilterConfig{2, 1.5, 2};
        test::expectNoAllocation(config, &NoiseTask::clean, &NoiseTask::noisy);
    }
}

}  // namespace
}  // namespace insonify::noise
