#include <gmock/gmock.h>

#include "components/log/Export.hpp"
#include "components/log/NpzFile.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Python.hpp"

namespace insonify::log {
namespace {

types::Sonar ping(int64_t time, uint32_t beams, uint32_t bins) {
    types::Sonar sample;
    sample.time = {time};
    sample.bin_duration = {67};
    sample.speed_of_sound = 1480;
    sample.beam_count = beams;
    sample.bin_count = bins;
    for (uint32_t beam = 0; beam < beams; ++beam) sample.bearings.push_back({0.5 - beam});
    for (uint32_t i = 0; i < beams * bins; ++i) sample.bins.push_back(static_cast<float>(i) + 0.25f);
    return sample;
}

types::Pose pose() {
    types::Pose sample;
    sample.time = {1'500'000};
    sample.position = {1, 2, -3.5};
    sample.orientation = {0.5, 0.5, -0.5, 0.5};
    return sample;
}

/** A log of one stream, whose samples were received one after the other, open for reading. */
struct Logged {
    template <class T>
    Logged(const std::string& stream, std::initializer_list<T> samples) : reader(written(stream, samples)) {}

    const Folder folder;
    pocolog::Reader reader;

private:
    template <class T>
    std::filesystem::path written(const std::string& name, std::initializer_list<T> samples) const {
        pocolog::Writer log(folder / "x.0.log");
        const size_t stream = log.addStream<T>(name);
        int64_t received = 0;
        for (const T& sample : samples) log.write(stream, {++received}, sample);
        log.close();
        return folder / "x.0.log";
    }
};

std::string toText(const std::filesystem::path& path) {
    const std::vector<char> bytes = toBytes(path);
    return {bytes.begin(), bytes.end()};
}

/** Returns the output of python, with numpy as `np` and the file as `x`. */
std::string numpySays(const std::filesystem::path& file, const std::string& expression) {
    return pythonSays("-c \"import numpy as np; x = np.load('" + file.string() + "'); print(" + expression + ")\"",
                      file.parent_path() / "answer.txt");
}

bool numpyIsThere() { return std::system((python() + " -c 'import numpy' 2> /dev/null").c_str()) == 0; }

TEST(ExportTest, NumpyReadsPings) {
    if (!numpyIsThere()) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    auto [folder, reader] = Logged("sonar.ping", {ping(1'000'000, 2, 3), ping(1'500'000, 2, 3)});
    EXPECT_THAT(exportNpz(reader, "sonar.ping", folder / "x.npz"), testing::ElementsAre(folder / "x.npz"));
    EXPECT_EQ(numpySays(folder / "x.npz", "sorted(x.files)"),
              "['bearings', 'bin_duration', 'bins', 'range_m', 'speed_of_sound', 'time']\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "x['bins'].shape, x['bins'].dtype, x['bins'][1, 1, 2]"),
              "(2, 2, 3) float32 5.25\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "x['bearings'].tolist(), x['time'].tolist(), x['time'].dtype"),
              "[[0.5, -0.5], [0.5, -0.5]] [1.0, 1.5] float64\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "x['bin_duration'][0] * 1e6, x['speed_of_sound'][1]"), "67.0 1480.0\n");
}

TEST(ExportTest, NumpyReadsPosesAndNumbers) {
    if (!numpyIsThere()) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    Folder folder;
    pocolog::Writer log(folder / "x.0.log");
    log.write(log.addStream<types::Pose>("vehicle.pose"), {1}, pose());
    log.write(log.addStream<int32_t>("t.state"), {2'000'000}, 5);
    log.addStream<bool>("t.never");
    log.close();
    pocolog::Reader reader(folder / "x.0.log");
    exportNpz(reader, "vehicle.pose", folder / "pose.npz");
    exportNpz(reader, "t.state", folder / "state.npz");
    exportNpz(reader, "t.never", folder / "never.npz");
    EXPECT_EQ(numpySays(folder / "pose.npz", "x['time'], x['position'], x['orientation']"),
              "[1.5] [[ 1.   2.  -3.5]] [[ 0.5  0.5 -0.5  0.5]]\n");
    EXPECT_EQ(numpySays(folder / "state.npz", "x['time'], x['value'], x['value'].dtype"), "[2.] [5] int32\n");
    EXPECT_EQ(numpySays(folder / "never.npz", "x['value'].shape"), "(0,)\n");
}

/** One beam of two bins: a ball at 0.5 rad, and an empty bin in its shadow. */
types::SonarTruth truth(int64_t time) {
    types::SonarTruth sample;
    sample.copyGrid(ping(time, 1, 2));
    sample.objects = {"bottom", "ball"};
    sample.elevation = {0.5f, std::numeric_limits<float>::quiet_NaN()};
    sample.object = {1, -1};
    sample.share = {0.75f, 0};
    sample.hits = {7, 0};
    sample.grazing = {1.25f, std::numeric_limits<float>::quiet_NaN()};
    sample.path = {3, 0};
    sample.shadow = {0, 1};
    return sample;
}

TEST(ExportTest, NumpyReadsTheTruthOfPings) {
    auto [folder, reader] = Logged("sonar.truth", {truth(1'000'000), truth(1'500'000)});
    exportNpz(reader, "sonar.truth", folder / "x.npz");
    if (!numpyIsThere()) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    EXPECT_EQ(numpySays(folder / "x.npz", "sorted(x.files)"),
              "['bearings', 'elevation', 'grazing', 'hits', 'object', 'objects', 'path', 'range_m', 'shadow', 'share', "
              "'time']\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "x['object'].shape, x['object'].dtype, x['object'][1].tolist()"),
              "(2, 1, 2) int32 [[1, -1]]\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "x['elevation'].dtype, x['elevation'][0, 0], x['grazing'][1, 0]"),
              "float32 [0.5 nan] [1.25  nan]\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "x['shadow'].dtype, x['shadow'][0, 0], x['path'][0, 0], x['hits'][0, 0]"),
              "bool [False  True] [3 0] [7 0]\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "x['objects'], x['share'][1, 0], x['time'], x['range_m'].shape"),
              "['bottom' 'ball'] [0.75 0.  ] [1.  1.5] (2, 2)\n");
}

TEST(ExportTest, TextsAreNumpysUnicodeStrings) {
    if (!numpyIsThere()) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    const Folder folder;
    NpzFile npz(folder / "x.npz");
    npz.text("meta", "{\"unit\": \"\xc2\xb5Pa\"}");
    npz.texts("names", {"boje \xc3\xa4", "\xe9\xad\x9a\xf0\x9d\x84\x9e", "a\xff\xc0\xaf\xed\xa0\x80", ""});
    npz.texts("none", {});
    npz.close();
    EXPECT_EQ(numpySays(folder / "x.npz", "[ord(c) for c in __import__('json').loads(str(x['meta']))['unit']]"),
              "[181, 80, 97]\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "[[ord(c) for c in name] for name in x['names'][:2]]"),
              "[[98, 111, 106, 101, 32, 228], [39770, 119070]]\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "x['names'][2] == 'a' + 6 * chr(0xfffd), x['names'][3] == ''"), "True True\n")
        << "no lead byte, an overlong sequence and half a surrogate pair";
    EXPECT_EQ(numpySays(folder / "x.npz", "x['none'].shape"), "(0,)\n");
}

types::SonarElements elements(int64_t time) {
    types::SonarElements signals;
    signals.time = {time};
    signals.speed_of_sound = 1500;
    signals.wavelength = 0.002;
    signals.first_range = 0.25;
    signals.sample_spacing = 0.5;
    signals.sample_count = 2;
    signals.positions = {-0.5, 0.5};
    signals.weights = {0.5, 0.5};
    signals.in_phase = {1, -2, 3, 4};
    signals.quadrature = {0, 0.5f, 0, 8};
    return signals;
}

TEST(ExportTest, SignalsOfElementsAreArraysAndLines) {
    auto [folder, reader] = Logged("sonar.elements", {elements(1'000'000), elements(1'500'000)});
    exportCsv(reader, "sonar.elements", folder / "x.csv");
    EXPECT_THAT(toText(folder / "x.csv"),
                testing::StartsWith("time,element,position,sample,in_phase,quadrature\n1.000000,0,-0.5,0,1,0\n"
                                    "1.000000,0,-0.5,1,-2,0.5\n1.000000,1,0.5,0,3,0\n"));
    exportNpz(reader, "sonar.elements", folder / "x.npz");
    if (!numpyIsThere()) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    EXPECT_EQ(numpySays(folder / "x.npz", "sorted(x.files)"),
              "['in_phase', 'positions', 'quadrature', 'range_m', 'speed_of_sound', 'time', 'wavelength', "
              "'weights']\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "(x['in_phase'] + 1j * x['quadrature'])[1, 1]"), "[3.+0.j 4.+8.j]\n");
    EXPECT_EQ(numpySays(folder / "x.npz", "x['range_m'][0], x['positions'][1], x['wavelength']"),
              "[0.25 0.75] [-0.5  0.5] [0.002 0.002]\n");
}

TEST(ExportTest, CsvHasALineForEachBinOfTruthAndEachBeamOfReturns) {
    Folder folder;
    pocolog::Writer log(folder / "x.0.log");
    log.write(log.addStream<types::SonarTruth>("sonar.truth"), {1}, truth(1'500'000));
    types::SonarTruth direct = truth(1'500'000);
    direct.path[0] = 0;
    types::SonarReturns returns;
    returns.take(ping(1'500'000, 1, 2), direct, {0});
    log.write(log.addStream<types::SonarReturns>("sonar.returns"), {1}, returns);
    log.close();
    pocolog::Reader reader(folder / "x.0.log");
    exportCsv(reader, "sonar.truth", folder / "truth.csv");
    EXPECT_EQ(toText(folder / "truth.csv"),
              "time,beam,bearing,bin,elevation,object,share,hits,grazing,path,shadow\n"
              "1.500000,0,0.5,0,0.5,1,0.75,7,1.25,3,0\n"
              "1.500000,0,0.5,1,nan,-1,0,0,nan,0,1\n");
    exportCsv(reader, "sonar.returns", folder / "returns.csv");
    EXPECT_THAT(toText(folder / "returns.csv"),
                testing::StartsWith("time,beam,bearing,first_range,first_level,first_elevation,strongest_range,"
                                    "strongest_level,strongest_elevation\n1.500000,0,0.5,0.04958"));
}

TEST(ExportTest, DetectionsAreArraysByBeamWithTheSpeedOfSound) {
    types::SonarDetections found;
    found.copyPing(ping(1'500'000, 2, 3));
    found.speed_of_sound = 1480;
    found.add({0.5}, {0.25}, 7.4, 2);
    found.add({-0.5}, {0}, types::SonarDetections::no_return, 0);
    auto [folder, reader] = Logged("sonar.detections", {found, found});
    exportCsv(reader, "sonar.detections", folder / "x.csv");
    EXPECT_THAT(toText(folder / "x.csv"), testing::StartsWith("time,beam,bearing,elevation,travel_time,intensity\n"
                                                              "1.500000,0,0.5,0.25,0.01,2\n"
                                                              "1.500000,1,-0.5,0,nan,0\n"));
    exportNpz(reader, "sonar.detections", folder / "x.npz");
    if (!numpyIsThere()) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    EXPECT_EQ(numpySays(folder / "x.npz", "x['travel_time'].shape, x['speed_of_sound'], x['bearings'][1]"),
              "(2, 2) [1480. 1480.] [ 0.5 -0.5]\n");
}

TEST(ExportTest, AChangeOfShapeBeginsANewFile) {
    auto [folder, reader] = Logged("sonar.ping", {ping(1, 2, 3), ping(2, 2, 3), ping(3, 4, 3)});
    EXPECT_THAT(exportNpz(reader, "sonar.ping", folder / "x.npz"),
                testing::ElementsAre(folder / "x.0.npz", folder / "x.1.npz"));
    if (!numpyIsThere()) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    EXPECT_EQ(numpySays(folder / "x.0.npz", "x['bins'].shape"), "(2, 2, 3)\n");
    EXPECT_EQ(numpySays(folder / "x.1.npz", "x['bins'].shape"), "(1, 4, 3)\n");
}

TEST(ExportTest, CsvOfPingsHasALineForEachBin) {
    auto [folder, reader] = Logged("sonar.ping", {ping(1'500'000, 2, 2)});
    exportCsv(reader, "sonar.ping", folder / "x.csv");
    EXPECT_EQ(toText(folder / "x.csv"),
              "time,beam,bearing,bin,value\n"
              "1.500000,0,0.5,0,0.25\n"
              "1.500000,0,0.5,1,1.25\n"
              "1.500000,1,-0.5,0,2.25\n"
              "1.500000,1,-0.5,1,3.25\n");
}

TEST(ExportTest, CsvOfPosesIsATrajectory) {
    auto [folder, reader] = Logged("vehicle.pose", {pose()});
    exportCsv(reader, "vehicle.pose", folder / "x.csv");
    EXPECT_EQ(toText(folder / "x.csv"), "time,x,y,z,qw,qx,qy,qz\n1.500000,1,2,-3.5,0.5,0.5,-0.5,0.5\n");
}

TEST(ExportTest, CsvOfPosesHasTheVelocitiesOfThoseThatStateThem) {
    types::Pose moving = pose();
    moving.velocity = {0.5, -1, 2};
    auto [folder, reader] = Logged("dvl.velocity_samples", {pose(), moving});
    exportCsv(reader, "dvl.velocity_samples", folder / "x.csv");
    EXPECT_EQ(toText(folder / "x.csv"),
              "time,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n"
              "1.500000,1,2,-3.5,0.5,0.5,-0.5,0.5,nan,nan,nan,nan,nan,nan\n"
              "1.500000,1,2,-3.5,0.5,0.5,-0.5,0.5,0.5,-1,2,nan,nan,nan\n");
    exportNpz(reader, "dvl.velocity_samples", folder / "x.npz");
    if (!numpyIsThere()) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    EXPECT_EQ(numpySays(folder / "x.npz", "x['velocity'][1].tolist(), x['angular_velocity'].shape"),
              "[0.5, -1.0, 2.0] (2, 3)\n");
}

TEST(ExportTest, CsvOfNumbersHasTimeAndValue) {
    Folder folder;
    pocolog::Writer log(folder / "x.0.log");
    log.write(log.addStream<bool>("t.on"), {2'000'000}, true);
    log.close();
    pocolog::Reader reader(folder / "x.0.log");
    exportCsv(reader, "t.on", folder / "x.csv");
    EXPECT_EQ(toText(folder / "x.csv"), "time,value\n2.000000,1\n");
}

types::SonarScan scan() {
    types::SonarScan sample;
    sample.time = {2'000'000};
    sample.sampling_interval = 2e-4;
    sample.speed_of_sound = 1500;
    sample.number_of_beams = 2;
    sample.number_of_bins = 1;
    sample.data = {255, 51};
    sample.start_bearing = {0.5};
    sample.angular_resolution = {0.25};
    return sample;
}

/** Two rows of two RGB pixels, a byte of padding after each row. */
types::Image picture() {
    types::Image sample;
    sample.time = {2'000'000};
    sample.size = {2, 2};
    sample.pixel_size = 3;
    sample.row_size = 7;
    sample.frame_mode = types::ImageMode::Rgb;
    sample.image = {1, 2, 3, 4, 5, 6, 99, 7, 8, 9, 10, 11, 12, 99};
    return sample;
}

TEST(ExportTest, ScansAreExportedAsPingsWithDescendingBearings) {
    auto [folder, reader] = Logged("micron.scan", {scan()});
    exportCsv(reader, "micron.scan", folder / "x.csv");
    EXPECT_EQ(toText(folder / "x.csv"), "time,beam,bearing,bin,value\n2.000000,0,0.5,0,1\n2.000000,1,0.25,0,0.2\n");
    if (!numpyIsThere()) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    exportNpz(reader, "micron.scan", folder / "x.npz");
    EXPECT_EQ(numpySays(folder / "x.npz", "x['bins'].shape, x['bearings'].tolist(), x['bin_duration'] * 1e6"),
              "(1, 2, 1) [[0.5, 0.25]] [100.]\n");
}

TEST(ExportTest, NumpyReadsPicturesTextsTimesAndAngles) {
    if (!numpyIsThere()) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    Folder folder;
    pocolog::Writer log(folder / "x.0.log");
    log.write(log.addStream<types::Image>("fan.image"), {1}, picture());
    log.write(log.addStream<std::string>("t.text"), {1}, std::string("abc"));
    log.write(log.addStream<types::Time>("t.time"), {1}, types::Time{2'500'000});
    log.write(log.addStream<types::Angle>("t.angle"), {1}, types::Angle{0.5});
    log.close();
    pocolog::Reader reader(folder / "x.0.log");
    for (const std::string stream : {"fan.image", "t.text", "t.time", "t.angle"})
        exportNpz(reader, stream, folder / (stream + ".npz"));
    EXPECT_EQ(numpySays(folder / "fan.image.npz", "x['pixels'].tolist(), x['pixels'].dtype, x['time']"),
              "[[[[1, 2, 3], [4, 5, 6]], [[7, 8, 9], [10, 11, 12]]]] uint8 [2.]\n");
    EXPECT_EQ(numpySays(folder / "t.text.npz", "x['value']"), "['abc']\n");
    EXPECT_EQ(numpySays(folder / "t.time.npz", "x['value']"), "[2.5]\n");
    EXPECT_EQ(numpySays(folder / "t.angle.npz", "x['value']"), "[0.5]\n");
}

TEST(ExportTest, CsvOfTextsQuotesThem) {
    Folder folder;
    pocolog::Writer log(folder / "x.0.log");
    log.write(log.addStream<std::string>("t.text"), {2'000'000}, std::string("say \"ping\",\ntwice"));
    log.close();
    pocolog::Reader reader(folder / "x.0.log");
    exportCsv(reader, "t.text", folder / "x.csv");
    EXPECT_EQ(toText(folder / "x.csv"), "time,value\n2.000000,\"say \"\"ping\"\",\ntwice\"\n");
}

TEST(ExportTest, NamesStreamsThatCannotBeExported) {
    Folder folder;
    pocolog::Writer log(folder / "x.0.log");
    types::Image compressed = picture();
    compressed.image.resize(4);
    log.write(log.addStream<types::Image>("fan.image"), {1}, compressed);
    types::SonarScan torn = scan();
    torn.data.pop_back();
    log.write(log.addStream<types::SonarScan>("sonar.torn"), {1}, torn);
    types::Sonar broken = ping(1, 2, 3);
    broken.bins.pop_back();
    log.write(log.addStream<types::Sonar>("sonar.broken"), {1}, broken);
    log.write(log.addStream<types::Sonar>("sonar.ping"), {1}, ping(1, 2, 3));
    log.close();
    pocolog::Reader reader(folder / "x.0.log");
    for (const auto& fails : {"fan.image", "sonar.broken", "sonar.torn", "no.such"}) {
        EXPECT_THROW(exportNpz(reader, fails, folder / "x.npz"), types::ConfigError) << fails;
        EXPECT_THROW(exportCsv(reader, fails, folder / "x.csv"), types::ConfigError) << fails;
    }
    EXPECT_THROW(exportNpz(reader, "sonar.ping", "/nonexistent/x.npz"), types::ConfigError);
    EXPECT_THROW(exportCsv(reader, "sonar.ping", "/nonexistent/x.csv"), types::ConfigError);
    EXPECT_THROW(exportNpz(reader, "sonar.ping", "/dev/full"), std::runtime_error);
    EXPECT_THROW(exportCsv(reader, "sonar.ping", "/dev/full"), std::runtime_error);
}

}  // namespace
}  // namespace insonify::log
