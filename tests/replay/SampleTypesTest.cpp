// Every type of types::SampleTypes in a log of each format, converted from one to the other, exported and replayed.
#include <gmock/gmock.h>

#include "components/log/Copy.hpp"
#include "components/log/Export.hpp"
#include "components/log/Files.hpp"
#include "components/log/TypeNames.hpp"
#include "components/log/pocolog/Wire.hpp"
#include "components/replay/ReplayTask.hpp"
#include "components/ros/Samples.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::replay {
namespace {

using log::typelibName;

types::Sonar made(std::type_identity<types::Sonar>) {
    types::Sonar ping;
    ping.time = {1'500'000};
    ping.bin_duration = {400};
    ping.bearings = {{0.5}, {0.0}};
    ping.speed_of_sound = 1500;
    ping.beam_width = {0.25};
    ping.beam_height = {0.5};
    ping.beam_count = 2;
    ping.bin_count = 3;
    ping.bins = {1, 0.5f, 0.25f, 0, 3, 4};
    return ping;
}
types::SonarBeam made(std::type_identity<types::SonarBeam>) {
    types::SonarBeam beam;
    beam.time = {1'500'000};
    beam.bearing = {0.5};
    beam.sampling_interval = 1e-4;
    beam.speed_of_sound = 1500;
    beam.beamwidth_horizontal = 0.25f;
    beam.beamwidth_vertical = 0.5f;
    beam.beam = {0, 51, 255};
    return beam;
}
types::SonarScan made(std::type_identity<types::SonarScan>) {
    types::SonarScan scan;
    scan.time = {1'500'000};
    scan.number_of_beams = 1;
    scan.number_of_bins = 3;
    scan.data = {0, 51, 255};
    scan.start_bearing = {0.5};
    scan.angular_resolution = {0.25};
    scan.sampling_interval = 1e-4;
    scan.speed_of_sound = 1500;
    scan.beamwidth_horizontal = {0.25};
    scan.beamwidth_vertical = {0.5};
    return scan;
}
types::SonarTruth made(std::type_identity<types::SonarTruth>) {
    types::SonarTruth truth;
    truth.copyGrid(made(std::type_identity<types::Sonar>{}));
    truth.objects = {"bottom", "a \"ball\""};
    truth.elevation = {0.5f, -0.25f, 0, 0.125f, 0, 0};
    truth.object = {1, 0, -1, 0, 0, 1};
    truth.share = {1, 0.75f, 0, 1, 0.5f, 1};
    truth.hits = {3, 70'000, 0, 1, 1, 2};
    truth.grazing = {1.5f, 0.25f, 0, 0.5f, 0.5f, 1};
    truth.path = {0, 1, 0, 2, 3, 0};
    truth.shadow = {0, 0, 1, 0, 0, 0};
    return truth;
}
types::SonarReturns made(std::type_identity<types::SonarReturns>) {
    types::SonarReturns returns;
    returns.take(made(std::type_identity<types::Sonar>{}), made(std::type_identity<types::SonarTruth>{}), {1, 1});
    return returns;
}
types::SonarElements made(std::type_identity<types::SonarElements>) {
    types::SonarElements signals;
    signals.time = {1'500'000};
    signals.speed_of_sound = 1500;
    signals.wavelength = 0.002;
    signals.first_range = 0.25;
    signals.sample_spacing = 0.5;
    signals.sample_count = 3;
    signals.positions = {-0.001, 0.001};
    signals.weights = {0.5, 0.5};
    signals.in_phase = {1, -2, 0.5f, 0, 4, 8};
    signals.quadrature = {0, 0.25f, -1, 2, 0.125f, -8};
    return signals;
}
types::SonarDetections made(std::type_identity<types::SonarDetections>) {
    types::SonarDetections detections;
    detections.copyPing(made(std::type_identity<types::Sonar>{}));
    detections.add({0.5}, {-0.25}, 12.5, 2);
    detections.add({-0.125}, {0.5}, types::SonarDetections::no_return, 0);
    return detections;
}
types::SonarSettings made(std::type_identity<types::SonarSettings>) {
    types::SonarSettings settings;
    settings.time = {1'500'000};
    settings.range = 12.5;
    settings.frequency_khz = 750;
    settings.speed_of_sound = 1490.5;
    settings.gain_db = -3;
    settings.bearing = {0.25};
    settings.field_of_view = {1.5};
    settings.beam_height = {0.125};
    settings.bin_count = 500;
    settings.beam_count = 256;
    return settings;
}
types::Pose made(std::type_identity<types::Pose>) {
    types::Pose pose;
    pose.time = {1'500'000};
    pose.source_frame = "body";
    pose.target_frame = "world";
    pose.position = {1, -2, 3};
    pose.orientation = {0.5, -0.5, 0.5, 0.5};
    return pose;
}
types::Image made(std::type_identity<types::Image>) {
    types::Image picture;
    picture.time = picture.received_time = {1'500'000};
    picture.size = {2, 1};
    picture.pixel_size = 3;
    picture.row_size = 6;
    picture.frame_mode = types::ImageMode::Bgr;
    picture.frame_status = types::ImageStatus::Valid;
    picture.image = {1, 2, 3, 4, 5, 6};
    return picture;
}
types::PointCloud made(std::type_identity<types::PointCloud>) {
    types::PointCloud cloud;
    cloud.time = {1'500'000};
    cloud.add({1, -2.5, 3}, 0.25);
    cloud.add({-4, 0.5, -8}, 0.5);
    return cloud;
}
types::DepthMap made(std::type_identity<types::DepthMap>) {
    types::DepthMap map;
    map.time = {1'500'000};
    map.vertical_size = 2;
    map.horizontal_size = 3;
    map.vertical_interval = {-0.25, 0.5};
    map.horizontal_interval = {0.5, 0.125, -0.25};
    map.distances = {1, 2, 4, types::DepthMap::too_far, 8, 0.5f};
    map.remissions = {1, 0.5f, 0.25f, 0, 2, 0.125f};
    return map;
}
types::Range made(std::type_identity<types::Range>) {
    types::Range range;
    range.time = {1'500'000};
    range.range = 12.5;
    range.range_min = 0.25;
    range.range_max = 50;
    range.field_of_view = {0.5};
    return range;
}
types::ImuSensors made(std::type_identity<types::ImuSensors>) {
    types::ImuSensors sensors;
    sensors.time = {1'500'000};
    sensors.acc = {0.25, -0.5, 9.75};
    sensors.gyro = {0.125, 0.5, -1};
    return sensors;
}
types::Imu made(std::type_identity<types::Imu>) {
    types::Imu imu;
    imu.time = {1'500'000};
    imu.orientation = {0.5, -0.5, 0.5, 0.5};
    imu.cov_orientation = glm::dmat3(0.25);
    imu.angular_velocity = {0.125, 0.5, -1};
    imu.cov_angular_velocity = {{1, 0.5, 0}, {0.5, 2, 0}, {0, 0, 3}};
    imu.linear_acceleration = {0.25, -0.5, 9.75};
    return imu;
}
types::Dvl made(std::type_identity<types::Dvl>) {
    types::Dvl dvl;
    dvl.time = {1'500'000};
    dvl.velocity = {0.5, -0.25, 0.125};
    dvl.cov_velocity = {{1, 0.5, 0.25}, {0.5, 2, 0}, {0.25, 0, 3}};
    dvl.altitude = 12.5;
    dvl.speed_of_sound = 1490.5;
    dvl.beam_directions = {{0.5, 0.25, -1}, {-0.5, 0.25, -1}, {-0.5, -0.25, -1}, {0.5, -0.25, -1}};
    dvl.beam_ranges = {15, types::Pose::unknown, 14, 15.5};
    dvl.beam_velocities = {0.25, types::Pose::unknown, -0.25, 0.5};
    dvl.beam_velocity_variances = {0.25, types::Pose::unknown, 0.125, 0.5};
    return dvl;
}
types::Pressure made(std::type_identity<types::Pressure>) {
    types::Pressure pressure;
    pressure.time = {1'500'000};
    pressure.pascal = 201'325.5f;
    return pressure;
}
types::Fix made(std::type_identity<types::Fix>) {
    types::Fix fix;
    fix.time = {1'500'000};
    fix.kind = types::FixKind::Differential;
    fix.latitude = 54.123456789;
    fix.longitude = -10.987654321;
    fix.altitude = 41.5;
    fix.deviation_latitude = 0.3;
    fix.deviation_longitude = 0.7;
    fix.deviation_altitude = 1.1;
    return fix;
}
types::Time made(std::type_identity<types::Time>) { return {1'234'567}; }
types::Angle made(std::type_identity<types::Angle>) { return {0.75}; }
std::string made(std::type_identity<std::string>) { return "a \"word\"\n"; }
template <class T>
requires std::is_arithmetic_v<T> T made(std::type_identity<T>) { return static_cast<T>(-3); }

std::vector<char> marshalled(const auto& sample) {
    std::vector<char> bytes;
    log::pocolog::marshal(sample, bytes);
    return bytes;
}

constexpr const char* stream = "task.port";

/** This frame keeps every bit of an orientation. */
log::McapConfig asItIs() {
    log::McapConfig config;
    config.world_frame = ros::WorldFrame::AsIs;
    return config;
}

/** Returns the only sample of a log, which must be valid. */
template <class T>
T readOnly(const std::filesystem::path& path) {
    const log::Verdict verdict = log::check(path);
    EXPECT_FALSE(verdict.diagnostic) << verdict.diagnostic->message;
    const auto log = log::openLog(path);
    T sample{};
    log->read(log->samples().at(0), sample);
    EXPECT_EQ(log->samples()[0].received.microseconds, 2'000'000);
    return sample;
}

/** Returns the samples of a task that replays the log. */
template <class T>
T replayed(const Folder& folder, const std::string& file) {
    ReplayTask task("replay");
    ReplayConfig config;
    config.file = file;
    task.config.set(config);
    task.environment().input_folder = folder.path();
    task.environment().lockstep = true;
    task.environment().now = [] { return types::Time{3'000'000}; };
    test::Reader<types::Carried<T>> reader;
    EXPECT_TRUE(task.makeOutput(stream)->connectTo(reader.port, framework::ConnPolicy::buffer(2)));
    EXPECT_TRUE(task.configure() && task.start());
    task.update();
    types::Carried<T> sample{};
    EXPECT_TRUE(reader.port.readNew(sample));
    return *types::carriedSample(sample);
}

template <class T>
struct SampleTypesTest : testing::Test {
    /** Returns the sample as MCAP files and replays return it: Rock's older sonar samples become pings. */
    using Read = typename ros::MessagesOf<T>::read_as;
    static Read asRead(const T& sample) {
        if constexpr (std::is_same_v<T, Read>)
            return sample;
        else
            return toSonar(sample);
    }
    void write(const std::string& file) const {
        const auto log = log::createLog(folder / file, asItIs());
        log->write(log->template addStream<T>(stream), {2'000'000}, sample);
        log->close();
    }
    const Folder folder;
    const T sample = made(std::type_identity<T>{});
};

template <class Types>
struct Listed;
template <class... T>
struct Listed<std::tuple<T...>> {
    using type = testing::Types<T...>;
};
struct Names {
    template <class T>
    static std::string GetName(int) {
        const std::string name = typelibName<T>();
        return name.substr(name.rfind('/') + 1);
    }
};
TYPED_TEST_SUITE(SampleTypesTest, Listed<types::SampleTypes>::type, Names);

TYPED_TEST(SampleTypesTest, RoundTripsThroughPocologAndReplaysUnchanged) {
    this->write("x.0.log");
    EXPECT_EQ(marshalled(readOnly<TypeParam>(this->folder / "x.0.log")), marshalled(this->sample));
    EXPECT_EQ(marshalled(replayed<typename TestFixture::Read>(this->folder, "x.0.log")),
              marshalled(this->asRead(this->sample)));
}

TYPED_TEST(SampleTypesTest, RoundTripsThroughMcapAndReplaysUnchanged) {
    this->write("x.0.mcap");
    const auto expected = marshalled(this->asRead(this->sample));
    EXPECT_EQ(marshalled(readOnly<typename TestFixture::Read>(this->folder / "x.0.mcap")), expected);
    EXPECT_EQ(marshalled(replayed<typename TestFixture::Read>(this->folder, "x.0.mcap")), expected);
}

TYPED_TEST(SampleTypesTest, IsCopiedFromEachFormatToTheOther) {
    this->write("x.0.log");
    const auto expected = marshalled(this->asRead(this->sample));
    EXPECT_EQ(log::copyLog({this->folder / "x.0.log"}, this->folder / "y.0.mcap", {.anew = asItIs()}).samples, 1u);
    EXPECT_EQ(marshalled(readOnly<typename TestFixture::Read>(this->folder / "y.0.mcap")), expected);
    EXPECT_EQ(log::copyLog({this->folder / "y.0.mcap"}, this->folder / "z.0.log").samples, 1u);
    EXPECT_EQ(marshalled(readOnly<typename TestFixture::Read>(this->folder / "z.0.log")), expected);
}

TYPED_TEST(SampleTypesTest, IsExportedTheSameFromEachFormat) {
    for (const char* file : {"x.0.log", "x.0.mcap"}) this->write(file);
    const auto exported = [&](const char* file, const std::string& to) {
        const auto log = log::openLog(this->folder / file);
        EXPECT_EQ(log::exportNpz(*log, stream, this->folder / (to + ".npz")).size(), 1u);
        if (!std::is_same_v<TypeParam, types::Image>) log::exportCsv(*log, stream, this->folder / (to + ".csv"));
    };
    exported("x.0.log", "a");
    exported("x.0.mcap", "b");
    EXPECT_EQ(toBytes(this->folder / "a.npz"), toBytes(this->folder / "b.npz"));
    if (std::is_same_v<TypeParam, types::Image>) return;
    EXPECT_EQ(toBytes(this->folder / "a.csv"), toBytes(this->folder / "b.csv"));
}

}  // namespace
}  // namespace insonify::replay
