// Pings that a driver requests: `settings` of the sonar tasks.
#include <gmock/gmock.h>

#include <cmath>

#include "components/sonar/tasks/PingTask.hpp"
#include "components/sonar/tasks/ScanningSonarTask.hpp"
#include "components/sonar/tasks/Sonar3dTask.hpp"
#include "tests/sonar/WallScene.hpp"
#include "tests/support/Ports.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

/** A sonar task in front of a wall, whose pings are requested. */
template <class Task>
class Asked {
public:
    template <class Config>
    explicit Asked(const Config& config) {
        task.config.set(config);
        scenes_.port.connectTo(task.snapshot, {});
        asked_.port.connectTo(task.settings, framework::ConnPolicy::buffer(4));
        task.ping.connectTo(received_.port, framework::ConnPolicy::buffer(4));
        EXPECT_TRUE(task.configure()) << task.lastError();
        EXPECT_TRUE(task.start()) << task.lastError();
    }
    void show(const types::Snapshot& scene) {
        scenes_.port.write(std::make_shared<types::Snapshot>(scene));
        task.update();
    }
    /** Returns the ping that follows; null when there is none. */
    types::SonarPtr ask(const types::SonarSettings& settings) {
        asked_.port.write(settings);
        task.update();
        return next();
    }
    types::SonarPtr next() {
        types::SonarPtr ping;
        return received_.port.readNew(ping) ? ping : nullptr;
    }

    Task task{"sonar"};

private:
    test::Writer<types::SnapshotPtr> scenes_{"scenes"};
    test::Writer<types::SonarSettings> asked_{"driver"};
    test::Reader<types::SonarPtr> received_{"heard"};
};

TEST(SettingsTest, EachSettingsSampleGivesAPingAndASnapshotDoesNot) {
    Asked<SonarTask> sonar(smallSonar());
    EXPECT_FALSE(sonar.ask({})) << "there is no scene yet";
    sonar.show(facingWall(5));
    EXPECT_TRUE(sonar.next()) << "the request has waited";
    sonar.show(facingWall(5));
    EXPECT_FALSE(sonar.next());
    types::SonarSettings later;
    later.time = {8'000'000};
    const types::SonarPtr first = sonar.ask({}), second = sonar.ask(later);
    ASSERT_TRUE(first && second) << sonar.task.lastError();
    EXPECT_EQ(first->bins, second->bins);
    EXPECT_EQ(first->time, types::Time{7'000'000});
    EXPECT_EQ(second->time, types::Time{8'000'000}) << "the time of the request";
}

TEST(SettingsTest, GivenSettingsApplyFromThePingAndOthersStay) {
    Asked<SonarTask> sonar(smallSonar());
    sonar.show(facingWall(5));
    types::SonarSettings asked;
    asked.range = 8;
    asked.bin_count = 200;
    asked.beam_count = 16;
    asked.field_of_view = types::Angle::fromDeg(40);
    asked.speed_of_sound = 1480;
    const types::SonarPtr ping = sonar.ask(asked);
    ASSERT_TRUE(ping) << sonar.task.lastError();
    EXPECT_EQ(ping->bin_count, 200u);
    EXPECT_EQ(ping->beam_count, 16u);
    EXPECT_NEAR(ping->bearings[0].deg(), -18.75, 1e-9);
    EXPECT_EQ(ping->speed_of_sound, 1480);
    EXPECT_NEAR(firstEcho(*ping, 8), 5, 0.1);
    EXPECT_EQ(sonar.task.config->beam_height_deg, smallSonar().beam_height_deg);
    EXPECT_EQ(sonar.task.config->range, 8);
    const types::SonarPtr same = sonar.ask({});
    ASSERT_TRUE(same);
    EXPECT_EQ(same->bins, ping->bins);
}

TEST(SettingsTest, RejectsInvalidSettingsCompletelyAndRecoversWithTheNextValid) {
    Asked<SonarTask> sonar(smallSonar());
    sonar.show(facingWall(5));
    types::SonarSettings asked;
    asked.range = 8;
    asked.bin_count = 1'000'000;
    EXPECT_FALSE(sonar.ask(asked));
    EXPECT_THAT(sonar.task.lastError(), ::testing::HasSubstr("bin_count"));
    EXPECT_EQ(sonar.task.state(), framework::TaskState::RunTimeError);
    EXPECT_EQ(sonar.task.config->range, smallSonar().range) << "no setting applies";
    EXPECT_TRUE(sonar.ask({}));
    EXPECT_EQ(sonar.task.state(), framework::TaskState::Running);
}

/** Drivers ask for the least that a device knows, which may be nearer than the sonar hears. */
TEST(SettingsTest, ARangeNearerThanTheNearestIsTheShortestThatThereIs) {
    Asked<SonarTask> sonar(smallSonar());
    sonar.show(facingWall(5));
    types::SonarSettings asked;
    for (const double speed : {1300.0, 1450.0, 0.0, 1700.0, asked.unset})
        for (const uint32_t bins : {20u, 25u, 100u, 1000u})
            for (const double range : {smallSonar().range_min, smallSonar().range_min / 2, 0.0}) {
                asked.range = range;
                asked.bin_count = bins;
                asked.speed_of_sound = speed;
                ASSERT_TRUE(sonar.ask(asked)) << range << sonar.task.lastError();
                EXPECT_GE(sonar.task.config->range, 1.1 * smallSonar().range_min) << range;
                EXPECT_LE(sonar.task.config->range, 2.3 * smallSonar().range_min + 1.8e-3 * bins) << range;
            }
    asked.range = -3;
    EXPECT_FALSE(sonar.ask(asked));
    EXPECT_THAT(sonar.task.lastError(), ::testing::HasSubstr("range"));
}

TEST(SettingsTest, AHeadLooksAtTheRequestedBearing) {
    ScanningSonarConfig config;
    config.sonar = smallSonar();
    config.sonar.beam_width_deg = 3;
    Asked<ScanningSonarTask> sonar(config);
    sonar.show(facingWall(5));
    types::SonarSettings asked;
    const auto receivedAt = [&](double deg) {
        asked.bearing = types::Angle::fromDeg(deg);
        const types::SonarPtr ping = sonar.ask(asked);
        EXPECT_TRUE(ping) << sonar.task.lastError();
        EXPECT_NEAR(ping->bearings[0].deg(), deg, 1e-9);
        return firstEcho(*ping, 0);
    };
    EXPECT_NEAR(receivedAt(0), 5, 0.16);
    EXPECT_NEAR(receivedAt(30), 5 / std::cos(types::radians(30)), 0.4) << "slanting, over the width of the beam";
    const types::SonarPtr again = sonar.ask({});
    ASSERT_TRUE(again);
    EXPECT_NEAR(again->bearings[0].deg(), 30, 1e-9) << "it stays there";
}

TEST(SettingsTest, AGridHasTheFieldOfViewOfItsBeams) {
    Sonar3dConfig config;
    config.sonar.range = 10;
    config.sonar.bin_count = 100;
    config.sonar.beam_height_deg = 10;
    config.horizontal = {8, 80};
    config.vertical = {4, 40};
    Asked<Sonar3dTask> sonar(config);
    test::Reader<types::DepthMapPtr> maps{"maps"};
    sonar.task.range_image.connectTo(maps.port, framework::ConnPolicy::buffer(4));
    sonar.show(facingWall(5));
    types::SonarSettings asked;
    asked.field_of_view = types::Angle::fromDeg(40);
    asked.beam_height = types::Angle::fromDeg(5);
    asked.range = 8;
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(sonar.ask(asked)) << sonar.task.lastError();
        types::DepthMapPtr map;
        ASSERT_TRUE(maps.port.readNew(map));
        EXPECT_EQ(map->distances.size(), 32u);
        EXPECT_NEAR(types::degrees(map->horizontal_interval.front()), 17.5, 1e-9);
        EXPECT_NEAR(types::degrees(map->vertical_interval.back()), 15, 1e-9);
    }
    EXPECT_EQ(sonar.task.config->sonar.range, 8);
    EXPECT_NEAR(sonar.task.config->sonar.beam_height_deg, 5, 1e-9);
    asked = {};
    asked.beam_count = 4;
    ASSERT_TRUE(sonar.ask(asked)) << sonar.task.lastError();
    EXPECT_EQ(sonar.task.config->horizontal.beam_count, 4);
    EXPECT_NEAR(sonar.task.config->horizontal.field_of_view_deg, 40, 1e-9);
}

TEST(SettingsTest, APoseBeforeTheFirstSceneWaitsForIt) {
    SonarTask task("sonar");
    task.config.set(smallSonar());
    test::Writer<types::SnapshotPtr> scenes("scenes");
    test::Writer<types::Pose> poses("poses");
    test::Reader<types::SonarPtr> received("received");
    scenes.port.connectTo(task.snapshot, {});
    poses.port.connectTo(task.given_pose, framework::ConnPolicy::buffer(4));
    task.ping.connectTo(received.port, framework::ConnPolicy::buffer(4));
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    types::Pose pose = facingWall(5).sonar;
    for (int i = 1; i <= 2; ++i) {
        pose.time = types::Time::fromSeconds(i);
        poses.port.write(pose);
        task.update();
    }
    scenes.port.write(std::make_shared<types::Snapshot>(facingWall(5)));
    task.update();
    for (int i = 1; i <= 2; ++i) {
        types::SonarPtr ping;
        ASSERT_TRUE(received.port.readNew(ping)) << i;
        EXPECT_EQ(ping->time.seconds(), i);
    }
}

struct OtherConfig {
    double weight = 1;
    static void describe(auto& self, auto& visit) { visit({"weight", "1", "of another block", 0, 9}, self.weight); }
};

/** Declares another block of properties before those of the sonar. */
struct TwoBlocksTask : PingTask {
    using PingTask::PingTask;
    framework::Properties<OtherConfig> other{this};
    framework::Properties<SonarConfig> config{this};
    SonarConfig sonarConfig() const override { return *config; }
};

TEST(SettingsTest, AreThoseOfTheBlockThatHasThem) {
    Asked<TwoBlocksTask> sonar(smallSonar());
    sonar.show(facingWall(5));
    types::SonarSettings asked;
    asked.range = 12;
    const auto ping = sonar.ask(asked);
    ASSERT_TRUE(ping) << sonar.task.lastError();
    EXPECT_EQ(sonar.task.config->range, 12);
}

TEST(SettingsTest, TheSonarsOwnSpeedOfSoundFollowsItsWaterBeforeAndAfterADriverSetsOne) {
    auto config = smallSonar();
    config.speed_of_sound.reset();
    config.water.emplace().temperature_celsius = 4;
    Asked<SonarTask> sonar(config);
    sonar.show(facingWall(5));
    const auto speed = [&](double asked) {
        types::SonarSettings settings;
        settings.speed_of_sound = asked;
        const auto ping = sonar.ask(settings);
        return ping ? double{ping->speed_of_sound} : 0;
    };
    const auto warm = [&](const char* celsius) {
        sonar.task.properties().front()->setAll({{"water", std::string("{temperature_celsius: ") + celsius + "}"}});
    };
    const double unset = types::SonarSettings::unset, cold = speed(unset);
    EXPECT_EQ(speed(0), cold);
    EXPECT_EQ(speed(1520), 1520);
    EXPECT_EQ(speed(1530), 1530);
    EXPECT_EQ(speed(0), cold);
    warm("20");
    EXPECT_GT(speed(0), cold + 20);
    EXPECT_GT(speed(unset), cold + 20);
}

TEST(SettingsTest, ASpeedOfSoundThatIsConfiguredComesBackAfterADriversOwn) {
    auto config = smallSonar();
    config.speed_of_sound = 1450;
    Asked<SonarTask> sonar(config);
    sonar.show(facingWall(5));
    for (const auto& [asked, used] : {std::pair{0.0, 1450.0}, {1520.0, 1520.0}, {0.0, 1450.0}, {0.0, 1450.0}}) {
        types::SonarSettings settings;
        settings.speed_of_sound = asked;
        const auto ping = sonar.ask(settings);
        ASSERT_TRUE(ping) << sonar.task.lastError();
        EXPECT_EQ(double{ping->speed_of_sound}, used);
    }
}

}  // namespace
}  // namespace insonify::sonar
