#include <gmock/gmock.h>

#include "components/output/tasks/PairPictureTask.hpp"
#include "tests/output/PictureBench.hpp"
#include "tests/output/Pixels.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::output {
namespace {

using testing::HasSubstr;

/** Returns 60 beams over 120 deg, 100 bins. Beams 0 to 29, to starboard, show object 0 from 30 bins on; the others show
 *  object 1 from 60 bins on. Nearer bins are in shadow. */
types::Sonar truthAt(double seconds) {
    types::Sonar ping = test::emptyPing(120, 60);
    ping.time = types::Time::fromSeconds(seconds);
    ping.bins.assign(ping.bins.size(), 1);
    return ping;
}

types::SonarTruth getTruth(const types::Sonar& ping) {
    types::SonarTruth truth;
    truth.copyGrid(ping);
    truth.objects = {"quay", "wreck", "chain"};
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        for (uint32_t bin = 0; bin < ping.bin_count; ++bin) {
            const bool starboard = beam < 30, shown = bin >= (starboard ? 30u : 60u);
            truth.object[beam * ping.bin_count + bin] = !shown ? -1 : starboard ? 0 : 1;
            truth.shadow[beam * ping.bin_count + bin] = !shown;
        }
    return truth;
}

struct TruthImageTaskTest : test::PictureBench<TruthImageTask, types::SonarTruthPtr> {
    TruthImageTaskTest() : PictureBench(&TruthImageTask::truth) {
        TruthImageConfig config;
        config.width = 1200;
        config.reference_db = 0;
        config.timeout = 0.5;
        task_.config.set(config);
    }
    void givePing(double seconds) { give(truthAt(seconds)); }
    void giveTruth(double seconds) {
        giveSecond(std::make_shared<const types::SonarTruth>(getTruth(truthAt(seconds))));
    }
};

TEST_F(TruthImageTaskTest, ShowsObjectsInTheirColoursNextToTheFan) {
    start();
    giveTruth(1);
    givePing(1);
    ASSERT_EQ(pictures(), 1u) << task_.lastError();
    EXPECT_EQ(last_->time, types::Time::fromSeconds(1));
    const cv::Mat picture = test::toPixels(*last_);
    FanImage fan([] {
        DisplayConfig config;
        config.width = 600;
        return config;
    }());
    types::Image alone;
    fan.paint(truthAt(1), alone);
    const auto pixel = [&](double share, double bearing_deg, int half) {
        const cv::Point2d at = fan.layout().pixel(share * fan.layout().range(), types::radians(bearing_deg));
        return picture.at<cv::Vec3b>(cvRound(at.y), cvRound(at.x) + 600 * half);
    };
    EXPECT_EQ(pixel(0.86, -23, 0), cv::Vec3b(255, 255, 255)) << "the echoes, in grey";
    EXPECT_EQ(pixel(0.86, -23, 1), TruthImage::getColour(0));
    EXPECT_EQ(pixel(0.86, 23, 1), TruthImage::getColour(1));
    EXPECT_EQ(pixel(0.46, -23, 1), TruthImage::getColour(0));
    EXPECT_EQ(pixel(0.46, 23, 1)[0], 255) << "in shadow, as blue as its echo at least";
    EXPECT_GT(cv::norm(TruthImage::getColour(0), TruthImage::getColour(1)), 100);
}

TEST_F(TruthImageTaskTest, TheLegendNamesTheObjectsShown) {
    start();
    giveTruth(1);
    givePing(1);
    ASSERT_EQ(pictures(), 1u);
    const cv::Mat right = test::toPixels(*last_).colRange(600, 1200);
    const auto hasSwatch = [&](int32_t object) {
        for (int row = FanLayout::title_height; row < right.rows / 2; ++row)
            if (right.at<cv::Vec3b>(row, 14) == TruthImage::getColour(object)) return true;
        return false;
    };
    EXPECT_TRUE(hasSwatch(0));
    EXPECT_TRUE(hasSwatch(1));
    EXPECT_FALSE(hasSwatch(2)) << "no bin shows it";
}

TEST_F(TruthImageTaskTest, APingWaitsForItsTruthAndIsOmittedWithoutIt) {
    start();
    givePing(1);
    EXPECT_EQ(pictures(), 0u);
    giveTruth(1);
    EXPECT_EQ(pictures(), 1u);
    givePing(1.1);
    giveTruth(1.2);
    givePing(1.2);
    EXPECT_EQ(pictures(), 1u);
    EXPECT_EQ(last_->time, types::Time::fromSeconds(1.2));
    EXPECT_THAT(task_.notices(), testing::Contains(HasSubstr("1 pings not shown because their truth is missing")));
}

TEST_F(TruthImageTaskTest, RefusesTheTruthOfAnotherSonar) {
    start();
    types::Sonar other = truthAt(1);
    other.resize(50, 60);
    second_.port.write(std::make_shared<const types::SonarTruth>(getTruth(other)));
    givePing(1);
    EXPECT_EQ(task_.state(), framework::TaskState::Exception);
    EXPECT_THAT(task_.lastError(), HasSubstr("a ping of 60 x 100 bins does not fit a truth of 60 x 50"));
}

TEST_F(TruthImageTaskTest, TwoPicturesTake512Pixels) {
    TruthImageConfig config;
    config.width = 511;
    EXPECT_THAT(test::countRefusals(config), testing::ElementsAre(testing::StartsWith("width: ")));
}

TEST_F(TruthImageTaskTest, ASteadyStreamAllocatesNothingOfOurs) {
    start();
    const auto cycle = [&](const types::SonarPtr& ping, const types::SonarTruthPtr& truth) {
        second_.port.write(truth);
        pings_.port.write(ping);
        task_.update();
        pictures();
    };
    std::vector<types::SonarPtr> pings;
    std::vector<types::SonarTruthPtr> truths;
    for (int i = 0; i < 20; ++i) {
        pings.push_back(std::make_shared<const types::Sonar>(truthAt(1 + i)));
        truths.push_back(std::make_shared<const types::SonarTruth>(getTruth(*pings.back())));
    }
    cycle(pings[0], truths[0]);
    std::vector<std::string> places = test::allocationsOn(task_, [&] {
        for (size_t i = 1; i < pings.size(); ++i) cycle(pings[i], truths[i]);
    });
    std::erase_if(places, [](const std::string& place) { return place.starts_with("libopencv_"); });
    EXPECT_THAT(places, testing::IsEmpty());
    EXPECT_EQ(task_.image.written(), 20u) << task_.lastError();
}

TEST_F(TruthImageTaskTest, ShowsPingsAfterTheClockIsSetBack) {
    start();
    for (const double time : {1000.0, 1001.0, 400.0, 400.1, 1.6e9, 2.0}) {
        givePing(time);
        giveTruth(time);
    }
    ASSERT_TRUE(task_.stop());
    EXPECT_EQ(pictures(), 6u);
}

}  // namespace
}  // namespace insonify::output
