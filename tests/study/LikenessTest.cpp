// Statistics of a ping's appearance, on made-up pictures with known answers, and on recordings of a device.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "components/device/OculusRecording.hpp"
#include "components/study/likeness/Likeness.hpp"
#include "tests/support/Paths.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Hash.hpp"

namespace insonify::study {
namespace {

using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;

using Histogram = std::array<double, code_classes>;

Histogram only(std::initializer_list<std::pair<size_t, double>> shares) {
    Histogram histogram{};
    for (const auto& [code, share] : shares) histogram[code] = share;
    return histogram;
}

/** Returns a picture of 64 beams x 256 bins whose codes are amplitudes. */
CodedPing makePicture(const auto& amplitude) {
    CodedPing ping{.name = "made", .beam_count = 64, .bin_count = 256, .law = {.law = receiver::CodeLaw::Sqrt}};
    for (size_t beam = 0; beam < ping.beam_count; ++beam) {
        ping.bearings.push_back(0.5 - static_cast<double>(beam) / 63);
        for (size_t bin = 0; bin < ping.bin_count; ++bin)
            ping.codes.push_back(static_cast<float>(amplitude(beam, bin)));
    }
    return ping;
}

/** Returns the amplitude of an exponential intensity of unit mean: speckle of many scatterers. */
double rayleigh(uint64_t seed, size_t a, size_t b) {
    return std::sqrt(-std::log(types::unit(types::hashed(seed, a, b) >> 32)));
}

TEST(LikenessTest, TheDistanceOfHistogramsIsThatOfMovedCodes) {
    const Histogram a = only({{10, 1}}), b = only({{30, 1}}), half = only({{10, 0.5}, {30, 0.5}});
    EXPECT_DOUBLE_EQ(earthMoversDistance(a, a), 0);
    EXPECT_DOUBLE_EQ(earthMoversDistance(a, b), 20);
    EXPECT_DOUBLE_EQ(earthMoversDistance(b, a), 20);
    EXPECT_DOUBLE_EQ(earthMoversDistance(a, half), 10);
}

TEST(LikenessTest, DivergenceIsZeroForEqualAndOneBitForDisjointHistograms) {
    const Histogram a = only({{10, 1}}), b = only({{30, 1}}), half = only({{10, 0.5}, {30, 0.5}});
    EXPECT_DOUBLE_EQ(jensenShannonDivergence(a, a), 0);
    EXPECT_DOUBLE_EQ(jensenShannonDivergence(a, b), 1);
    // 1/2 log2(1 / 0.75) + 1/2 (1/2 log2(0.5 / 0.75) + 1/2 log2(2))
    EXPECT_NEAR(jensenShannonDivergence(a, half), 0.5 * std::log2(4.0 / 3) + 0.25 * std::log2(2.0 / 3) + 0.25, 1e-12);
}

TEST(LikenessTest, LevelsFollowTheLawOfTheCodes) {
    CodedPing ping = makePicture([](size_t, size_t) { return 0.1; });
    EXPECT_NEAR(ping.levelDb(0.1f), -20, 1e-5);
    ping.law.gamma = 0.5;
    EXPECT_NEAR(ping.levelDb(0.1f), -40, 1e-5);
    ping.law = {.law = receiver::CodeLaw::Linear};
    EXPECT_NEAR(ping.levelDb(0.1f), -10, 1e-5);
    ping.law = {.law = receiver::CodeLaw::Log, .dynamic_range_db = 50};
    EXPECT_NEAR(ping.levelDb(0.1f), -45, 1e-5);
    EXPECT_NEAR(ping.levelDb(0), ping.levelDb(0.5f / 255), 1e-6);
}

TEST(LikenessTest, FractionsAndDynamicRangeAreThoseOfTheCodes) {
    const Looks looks = computeLooks(makePicture([](size_t beam, size_t) {
        return beam < 16 ? 0.0 : beam < 48 ? 0.1 : 1.0;
    }));
    EXPECT_NEAR(looks.zeros, 0.25, 1e-9);
    EXPECT_NEAR(looks.saturated, 0.25, 1e-9);
    EXPECT_NEAR(looks.histogram[26], 0.5, 1e-9) << "25.5";
    EXPECT_NEAR(looks.percentiles[3], 25.5, 1e-4);
    EXPECT_NEAR(looks.dynamic_range_db, 20 * std::log10(2 * 255.0), 1e-4) << "from half a code to the largest";
}

TEST(LikenessTest, FallOffIsTheMeanLevelOverRange) {
    const auto falling = [](size_t, size_t bin) { return std::pow(10, -static_cast<double>(bin / 8) / 20); };
    const auto flat = [](size_t, size_t) { return 0.5; };
    const Looks one = computeLooks(makePicture(falling)), other = computeLooks(makePicture(flat));
    for (size_t slice = 0; slice < range_slices; ++slice)
        EXPECT_NEAR(one.level_db[slice], -static_cast<double>(slice), 1e-4);
    EXPECT_NEAR(apart(one, other).fall_off_db, std::sqrt((32 * 32 - 1) / 12.0), 1e-4) << "the deviation of 0 to 31";
}

TEST(LikenessTest, ContrastOfManyScatterersIsThatOfRayleigh) {
    const Looks looks = computeLooks(makePicture([](size_t beam, size_t bin) { return 0.2 * rayleigh(1, beam, bin); }));
    EXPECT_GT(looks.patches, 50);
    EXPECT_NEAR(looks.contrast, 0.5227, 0.02);
    EXPECT_NEAR(looks.range_correlation, 0, 0.02);
    EXPECT_NEAR(looks.beam_correlation, 0, 0.02);
}

TEST(LikenessTest, NeighboursThatShareHalfTheirSpeckleCorrelateByAHalf) {
    const auto shared = [](size_t beam, size_t bin) {
        return 0.2 + 0.02 * (rayleigh(1, beam, bin) + rayleigh(1, beam + 1, bin));
    };
    const Looks looks = computeLooks(makePicture(shared));
    EXPECT_NEAR(looks.beam_correlation, 0.5, 0.03);
    EXPECT_NEAR(looks.range_correlation, 0, 0.03);
}

TEST(LikenessTest, AnArcNextToATargetHasItsLevel) {
    const auto arc = [](size_t beam, size_t bin) {
        const bool is_target = beam >= 31 && beam <= 33 && bin >= 99 && bin <= 101;
        return is_target ? 1.0 : bin >= 99 && bin <= 101 ? 0.1 : 0.01;
    };
    const Looks one = computeLooks(makePicture([&](size_t beam, size_t bin) {  // five targets, at separate ranges
        return bin < 250 && bin % 50 >= 20 ? arc(beam, 99 + bin % 50 - 24) : 0.01;
    }));
    EXPECT_NEAR(one.arc_db, -20, 0.1);
    EXPECT_NEAR(one.arc_excess_db, 20, 0.1);
}

TEST(LikenessTest, PicturesOfOneCodeAndOfTheCosineDifferFromASpeckledPicture) {
    const auto recorded = [](uint64_t seed) {
        return makePicture([&](size_t beam, size_t bin) {
            return std::min(1.0, 0.25 * rayleigh(seed, beam, bin) * (bin > 100 && bin < 150 ? 2 : 1));
        });
    };
    const LikenessResult result = studyLikeness({recorded(1), recorded(2)}, nullptr);
    const CodedPing another = recorded(3);
    const LikenessResult with = studyLikeness({recorded(1), recorded(2)}, &another);
    const auto failing = [](const LikenessResult& of, const std::string& name) {
        return std::ranges::count_if(claims(of.row(name)->apart, of.recorded), &Claim::fails);
    };
    EXPECT_EQ(failing(with, "simulated"), 0);
    EXPECT_GE(failing(result, "uniform"), 4);
    EXPECT_GE(failing(result, "cosine"), 4);
    EXPECT_EQ(result.row("simulated"), nullptr);
}

TEST(LikenessTest, RefusesAPictureThatIsTooSmall) {
    CodedPing ping = makePicture([](size_t, size_t) { return 0.1; });
    ping.beam_count = 16;
    EXPECT_THROW(computeLooks(ping), types::ConfigError);
    EXPECT_THROW(studyLikeness({}, nullptr), std::invalid_argument);
}

TEST(LikenessTest, DrawsFansSideBySide) {
    const CodedPing ping = makePicture([](size_t beam, size_t) { return beam < 32 ? 1.0 : 0.5; });
    const types::Image one = drawFans({ping}), two = drawFans({ping, ping});
    EXPECT_EQ(two.size.width, 2 * one.size.width + 12);
    const size_t row = size_t{300} * one.row_size;
    EXPECT_EQ(one.image[row + one.size.width / 2 - 40], 255) << "port is to the left";
    EXPECT_EQ(one.image[row + one.size.width / 2 + 40], 128);
    EXPECT_EQ(one.image[row], 0) << "outside the fan";
}

TEST(LikenessTest, RecordingsOfAnM1200dResembleEachOtherButNotWrongPictures) {
    const std::filesystem::path file = test::sharedFile("sonar/oculus/three_pings_8bit.raw");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there: nothing is held against recordings";
    device::OculusReader reader(file);
    const std::vector<CodedPing> recorded = codedPings(reader, {});
    ASSERT_EQ(recorded.size(), 3u);
    const LikenessResult result = studyLikeness({recorded[0], recorded[1]}, &recorded[2]);
    const Looks& looks = result.recorded;
    EXPECT_NEAR(looks.saturated, 0.008, 0.001);
    EXPECT_NEAR(looks.zeros, 0.0002, 0.0001);
    EXPECT_THAT(looks.contrast, AllOf(Ge(0.5), Le(0.6)));
    EXPECT_THAT(looks.beam_correlation, AllOf(Ge(0.4), Le(0.7)));
    EXPECT_LT(looks.arc_excess_db, 3) << "it has no strong target";
    EXPECT_LT(result.row("simulated")->apart.emd_codes, 1) << "one ping of it is like the others";
    for (const Claim& claim : claims(result.row("simulated")->apart, looks)) EXPECT_TRUE(claim.holds()) << claim.text;
    for (const char* wrong : {"uniform", "cosine"})
        EXPECT_GE(std::ranges::count_if(claims(result.row(wrong)->apart, looks), &Claim::fails), 5) << wrong;
}

}  // namespace
}  // namespace insonify::study
