// A wall is where it is in every output, whatever the bins.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "components/device/DeviceBins.hpp"
#include "components/log/Stream.hpp"
#include "components/log/Writer.hpp"
#include "components/log/pocolog/Wire.hpp"
#include "components/output/pictures/FanShape.hpp"
#include "components/recordings/RecordingReader.hpp"
#include "components/recordings/Xtf.hpp"
#include "components/ros/Pings.hpp"
#include "components/sonar/bins/Detection.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Scenes.hpp"
#include "types/samples/SonarReturns.hpp"

namespace insonify {
namespace {

/** A random fan, and the distance of a wall ahead. */
struct Case {
    sonar::SonarConfig config;
    double wall;
};

Case randomCase(std::mt19937& random) {
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    Case made;
    sonar::SonarConfig& config = made.config;
    config.range = std::pow(10, between(-0.5, 2));
    const double width = std::max(1.5e-4, config.range / std::pow(10, between(1.7, 4)));  // 0.1 us and longer
    config.bin_count = static_cast<int>(config.range / width);
    config.range_min = 0.01 * config.range;
    config.speed_of_sound = between(1400, 1600);
    config.range_rounding = random() % 2 ? sonar::RangeRounding::Exact : sonar::RangeRounding::Sample;
    config.beam_count = 1 + 2 * static_cast<int>(random() % 3);
    config.field_of_view_deg = 2.0 * config.beam_count;
    if (random() % 3 == 0) {  // at irregular angles, which are multiples of one for a LaserScan
        const auto step = [&](int most) {
            return 3.0 * static_cast<double>(1 + random() % static_cast<unsigned>(most));
        };
        config.field_of_view_deg.reset();
        config.beam_width_deg = 2;
        config.bearings_deg = {-step(3) - 3, -3, 0, step(5), 18 + step(4)};
    }
    config.beam_height_deg = 2;
    config.quality.rows = config.quality.columns_per_beam = 64;
    config.visibility = sonar::Visibility::Cpu;
    made.wall = config.range * between(0.2, 0.95);
    return made;
}

struct Rendered {
    types::Sonar ping;
    types::SonarTruth truth;
    types::SonarReturns returns;
    uint32_t middle = 0;  ///< Beam ahead.
    uint32_t first = 0;   ///< Its first bin with an echo.
};

Rendered rendered(const Case& given) {
    const types::Snapshot scene = test::makeSnapshot(test::makeScene({test::wall(static_cast<float>(given.wall))}));
    sonar::SonarRenderer renderer(given.config, scene.geometry, {.threads = 1});
    Rendered made;
    renderer.setTruth(made.ping, &made.truth);
    renderer.render(scene, made.ping);
    sonar::Detector detector;
    detector.take(made.ping, {}, sonar::DetectionRules::of(renderer.renderPlan()));
    std::vector<uint32_t> strongest;
    for (uint32_t beam = 0; beam < made.ping.beam_count; ++beam) {
        const auto found = detector.strongest(beam);
        strongest.push_back(found ? static_cast<uint32_t>(found->bin) : made.ping.bin_count);
    }
    made.returns.take(made.ping, made.truth, strongest);
    made.middle = made.ping.beam_count / 2;
    EXPECT_NEAR(made.ping.bearings[made.middle].rad, 0, 1e-9);
    const float* const bins = &made.ping.bins[size_t{made.middle} * made.ping.bin_count];
    while (made.first < made.ping.bin_count && !(bins[made.first] > 0)) ++made.first;
    return made;
}

/** The range of the middle of a bin of a ping that was written to a log and read. */
double loggedRange(const Rendered& made, const std::filesystem::path& path) {
    {
        const auto log = log::createLog(path);
        log::Metadata metadata;
        log::addSampleMetadata(&made.ping, metadata);
        log->write(log->addStream<types::Sonar>("sonar.ping", metadata), {}, made.ping);
        log->close();
    }
    double range = 0;
    log::openLog(path)->forEach<types::Sonar>(
        "sonar.ping", [&](const types::Sonar& ping, const auto&) { range = ping.binStart(made.first + 0.5); });
    return range;
}

/** The same as a reader of Rock's type computes it from its fields. */
double rocksRange(const Rendered& made) {
    std::vector<char> bytes;
    log::pocolog::marshal(made.ping, bytes);
    types::Sonar read;
    log::pocolog::unmarshal(bytes, read);
    return (made.first + 0.5) * read.bin_duration.seconds() * static_cast<double>(read.speed_of_sound);
}

/** The same of a line of an XTF file. */
double xtfRange(const Rendered& made, const std::filesystem::path& path) {
    types::Sonar line;
    static_cast<types::RangeBins&>(line) = made.ping;
    line.time = {1'000'000};
    line.resize(made.ping.bin_count, 2);
    line.bins.assign(line.bins.size(), 1);
    line.bearings = {types::Angle::fromDeg(-30), types::Angle::fromDeg(30)};
    std::vector<char> bytes = recordings::xtfHeader({recordings::XtfSamples::Float32, 0, "x"}, line);
    recordings::appendXtfPing({recordings::XtfSamples::Float32, 0, "x"}, line, {}, bytes);
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    const auto read = recordings::RecordingReader::open(path)->next();
    return read ? read->ping.binStart(made.first + 0.5) : 0;
}

TEST(RangesTest, AWallIsWithinOneBinOfItsRangeInEveryOutput) {
    const Folder folder;
    std::mt19937 random(7);
    for (int i = 0; i < 60; ++i) {
        const Case given = randomCase(random);
        const Rendered made = rendered(given);
        const types::Sonar& ping = made.ping;
        const double bin = ping.binWidth(), wall = static_cast<double>(static_cast<float>(given.wall));
        SCOPED_TRACE(fmt::format("{} bins to {} m, {}", given.config.bin_count, given.config.range,
                                 given.config.range_rounding == sonar::RangeRounding::Exact ? "exact" : "sample"));
        ASSERT_LT(made.first, ping.bin_count);
        const auto expect = [&](double range, const char* what) { EXPECT_NEAR(range, wall, 1.01 * bin) << what; };
        expect(ping.binStart(made.first + 0.5), "ping");
        expect(made.truth.binStart(made.first + 0.5), "truth");
        expect(made.returns.first_range[made.middle], "returns");
        const double reached = ping.binStart(ping.bin_count), asked = given.config.range;
        EXPECT_GE(reached, asked * (1 - 1e-9));
        if (given.config.range_rounding == sonar::RangeRounding::Exact) {
            EXPECT_NEAR(reached, asked, 1e-9 * asked);
        }
        expect(loggedRange(made, folder / "x.0.log"), "pocolog");
        expect(loggedRange(made, folder / "x.mcap"), "MCAP");
        expect(rocksRange(made), "Rock's fields");
        expect(xtfRange(made, folder / "x.xtf"), "XTF");
        const output::FanShape shape = output::FanShape::of(ping);
        expect((made.first + 0.5) * shape.range / shape.bin_count, "scale of pictures");
        ros::ProjectedSonarImage image;
        convert(ping, {}, image);
        expect(image.ranges[made.first], "ProjectedSonarImage");
        EXPECT_NEAR(image.ping_info.sound_speed, *given.config.speed_of_sound, 1e-3);
        ros::RawSonarImage raw;
        convert(ping, {}, raw);
        expect((made.first + 0.5) * static_cast<double>(raw.ping_info.sound_speed) / 2 /
                   static_cast<double>(raw.sample_rate),
               "RawSonarImage");
        ros::SonarOptions options;
        options.threshold_db = -60;
        ros::LaserScan scan;
        convert(ping, options, scan);
        const float before = scan.angle_increment > 0 ? -scan.angle_min / scan.angle_increment : 0;
        expect(scan.ranges[static_cast<size_t>(std::lround(before))], "LaserScan");
        EXPECT_NEAR(scan.range_max, ping.binStart(ping.bin_count), 1e-6 * given.config.range);
        ros::SonarRanges ranges;
        convert(ping, options, ranges);
        expect(ranges.ranges[made.middle], "SonarRanges");
        ros::SonarDetections detections;
        convert(ping, options, detections);
        expect(static_cast<double>(detections.two_way_travel_times[made.middle]) *
                   static_cast<double>(detections.ping_info.sound_speed) / 2,
               "SonarDetections");
    }
}

TEST(RangesTest, ADriverThatAssumesTheBinWidthFindsTheWall) {
    for (const double range : {2.5, 5.0, 10.0, 20.0}) {
        Case given;
        given.config.range = range;
        given.config.bin_count = 1000;
        given.config.speed_of_sound = 1500;
        given.config.beam_count = 1;
        given.config.field_of_view_deg = given.config.beam_height_deg = 2;
        given.config.quality.rows = given.config.quality.columns_per_beam = 64;
        given.config.visibility = sonar::Visibility::Cpu;
        given.wall = 0.8 * range;
        types::Sonar ping = rendered(given).ping;
        const double assumed = range / 1000, own = ping.binWidth();
        EXPECT_EQ(device::setBinWidth(assumed, ping), own > 1.001 * assumed) << "whole microseconds: longer bins";
        const auto first = std::ranges::find_if(ping.bins, [](float bin) { return bin > 0; }) - ping.bins.begin();
        EXPECT_NEAR((static_cast<double>(first) + 0.5) * assumed, given.wall, own) << range << " m";
        EXPECT_FALSE(device::setBinWidth(assumed, ping)) << "it has that width now";
    }
}

}  // namespace
}  // namespace insonify
