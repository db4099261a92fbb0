#include <gmock/gmock.h>

#include "components/log/Files.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/logger/PropertyLog.hpp"
#include "tests/support/Folder.hpp"

namespace insonify::logger {
namespace {

TEST(PropertyLogTest, APropertyIsAStreamWithASampleForEachChange) {
    Folder folder;
    PropertyLog log(folder / "properties.0.log");
    types::TaskRecord sonar{"sonar", "sonar::SonarTask", {{"range", 50.0}, {"bin_count", int64_t{500}}}, ""};
    log.record({sonar}, {1'000'000}, {{"insonify_seed", "7"}});
    log.record({sonar}, {2'000'000}, {});
    sonar.properties = {{"range", 30.0}, {"bin_count", int64_t{500}}, {"tvg", "{\"max_db\": 100}"}};
    log.record({sonar}, {3'000'000}, {});
    log.close();

    EXPECT_FALSE(log::check(folder / "properties.0.log").diagnostic);
    log::pocolog::Reader reader(folder / "properties.0.log");
    std::vector<std::pair<double, double>> ranges;
    reader.forEach<double>(
        "sonar.range", [&](double value, const log::SampleRef& at) { ranges.emplace_back(at.time.seconds(), value); });
    EXPECT_THAT(ranges, testing::ElementsAre(testing::Pair(1, 50), testing::Pair(3, 30)));
    EXPECT_EQ(reader.find("sonar.bin_count")->type, "/int64_t");
    EXPECT_EQ(reader.find("sonar.bin_count")->count, 1u);
    EXPECT_EQ(reader.find("sonar.tvg")->type, "/std/string");
    const log::Metadata& metadata = reader.find("sonar.range")->metadata;
    EXPECT_EQ(metadata.at("rock_stream_type"), "property");
    EXPECT_EQ(metadata.at("rock_task_name"), "sonar");
    EXPECT_EQ(metadata.at("rock_task_object_name"), "range");
    EXPECT_EQ(metadata.at("rock_task_model"), "sonar::SonarTask");
    EXPECT_EQ(metadata.at("insonify_seed"), "7");
}

TEST(PropertyLogTest, ATaskHasRocksModelWhereKnown) {
    Folder folder;
    PropertyLog log(folder / "properties.0.log");
    log.record({{"sonar", "sonar::SonarTask", {{"range", 50.0}}, ""}, {"pose", "pose::PoseTask", {{"rate", 5.0}}, ""}},
               {1}, {}, {}, {{"sonar", "rock::Sonar"}});
    log.close();

    const log::pocolog::Reader reader(folder / "properties.0.log");
    EXPECT_EQ(reader.find("sonar.range")->metadatum("rock_task_model"), "rock::Sonar");
    EXPECT_EQ(reader.find("pose.rate")->metadatum("rock_task_model"), "pose::PoseTask");
}

TEST(PropertyLogTest, RecordsRemovalAndReturnOfAProperty) {
    Folder folder;
    PropertyLog log(folder / "properties.0.log");
    const types::TaskRecord with{"sonar", "sonar::SonarTask", {{"range", 50.0}, {"speed_of_sound", 1480.0}}, ""};
    const types::TaskRecord without{"sonar", "sonar::SonarTask", {{"range", 50.0}}, ""};
    int64_t moment = 1'000'000;
    for (const types::TaskRecord& record : {with, without, without, with, with}) log.record({record}, {moment++}, {});
    log.close();

    log::pocolog::Reader reader(folder / "properties.0.log");
    std::vector<std::pair<int64_t, bool>> presence;
    reader.forEach<bool>("sonar.speed_of_sound.present", [&](bool is_there, const log::SampleRef& at) {
        presence.emplace_back(at.received.microseconds - 1'000'000, is_there);
    });
    EXPECT_THAT(presence, testing::ElementsAre(testing::Pair(1, false), testing::Pair(3, true)));
    EXPECT_EQ(reader.find("sonar.speed_of_sound")->count, 2u) << "at the start and at its return";
    EXPECT_FALSE(reader.find("sonar.range.present")) << "it was always present";
}

TEST(PropertyLogTest, AnAliasHasItsOwnStreamWithAnglesInRadians) {
    Folder folder;
    PropertyLog log(folder / "properties.0.log", "tasks: {}");
    PropertyAlias gain{"rock", "gain", "p::Task", "receiver.brightness.gain", 0.5},
        width{"rock", "beam_width", "p::Task", "sonar.beam_width_deg", 90.0, true},
        noisy{"rock", "enable_noise", "p::Task", "receiver.noise", false};
    const types::TaskRecord sonar{"sonar", "s::Task", {{"beam_width_deg", 90.0}}, ""};
    log.record({sonar}, {1}, {}, {gain, width, noisy});
    gain.value = 0.75;
    noisy.value = true;
    width.value.reset();
    log.record({sonar}, {2}, {}, {gain, width, noisy});
    log.close();

    log::pocolog::Reader reader(folder / "properties.0.log");
    std::vector<double> gains;
    reader.forEach<double>("rock.gain", [&](double value, const log::SampleRef&) { gains.push_back(value); });
    EXPECT_THAT(gains, testing::ElementsAre(0.5, 0.75));
    std::vector<double> widths;
    reader.forEach<types::Angle>("rock.beam_width",
                                 [&](types::Angle value, const log::SampleRef&) { widths.push_back(value.deg()); });
    EXPECT_THAT(widths, testing::ElementsAre(testing::DoubleNear(90, 1e-12)));
    std::vector<bool> switches;
    reader.forEach<bool>("rock.enable_noise", [&](bool on, const log::SampleRef&) { switches.push_back(on); });
    EXPECT_THAT(switches, testing::ElementsAre(false, true));
    EXPECT_EQ(reader.find("rock.gain")->metadata.at("rock_task_model"), "p::Task");
    EXPECT_EQ(reader.find("rock.gain")->metadata.at("insonify_alias_of"), "receiver.brightness.gain");
    size_t deployments = 0;
    for (const log::Stream& stream : reader.streams()) deployments += stream.metadata.count("insonify_deployment");
    EXPECT_EQ(deployments, 1u);
}

}  // namespace
}  // namespace insonify::logger
