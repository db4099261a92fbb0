#include "components/sonar/bins/EstimateBatch.hpp"

namespace insonify::sonar {
namespace {

#define HAVE_PHYSICAL
#define HAVE_NEAREST
struct NearestBins : Bins {
    static constexpr Features features{Feature::Physical, Feature::Nearest};
    using Bins::Bins;
    void addToBin(uint beam, uint bin, double amount, double) const { sums[beam * beam_sums + bin] += quanta(amount); }
#include "shaders/deposit.glsl"
};
#undef HAVE_NEAREST
#undef HAVE_PHYSICAL

INSONIFY_ESTIMATE(sumNearest, NearestBins)

constexpr EstimatorEntry entries[] = {
    {NearestBins::features, sumNearest},
    {Features{Feature::Physical, Feature::Nearest, Feature::Jitter}, sumNearest},  // at a random point
};

}  // namespace

std::span<const EstimatorEntry> nearestEstimators() { return entries; }

}  // namespace insonify::sonar
