#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "components/dataset/Annotate.hpp"
#include "tests/support/Fans.hpp"

namespace insonify::dataset {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr uint32_t beams = 61, bins = 100;
constexpr double bin_width = 0.0213;  // [m]; differs from the ping's rounded duration

/** A floor at -20 dB everywhere, with a "rock" and a "pile" at 0 dB. */
struct AnnotateTest : ::testing::Test {
    AnnotateTest() {
        ping_ = test::emptyPing(120, beams, bins);
        ping_.bin_width = bin_width;
        std::ranges::fill(ping_.bins, 0.01f);
        truth_.beam_count = beams, truth_.bin_count = bins;
        truth_.objects = {"floor", "rock", "pile"};
        truth_.object.assign(ping_.bins.size(), 0);
        truth_.share.assign(ping_.bins.size(), 1);
        put(1, {20, 24}, {50, 60});
        put(2, {40, 41}, {70, 72});
        sweep_.classes = {{"stone", {"rock"}, 1, 1}, {"pile", {"pile"}, 1, 1}};
        picture_.reference_db = 0;
        picture_.height = 200;
    }
    struct Span {
        uint32_t first, last;
    };
    static constexpr int32_t nothing = types::SonarTruth::no_object;
    void put(int32_t object, Span in_beams, Span in_bins, float intensity = 1, float share = 1) {
        for (uint32_t beam = in_beams.first; beam < in_beams.last; ++beam)
            for (uint32_t bin = in_bins.first; bin < in_bins.last; ++bin) {
                const size_t at = size_t{beam} * bins + bin;
                ping_.bins[at] = intensity, truth_.object[at] = object, truth_.share[at] = share;
            }
    }
    Annotated annotated() {
        shown_.emplace(picture_);
        shown_->take(ping_);
        const Classes classes(sweep_, truth_.objects, nodes_);
        std::vector<Lineage> lineages = lineages_;
        for (size_t i = lineages.size(); i < truth_.objects.size(); ++i) lineages.push_back({truth_.objects[i]});
        const Instances instances(classes, lineages);
        return annotate(ping_, truth_, *shown_, classes, instances, config_, picture_.scale, {}, hiders_);
    }
    /** Whether a box contains the pixel of a bin. */
    bool holds(const Box& box, uint32_t beam, uint32_t bin) const {
        const cv::Point at = shown_->findPixel(beam, bin / shown_->binsPerCell());
        return at.x >= box.x && at.x < box.x + box.width && at.y >= box.y && at.y < box.y + box.height;
    }

    types::Sonar ping_;
    types::SonarTruth truth_;
    std::vector<int32_t> hiders_;  ///< Empty: no shadows.
    Sweep sweep_;
    std::vector<Lineage> lineages_;  ///< Empty: each object is alone.
    std::vector<std::string> nodes_;
    output::PlainConfig picture_;
    AnnotationConfig config_;
    std::optional<output::PlainPicture> shown_;
};

TEST_F(AnnotateTest, TheOrderOfTheBeamsChangesNothing) {
    const Annotated expected = annotated();
    std::vector<uint32_t> order(beams);
    for (uint32_t i = 0; i < beams; ++i) order[i] = (i * 23 + 5) % beams;
    const types::Sonar ascending = ping_;
    const types::SonarTruth truth = truth_;
    ping_ = test::reordered(ascending, order);
    for (size_t beam = 0; beam < beams; ++beam)
        std::copy_n(&truth.object[size_t{order[beam]} * bins], bins, &truth_.object[beam * bins]);
    const Annotated all = annotated();
    EXPECT_EQ(all.labels, expected.labels);
    ASSERT_THAT(all.annotations, SizeIs(2));
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(all.annotations[i].box, expected.annotations[i].box);
        EXPECT_EQ(all.annotations[i].runs, expected.annotations[i].runs);
        EXPECT_EQ(all.annotations[i].bearing_min, expected.annotations[i].bearing_min);
        EXPECT_EQ(all.annotations[i].bearing_max, expected.annotations[i].bearing_max);
    }
}

TEST_F(AnnotateTest, TheBearingsOfAnObjectAcrossTheSeamAreOneInterval) {
    for (types::Angle& bearing : ping_.bearings) bearing = types::Angle::fromRad(bearing.rad + std::numbers::pi);
    const auto middle = static_cast<uint32_t>(beams / 2);
    put(1, {middle - 2, middle + 3}, {80, 90});
    put(1, {20, 24}, {50, 60}, 0.01f, 0);
    const Annotated all = annotated();
    ASSERT_THAT(all.annotations, SizeIs(2));
    const double step = types::radians(120.0 / beams);
    EXPECT_NEAR(all.annotations[0].bearing_min, std::numbers::pi - 2 * step, 1e-9);
    EXPECT_NEAR(all.annotations[0].bearing_max, std::numbers::pi + 2 * step, 1e-9);
}

TEST_F(AnnotateTest, EachObjectOfAClassHasABoxThatHoldsItsBins) {
    const Annotated all = annotated();
    ASSERT_THAT(all.annotations, SizeIs(2));
    const Annotation &rock = all.annotations[0], &pile = all.annotations[1];
    EXPECT_EQ(rock.name, "rock");
    EXPECT_EQ(rock.category, 1u);
    EXPECT_EQ(pile.category, 2u);
    EXPECT_EQ(rock.bins, 40u);
    EXPECT_NEAR(rock.energy, 40, 1e-3);
    EXPECT_NEAR(rock.range_min, 50 * bin_width, 1e-9);
    EXPECT_NEAR(rock.range_max, 60 * bin_width, 1e-9);
    EXPECT_EQ(rock.bearing_min, ping_.bearings[20].rad);
    EXPECT_EQ(rock.bearing_max, ping_.bearings[23].rad);
    for (uint32_t beam = 20; beam < 24; ++beam)
        for (uint32_t bin = 50; bin < 60; ++bin) EXPECT_TRUE(holds(rock.box, beam, bin)) << beam << " " << bin;
    EXPECT_FALSE(holds(rock.box, 40, 70));
    EXPECT_TRUE(holds(pile.box, 40, 70));
}

TEST_F(AnnotateTest, AShadowIsThatOfTheObjectThatHidesItsBins) {
    sweep_.annotations.shadows = config_.shadows = true;
    hiders_.assign(ping_.bins.size(), nothing);
    const auto hide = [&](Span in_beams, Span in_bins) {
        put(nothing, in_beams, in_bins, 0, 0);
        for (uint32_t beam = in_beams.first; beam < in_beams.last; ++beam)
            std::fill_n(&hiders_[size_t{beam} * bins + in_bins.first], in_bins.last - in_bins.first, 1);
    };
    hide({20, 24}, {60, 80});
    hide({30, 34}, {75, 90});
    put(nothing, {50, 54}, {75, 90}, 0, 0);  // dark, and hidden by nothing
    const Annotated all = annotated();
    ASSERT_THAT(all.annotations, SizeIs(3));
    const Annotation& shadow = all.annotations[2];
    EXPECT_TRUE(shadow.is_shadow && !all.annotations[0].is_shadow);
    EXPECT_EQ(shadow.name, "rock");
    EXPECT_EQ(shadow.object, 1);
    EXPECT_EQ(shadow.category, 3u);
    EXPECT_EQ(shadow.bins, 4u * 20 + 4 * 15);
    EXPECT_EQ(shadow.energy, 0);
    EXPECT_NEAR(shadow.range_min, 60 * bin_width, 1e-9);
    EXPECT_NEAR(shadow.range_max, 90 * bin_width, 1e-9);
    EXPECT_EQ(shadow.bearing_min, ping_.bearings[20].rad);
    EXPECT_EQ(shadow.bearing_max, ping_.bearings[33].rad);
    EXPECT_TRUE(holds(shadow.box, 21, 70) && holds(shadow.box, 33, 89));
    EXPECT_FALSE(holds(shadow.box, 52, 80));
}

/** Bins of a beam: lit in both pings, dark in both, hidden, hidden behind water, lit by a mirror without the object,
 *  and hidden by another object already. */
TEST_F(AnnotateTest, AShadowIsLitWithoutItsObjectAndDarkWithIt) {
    types::SonarTruth with, without;
    with.beam_count = without.beam_count = 1, with.bin_count = without.bin_count = 6;
    with.object = {0, -1, -1, -1, -1, -1}, with.hits = {3, 0, 0, 0, 0, 0}, with.path = {0, 0, 0, 6, 0, 0};
    without.object = {0, -1, 0, -1, 0, 0}, without.hits = {3, 0, 2, 2, 2, 2}, without.path = {0, 0, 0, 6, 1, 0};
    std::vector<int32_t> hiders = {-1, -1, -1, -1, -1, 7};
    addShadow(with, without, 4, hiders);
    EXPECT_THAT(hiders, ElementsAre(-1, -1, 4, 4, -1, 7));
}

TEST_F(AnnotateTest, RunsLabelsAndAreaAgree) {
    const Annotated all = annotated();
    for (size_t i = 0; i < all.annotations.size(); ++i) {
        const Annotation& annotation = all.annotations[i];
        uint32_t place = 0, area = 0;
        for (size_t run = 0; run < annotation.runs.size(); ++run)
            for (uint32_t k = 0; k < annotation.runs[run]; ++k, ++place) {
                const uint32_t x = place / shown_->height(), y = place % shown_->height();
                const bool in_label = all.labels[size_t{y} * shown_->width() + x] == i + 1;
                ASSERT_EQ(in_label, run % 2 == 1) << x << " " << y;
                area += in_label;
            }
        EXPECT_EQ(place, shown_->width() * shown_->height());
        EXPECT_EQ(area, annotation.area);
    }
}

TEST_F(AnnotateTest, ThePolarPictureHasAPixelForEachBin) {
    picture_.shape = output::PlainShape::Polar;
    const Annotated all = annotated();
    ASSERT_THAT(all.annotations, SizeIs(1));  // the pile has two bins
    EXPECT_EQ(all.annotations[0].area, 40u);
    EXPECT_EQ(all.annotations[0].box, (Box{static_cast<int>(beams) - 24, bins - 60, 4, 10}));
}

TEST_F(AnnotateTest, InvisibleObjectsAreNotAnnotated) {
    put(1, {20, 24}, {50, 60}, 1e-6f);  // below black
    EXPECT_THAT(annotated().annotations, SizeIs(1));
    put(1, {20, 24}, {50, 60}, 1, 0.4f);  // most of the energy is from something else
    EXPECT_THAT(annotated().annotations, SizeIs(1));
    config_.min_share = 0.3;
    EXPECT_THAT(annotated().annotations, SizeIs(2));
    config_.min_level = 255;
    put(1, {20, 24}, {50, 60}, 0.9f);
    EXPECT_THAT(annotated().annotations, SizeIs(1));
    config_.min_pixels = 100000;
    const Annotated none = annotated();
    EXPECT_THAT(none.annotations, IsEmpty());
    EXPECT_EQ(std::accumulate(none.labels.begin(), none.labels.end(), 0), 0);
}

TEST_F(AnnotateTest, TheLoudestBinLabelsItsCell) {
    picture_.shape = output::PlainShape::Polar;
    picture_.height = 25;
    config_.min_pixels = 1;
    put(2, {22, 23}, {52, 53}, 100);
    const Annotated all = annotated();
    const Annotation& pile = all.annotations.at(1);
    EXPECT_EQ(pile.box.x, static_cast<int>(beams) - 41);
    EXPECT_EQ(pile.area, 2u);  // including the cell that it takes from the rock
    EXPECT_NEAR(pile.energy, 102, 1e-3);
}

TEST_F(AnnotateTest, LevelsAreTurnedIntoEnergies) {
    picture_.scale = output::BinScale::Decibel;
    for (float& bin : ping_.bins) bin = 10 * std::log10(bin);
    EXPECT_NEAR(annotated().annotations.at(0).energy, 40, 1e-3);
}

TEST_F(AnnotateTest, PartsOfOneThingAreOneInstance) {
    truth_.objects = {"floor", "tire", "hub"};
    lineages_ = {{"floor"}, {"tire", "wheel_1"}, {"hub", "wheel_1"}};
    nodes_ = {"wheel_1"};
    sweep_.classes = {{"wheel", {"wheel_*"}, 1, 1}};
    const Annotated all = annotated();
    ASSERT_THAT(all.annotations, SizeIs(1));
    const Annotation& wheel = all.annotations[0];
    EXPECT_EQ(wheel.name, "wheel_1");
    EXPECT_EQ(wheel.object, 1);
    EXPECT_THAT(wheel.parts, ElementsAre(1, 2));
    EXPECT_EQ(wheel.bins, 42u);
    EXPECT_TRUE(holds(wheel.box, 20, 50) && holds(wheel.box, 40, 71));
}

TEST_F(AnnotateTest, EchoesByMirrorsAreGhostsOnRequestAndNoObjects) {
    truth_.path.assign(ping_.bins.size(), 0);
    const auto came = [&](uint8_t path, Span in_beams, Span in_bins) {
        put(1, in_beams, in_bins);
        for (uint32_t beam = in_beams.first; beam < in_beams.last; ++beam)
            for (uint32_t bin = in_bins.first; bin < in_bins.last; ++bin) truth_.path[size_t{beam} * bins + bin] = path;
    };
    const auto energyOfRock = [&] { return annotated().annotations.at(0).energy; };
    came(types::SonarTruth::through_wall, {20, 22}, {50, 60});
    came(types::SonarTruth::through_wall + 1, {22, 24}, {50, 60});
    EXPECT_NEAR(energyOfRock(), 40, 1e-3) << "through a wall, or rung in one, it is the object still";
    came(1, {20, 24}, {80, 90});
    came(3, {30, 33}, {20, 30});
    EXPECT_NEAR(energyOfRock(), 40, 1e-3);
    sweep_.annotations.ghosts = config_.ghosts = true;
    config_.min_pixels = 1;
    const Annotated all = annotated();
    ASSERT_THAT(all.annotations, SizeIs(4)) << "rock, pile, and two ghosts that do not touch";
    double ghosts = 0;
    for (size_t i = 2; i < 4; ++i) {
        EXPECT_EQ(all.annotations[i].name, "ghost");
        EXPECT_EQ(all.annotations[i].category, 3u);
        EXPECT_EQ(all.annotations[i].object, -1);
        EXPECT_FALSE(all.annotations[i].is_shadow);
        ghosts += all.annotations[i].energy;
    }
    EXPECT_NEAR(ghosts, 4 * 10 + 3 * 10, 1e-3);
    EXPECT_TRUE(holds(all.annotations[2].box, 21, 85) || holds(all.annotations[3].box, 21, 85));
}

/** The truth names objects outside of the file, such as the tiles of a survey, which have no class. */
TEST_F(AnnotateTest, ObjectsBeyondTheFilesAreOfNoClass) {
    lineages_ = {{"floor"}, {"rock"}};
    const Classes classes(sweep_, truth_.objects);
    const Instances instances(classes, lineages_);
    shown_.emplace(picture_);
    shown_->take(ping_);
    const Annotated all = annotate(ping_, truth_, *shown_, classes, instances, config_, picture_.scale);
    ASSERT_THAT(all.annotations, SizeIs(1));
    EXPECT_EQ(all.annotations[0].name, "rock");
}

/** A rock's shadow is full of water. */
TEST_F(AnnotateTest, WaterIsInNoMaskAndInEachShadow) {
    sweep_.annotations.shadows = config_.shadows = true;
    truth_.path.assign(ping_.bins.size(), 0);
    hiders_.assign(ping_.bins.size(), nothing);
    const auto fillWithWater = [&](Span in_beams, Span in_bins, int32_t hider) {
        put(nothing, in_beams, in_bins, 0.5f, 0.9f);
        for (uint32_t beam = in_beams.first; beam < in_beams.last; ++beam)
            for (uint32_t bin = in_bins.first; bin < in_bins.last; ++bin) {
                truth_.path[size_t{beam} * bins + bin] = types::SonarTruth::water;
                hiders_[size_t{beam} * bins + bin] = hider;
            }
    };
    fillWithWater({20, 24}, {60, 80}, 1);
    fillWithWater({50, 60}, {5, 20}, nothing);
    const Annotated all = annotated();
    ASSERT_THAT(all.annotations, SizeIs(3)) << "rock, pile, and the rock's shadow";
    EXPECT_EQ(all.annotations[0].bins, 4u * 10);
    EXPECT_TRUE(all.annotations[2].is_shadow);
    EXPECT_EQ(all.annotations[2].name, "rock");
    EXPECT_EQ(all.annotations[2].bins, 4u * 20);
    EXPECT_NEAR(all.annotations[2].range_max, 80 * bin_width, 1e-9);
    for (const Annotation& each : all.annotations) EXPECT_FALSE(holds(each.box, 55, 10)) << each.name;
}

TEST_F(AnnotateTest, ATruthOfAnotherGridIsRefused) {
    truth_.bin_count = 10;
    EXPECT_THROW(annotated(), std::runtime_error);
}

}  // namespace
}  // namespace insonify::dataset
