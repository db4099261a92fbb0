// Pictures of pings as recordings for `insonify fit`.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "components/output/PictureFiles.hpp"
#include "components/output/pictures/PlainPicture.hpp"
#include "components/study/PictureFile.hpp"
#include "tests/support/Fans.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::study {
namespace {

using testing::HasSubstr;

constexpr uint32_t beams = 96, bins = 300;
constexpr double fov_deg = 40;

struct PictureFileTest : ::testing::Test {
    /** A ping of codes that rise to port and with range; none nearer than a quarter of the range. */
    PictureFileTest() : ping_(test::emptyPing(fov_deg, beams, bins)) {
        ping_.bin_width = 0.01;
        for (uint32_t beam = 0; beam < beams; ++beam)
            for (uint32_t bin = bins / 4; bin < bins; ++bin) ping_.bins[beam * bins + bin] = expectedCode(beam, bin);
    }
    static float expectedCode(uint32_t beam, uint32_t bin) {
        return std::round(40 + 100.0f * static_cast<float>(beam) / beams + 100.0f * static_cast<float>(bin) / bins);
    }
    std::filesystem::path draw(output::PlainShape shape, uint32_t height) const {
        output::PlainConfig config;
        config.shape = shape, config.height = height, config.scale = output::BinScale::Code, config.code_bits = 8;
        output::PlainPicture picture(config);
        picture.take(ping_);
        output::writePng(folder_ / "ping.png", picture.image());
        return folder_ / "ping.png";
    }
    const Folder folder_;
    types::Sonar ping_;
};

TEST_F(PictureFileTest, APolarPictureHasTheCodesOfThePing) {
    const auto file = draw(output::PlainShape::Polar, bins);
    const CodedPing read = readPicture(file, {.is_fan = false, .range = 3, .field_of_view_deg = fov_deg}, {});
    ASSERT_EQ(read.beam_count, beams);
    ASSERT_EQ(read.bin_count, bins);
    EXPECT_NEAR(read.resolution, 0.01, 1e-9);
    for (uint32_t beam = 0; beam < beams; ++beam) {
        EXPECT_NEAR(read.bearings[beam], ping_.bearings[beam].rad, 1e-9);
        for (uint32_t bin = 0; bin < bins; ++bin)
            ASSERT_NEAR(255 * read.code(beam, bin), ping_.bins[beam * bins + bin], 1) << beam << " " << bin;
    }
    const CodedPing far =
        readPicture(file, {.is_fan = false, .range = 4, .range_min = 1, .field_of_view_deg = fov_deg}, {});
    EXPECT_EQ(far.bin_count, bins + bins / 3);
    EXPECT_EQ(far.code(5, 3), 0);
    EXPECT_EQ(far.code(5, bins), read.code(5, bins - bins / 3));
}

TEST_F(PictureFileTest, AFanIsFoundByItsOutline) {
    const CodedPing read = readPicture(draw(output::PlainShape::Fan, bins), {.range = 3, .beams = beams}, {});
    ASSERT_EQ(read.beam_count, beams);
    EXPECT_NEAR(static_cast<double>(read.bin_count), bins, 3);
    EXPECT_NEAR(read.bearings.back(), ping_.bearings.back().rad, 0.01);
    EXPECT_NEAR(read.bearings.front(), ping_.bearings.front().rad, 0.01);
    for (uint32_t beam = 4; beam + 4 < beams; ++beam)
        for (uint32_t bin = bins / 4 + 4; bin + 6 < bins; ++bin)
            ASSERT_NEAR(255 * read.code(beam, bin), expectedCode(beam, bin), 5) << beam << " " << bin;
    EXPECT_EQ(read.code(48, bins / 4 - 5), 0);
}

TEST_F(PictureFileTest, TheOutlineHasTheSidesAndEdgesOfAFan) {
    output::PlainConfig config;
    config.height = 400, config.scale = output::BinScale::Code;
    for (const double degrees : {20.0, 60.0, 100.0, 130.0}) {
        ping_.bearings = test::emptyPing(degrees, beams, bins).bearings;
        output::PlainPicture picture(config);
        picture.take(ping_);
        const auto fan = findOutline(picture.image().image, picture.width(), picture.height());
        ASSERT_TRUE(fan) << degrees;
        EXPECT_NEAR(2 * types::degrees(fan->half_angle), degrees, 0.04 * degrees);
        EXPECT_NEAR(fan->nearest / fan->radius, 0.25, 0.03) << degrees;
    }
}

TEST_F(PictureFileTest, WhatIsNotKnownIsNamed) {
    const auto fan = draw(output::PlainShape::Fan, bins);
    const auto why = [&](const std::filesystem::path& file, const PictureConfig& config) {
        return test::computeError<types::ConfigError>([&] { readPicture(file, config, {}); });
    };
    EXPECT_THAT(why(fan, {}), HasSubstr("is a picture; give --range"));
    EXPECT_THAT(why(fan, {.range = 2, .range_min = 2}), HasSubstr("--range-min is 2 m; must be below --range, 2 m"));
    EXPECT_THAT(why(fan, {.is_fan = false, .range = 2}), HasSubstr("give --field-of-view-deg"));
    std::ofstream(folder_ / "cut.png", std::ios::binary) << "\x89PNG\r\n";
    EXPECT_TRUE(isPicture(folder_ / "cut.png"));
    EXPECT_THAT(why(folder_ / "cut.png", {.range = 2}), HasSubstr("cut.png: --real: "));
}

}  // namespace
}  // namespace insonify::study
