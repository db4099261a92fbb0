#include "components/sonar/bins/EstimateBatch.hpp"

namespace insonify::sonar {
namespace {

struct MeanBins : Bins {
    using Bins::Bins;
    void addToBin(uint beam, uint bin, double amount, double weight) const {
        uint64_t* cell = sums + beam * beam_sums + 2 * size_t{bin};
        cell[0] += quanta(amount);
        cell[1] += quanta(weight);
    }
};

#define HAVE_CERQUEIRA2017
struct CerqueiraBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#define HAVE_PUBLISHED
struct PublishedBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Published};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#define HAVE_ABSORPTION
struct AbsorbingPublishedBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Published, Feature::Absorption};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#undef HAVE_PUBLISHED
struct AbsorbingBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Absorption};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#undef HAVE_ABSORPTION
#undef HAVE_CERQUEIRA2017

INSONIFY_ESTIMATE(sumMeans, CerqueiraBins)
INSONIFY_ESTIMATE(sumAbsorbingMeans, AbsorbingBins)
INSONIFY_ESTIMATE(sumPublished, PublishedBins)
INSONIFY_ESTIMATE(sumAbsorbingPublished, AbsorbingPublishedBins)

constexpr EstimatorEntry entries[] = {
    {CerqueiraBins::features, sumMeans},
    {AbsorbingBins::features, sumAbsorbingMeans},
    {PublishedBins::features, sumPublished},
    {AbsorbingPublishedBins::features, sumAbsorbingPublished},
};

}  // namespace

std::span<const EstimatorEntry> meanEstimators() { return entries; }

}  // namespace insonify::sonar
