// Reading of .aris files, made here by Sound Metrics' published layout, intact and damaged.
#include <cmath>

#include "components/recordings/ArisFile.hpp"
#include "tests/recordings/RecordedFileTest.hpp"
#include "tests/support/ArisRecording.hpp"

namespace insonify::recordings {
namespace {

using test::ArisFrame, test::arisFile, test::putAt;
using testing::Each, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty, testing::SizeIs;

constexpr size_t first_frame = 1024, second_frame = 1024 + 1024 + 48 * 2;

/** A frame of 48 beams and two ranges. */
ArisFrame smallFrame(uint64_t after_us = 0) {
    ArisFrame frame{.model = 2, .ping_mode = 1};
    frame.time_us += after_us;
    frame.delay_us = 30;
    for (int i = 0; i < 96; ++i) frame.samples.push_back(static_cast<char>(i));
    return frame;
}

struct ArisFileTest : RecordedFileTest {
    ArisFileTest() : RecordedFileTest("fish.aris") {}
};

TEST_F(ArisFileTest, EveryModelHasItsPublishedBearingsFromStarboard) {
    struct Case {
        uint32_t model, ping_mode;
        bool is_telephoto;
        double starboard_deg, port_deg, frequency_khz;
    };
    for (const Case& the : {Case{1, 9, false, -15.0068, 15.0156, 3000}, Case{1, 6, false, -14.8872, 14.8872, 1800},
                            Case{0, 3, false, -13.749, 13.8759, 1800}, Case{0, 3, true, -7.419, 7.419, 1800},
                            Case{0, 1, false, -13.5735, 13.5735, 1100}, Case{2, 1, true, -7.339, 7.339, 700}}) {
        ArisFrame frame{.model = the.model, .ping_mode = the.ping_mode, .is_telephoto = the.is_telephoto};
        frame.is_high = the.frequency_khz == 3000 || (the.model == 0 && the.ping_mode == 3);
        frame.samples.assign(frame.beams(), '\1');
        const RecordedPing read = this->read(arisFile({frame})).at(0);
        const auto& bearings = read.ping.bearings;
        ASSERT_EQ(bearings.size(), frame.beams());
        EXPECT_NEAR(bearings.front().deg(), the.starboard_deg, 1e-12);
        EXPECT_NEAR(bearings.back().deg(), the.port_deg, 1e-12);
        EXPECT_TRUE(std::ranges::is_sorted(bearings, {}, &types::Angle::rad));
        EXPECT_EQ(read.frequency_khz, the.frequency_khz);
    }
}

TEST_F(ArisFileTest, TheSpacingOfBeamsFollowsTheLens) {
    for (const auto& [model, beams, is_telephoto] : {std::tuple{ArisModel::Aris3000, 128u, false},
                                                     {ArisModel::Aris3000, 64u, false},
                                                     {ArisModel::Aris1800, 96u, false},
                                                     {ArisModel::Aris1800, 48u, false},
                                                     {ArisModel::Aris1800, 96u, true},
                                                     {ArisModel::Aris1200, 48u, true}}) {
        const auto bearings = arisBearings(model, beams, is_telephoto);
        ASSERT_EQ(bearings.size(), beams);
        const double mean = (bearings.back() - bearings.front()) / (beams - 1);
        for (size_t i = 1; i < beams; ++i) {
            EXPECT_NEAR(bearings[i] - bearings[i - 1], mean, 0.3 * mean) << beams << " beams, beam " << i;
            EXPECT_NEAR(bearings[i], -bearings[beams - 1 - i], 0.15 * mean + 0.13) << "both sides are alike";
        }
    }
    EXPECT_THAT(arisBearings(ArisModel::Aris3000, 128, true), IsEmpty()) << "no table is published";
    EXPECT_THAT(arisBearings(ArisModel::Aris1200, 96, false), IsEmpty());
}

TEST_F(ArisFileTest, SamplesAreAtTheirBeamAndRange) {
    std::mt19937 random(20);
    for (int round = 0; round < 60; ++round) {
        const uint32_t modes[] = {1, 3, 6, 9};
        ArisFrame frame{.ping_mode = modes[random() % 4]};
        frame.model = frame.ping_mode >= 6 ? 1 : 0;
        frame.period_us = 4 + random() % 97;
        frame.delay_us = 930 + random() % 3000;
        frame.sound_speed = 1400 + static_cast<float>(random() % 200);
        const uint32_t rows = 1 + random() % 50, beams = frame.beams();
        frame.samples = randomSamples(size_t{rows} * beams, random);
        const RecordedPing read = this->read(arisFile({frame})).at(0);
        const types::Sonar& ping = read.ping;
        ASSERT_NO_THROW(ping.validate());
        const uint32_t first = ping.bin_count - rows;
        for (uint32_t beam = 0; beam < beams; ++beam)
            for (uint32_t bin = 0; bin < ping.bin_count; ++bin)
                ASSERT_EQ(ping.bins[beam * ping.bin_count + bin],
                          bin < first ? 0 : static_cast<uint8_t>(frame.samples[(bin - first) * beams + beam]));
        const double to_range = 1e-6 * static_cast<double>(frame.sound_speed) / 2, bin = frame.period_us * to_range;
        EXPECT_NEAR(ping.binStart(1), bin, 1e-6 * bin);
        EXPECT_NEAR(read.window_start, frame.delay_us * to_range, 0.5001 * bin);
        EXPECT_NEAR(ping.binStart(ping.bin_count), read.window_start + rows * bin, 1e-5 * (first + rows) * bin);
    }
}

TEST_F(ArisFileTest, APoseHasTheCompassAndThePosition) {
    ArisFrame a = smallFrame(), b = smallFrame(100);
    for (ArisFrame* frame : {&a, &b}) {
        frame->latitude = 48;
        frame->longitude = -68;
        frame->depth = 3;
        frame->altitude = 2.5;
        frame->heading = 90;
        frame->pitch = -10;
    }
    b.latitude += 1e-3;
    const auto frames = read(arisFile({a, b}));
    const types::Pose& pose = frames.at(1).sonar;
    EXPECT_NEAR(pose.position.x, 111.2, 0.02) << "a thousandth of a degree to the north";
    EXPECT_NEAR(pose.position.z, -3, 1e-9);
    const glm::dvec3 ahead = pose.orientation * glm::dvec3(1, 0, 0);
    EXPECT_NEAR(ahead.y, -std::cos(types::radians(10)), 1e-6) << "to the east";
    EXPECT_NEAR(ahead.z, -std::sin(types::radians(10)), 1e-6) << "down";
    EXPECT_EQ(frames[1].altitude, 2.5);
    EXPECT_TRUE(isNoticed("latitude 48.0000000, longitude -68.0000000"));
}

TEST_F(ArisFileTest, WithoutPositionStaysAtTheOriginAndWithoutAnglesHasNoPose) {
    ArisFrame turned = smallFrame();
    turned.heading = 30;
    const auto frames = read(arisFile({turned, smallFrame(1)}));
    EXPECT_EQ(frames.at(0).sonar.position, glm::dvec3(0));
    EXPECT_FALSE(isUsable(frames.at(1).sonar));
    EXPECT_TRUE(isNoticed("1 pings have no pose"));
    turned.pitch = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(isUsable(read(arisFile({turned})).at(0).sonar)) << "an invalid angle";
}

TEST_F(ArisFileTest, TakesTheTimeOfThePcOrElseOfTheSonar) {
    RecordedBytes bytes = arisFile({smallFrame()});
    EXPECT_EQ(read(bytes).at(0).ping.time.microseconds, 1'700'000'000'000'000);
    putAt(bytes, first_frame + 4, uint64_t{0});
    putAt(bytes, first_frame + 20, uint64_t{1'600'000'000'000'007});
    EXPECT_EQ(read(bytes).at(0).ping.time.microseconds, 1'600'000'000'000'007);
}

TEST_F(ArisFileTest, RefusesAWrongFileWithItsByte) {
    const auto with = [&](size_t at, auto value) {
        RecordedBytes bytes = arisFile({smallFrame()});
        putAt(bytes, at, value);
        return refusal(bytes);
    };
    const auto of_frame = [&](size_t at, auto value) { return with(first_frame + at, value); };
    EXPECT_THAT(with(0, uint32_t{0x04464444}),
                HasSubstr("fish.aris: byte 0: is version 4 of the format; only version 5"));
    EXPECT_THAT(of_frame(12, uint32_t{7}), HasSubstr("byte 1036: is 0x00000007; the header of a frame has 0x05464444"));
    EXPECT_THAT(of_frame(436, uint32_t{13}), HasSubstr("byte 1460: the ping mode is 13; it may be 1 to 12"));
    EXPECT_THAT(of_frame(468, uint32_t{0}), HasSubstr("byte 1492: a beam has 0 samples; it must have 1 to 65536"));
    EXPECT_THAT(of_frame(468, ~0u), HasSubstr("byte 1492: a beam has 4294967295 samples"));
    EXPECT_THAT(of_frame(516, uint32_t{0}), HasSubstr("byte 1540: the samples are not in the order of beams"));
    EXPECT_THAT(of_frame(484, uint32_t{3}), HasSubstr("byte 1508: the model is 3"));
    EXPECT_THAT(of_frame(484, uint32_t{1}), HasSubstr("no bearings are published for 48 beams of model 1"));
    EXPECT_THAT(of_frame(452, uint32_t{0}), HasSubstr("byte 1476: the sample period is 0 us; it must be 1 to 1000"));
    EXPECT_THAT(of_frame(476, ~0u), HasSubstr("byte 1500: the samples begin after 4294967295 us"));
    EXPECT_THAT(of_frame(476, uint32_t{900'000}), HasSubstr("the samples begin after 90000 bins and are 2"));
    EXPECT_THAT(of_frame(464, std::nanf("")), HasSubstr("byte 1488: the speed of sound is nan m/s"));
    EXPECT_THAT(of_frame(4, ~uint64_t{0}), HasSubstr("byte 1028: the time is 1.84467e+13 s since 1970"));
    EXPECT_THAT(refusal(RecordedBytes{'D', 'D', 'F', '\5'}), HasSubstr("byte 4: ends here"));
}

TEST_F(ArisFileTest, KeepsThePingsBeforeDamageWithANotice) {
    const auto damaged = [&](size_t at, auto value) {
        RecordedBytes bytes = arisFile({smallFrame(), smallFrame(5), smallFrame(9)});
        putAt(bytes, second_frame + at, value);
        return read(bytes);
    };
    EXPECT_THAT(damaged(12, uint32_t{0}), SizeIs(1));
    EXPECT_TRUE(
        isNoticed("byte 2156: is 0x00000000; the header of a frame has 0x05464444 here; only the 1 earlier "
                  "pings are read"));
    EXPECT_THAT(damaged(4, uint64_t{1'699'999'999'000'000}), SizeIs(1));
    EXPECT_TRUE(isNoticed("byte 2148: the time is 1 s before that of the previous ping"));
}

TEST_F(ArisFileTest, KeepsWholeFramesOfATruncatedFile) {
    const RecordedBytes good = arisFile({smallFrame(), smallFrame(5)});
    const auto path = write(good);
    for (size_t size = good.size(); size >= first_frame; size -= 7) {
        std::filesystem::resize_file(path, size);
        EXPECT_THAT(readFile(path), SizeIs(size == good.size() ? 2 : size >= second_frame ? 1 : 0)) << size;
        EXPECT_EQ(isNoticed("is cut off by the end of the file"),
                  size != good.size() && size != second_frame && size != first_frame)
            << size;
    }
}

TEST_F(ArisFileTest, EveryDamagedByteGivesPingsOrOneError) {
    EXPECT_GT(countRefused(arisFile({smallFrame(), smallFrame(5)}), 3), 20u);
}

}  // namespace
}  // namespace insonify::recordings
