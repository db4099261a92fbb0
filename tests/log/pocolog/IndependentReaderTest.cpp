// Logs read by an independent program: read_log.py knows Rock's format and no type.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "components/log/pocolog/Writer.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

namespace insonify::log::pocolog {
namespace {

using nlohmann::json;

json readByPython(const std::filesystem::path& log) {
    const std::string script = test::sourceFile("tests/log/pocolog/read_log.py");
    const std::string said = pythonSays(script + " " + log.string(), log.parent_path() / "answer.txt");
    const json reported = json::parse(said, nullptr, false);
    EXPECT_FALSE(reported.is_discarded()) << said;
    return reported;
}

types::Sonar ping() {
    types::Sonar sample;
    sample.time = {1'700'000'000'000'000};
    sample.bin_duration = {67};
    sample.resize(2, 3);
    sample.setRegularBearings({-0.5}, {0.5});
    sample.timestamps = {{1}, {2}, {3}};
    for (size_t i = 0; i < sample.bins.size(); ++i) sample.bins[i] = static_cast<float>(i);
    return sample;
}

types::Image picture() {
    types::Image sample;
    sample.time = {5};
    sample.image = {1, 2, 3};
    sample.attributes = {{"forty-two", "answer"}, {"", "empty"}};
    sample.size = {640, 480};
    sample.pixel_size = 3;
    sample.frame_mode = types::ImageMode::Bgr;
    sample.frame_status = types::ImageStatus::Valid;
    return sample;
}

TEST(IndependentReaderTest, DecodesEveryTypeFromItsRegistryToTheLastByteAndFindsTheIndexItWouldWrite) {
    Folder folder;
    Writer log(folder / "x.0.log");
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        const size_t stream = log.addStream<T>("all." + std::to_string(log.size()));
        log.write(stream, {1'500'000}, T{});
        log.write(stream, {2'500'000}, T{});
    });
    log.addStream<double>("never.written");
    log.close();
    const json reported = readByPython(folder / "x.0.log");
    EXPECT_TRUE(reported["index"]);
    EXPECT_EQ(reported["streams"].size(), std::tuple_size_v<types::SampleTypes> + 1);
    for (const auto& [name, stream] : reported["streams"].items())
        EXPECT_EQ(stream["samples"].size(), name == "never.written" ? 0u : 2u) << name;
}

TEST(IndependentReaderTest, FindsTheValuesThatWereWritten) {
    Folder folder;
    Writer log(folder / "x.0.log");
    log.write(log.addStream<types::Sonar>("sonar.ping", {{"insonify_deployment", "tasks: \"a\"\n\tb"}}), {7}, ping());
    types::Pose pose;
    pose.time = {6};
    pose.source_frame = "body";
    pose.position = {1, 2, -3};
    pose.orientation = {0.5, -0.5, 0.25, 0.125};
    log.write(log.addStream<types::Pose>("vehicle.pose"), {8}, pose);
    log.write(log.addStream<types::Image>("fan.image"), {9}, picture());
    types::SonarBeam beam;
    beam.bearing = {0.25};
    beam.sampling_interval = 0.001;
    beam.beam = {9, 8};
    log.write(log.addStream<types::SonarBeam>("micron.beam"), {10}, beam);
    log.close();
    const json streams = readByPython(folder / "x.0.log")["streams"];

    EXPECT_EQ(streams["sonar.ping"]["metadata"]["insonify_deployment"], "tasks: \"a\"\n\tb");
    const json& sonar = streams["sonar.ping"]["samples"][0];
    EXPECT_EQ(sonar[0], 7);
    EXPECT_EQ(sonar[1], 1'700'000'000'000'000);
    EXPECT_EQ(sonar[2]["bin_duration.microseconds"], 67);
    EXPECT_EQ(sonar[2]["bearings"], json::parse("[{\"rad\": -0.5}, {\"rad\": 0.0}, {\"rad\": 0.5}]"));
    EXPECT_EQ(sonar[2]["timestamps"][2]["microseconds"], 3);
    EXPECT_EQ(sonar[2]["bins"], json::parse("[0, 1, 2, 3, 4, 5]"));
    const json& vehicle = streams["vehicle.pose"]["samples"][0][2];
    EXPECT_EQ(vehicle["sourceFrame"], "body");
    EXPECT_EQ(vehicle["position.data.2"], -3);
    EXPECT_EQ(vehicle["orientation.im.0"], -0.5);
    EXPECT_TRUE(vehicle["cov_position.data.1"].is_null()) << "unknown, off the diagonal as well";
    EXPECT_EQ(vehicle["orientation.re"], 0.5);
    const json& image = streams["fan.image"]["samples"][0][2];
    EXPECT_EQ(image["attributes"][0]["name_"], "answer");
    EXPECT_EQ(image["size.width"], 640);
    EXPECT_EQ(image["frame_mode"], "MODE_BGR");
    EXPECT_EQ(image["frame_status"], "STATUS_VALID");
    const json& scanned = streams["micron.beam"]["samples"][0][2];
    EXPECT_EQ(scanned["bearing.rad"], 0.25);
    EXPECT_EQ(scanned["beam"], json::parse("[9, 8]"));
}

}  // namespace
}  // namespace insonify::log::pocolog
