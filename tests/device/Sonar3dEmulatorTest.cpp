// A Sonar 3D-15 with requests, packets and a simulated clock.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "components/device/sonar3d/Sonar3dEmulator.hpp"

namespace insonify::device {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Datagram {
    std::string address;
    uint16_t port;
    Bytes bytes;
};

struct Sonar3dEmulatorTest : ::testing::Test {
    HttpReply get(const std::string& path) { return emulator_.answer({"GET", prefix + path, ""}, now_); }
    HttpReply post(const std::string& path, const std::string& body) {
        return emulator_.answer({"POST", prefix + path, body}, now_);
    }
    Json json(const std::string& path) { return Json::parse(get(path).body); }
    void advance(double seconds) {
        now_ = now_ + types::Time::fromSeconds(seconds);
        emulator_.tick(now_);
    }
    /** A map of 3 x 2 directions; rows from the top, columns from port. */
    types::DepthMap map() const {
        types::DepthMap map;
        map.time = now_;
        map.vertical_size = 2;
        map.horizontal_size = 3;
        map.vertical_interval = {-0.1, 0.1};
        map.horizontal_interval = {0.4, 0, -0.4};
        map.distances = {1, 2, 3, 4, 5, types::DepthMap::too_far};
        map.remissions = {1e-6F, 1e-4F, 1e-8F, 1e-6F, 1e-30F, 0};
        return map;
    }
    template <class Image>
    Image sent(size_t i) const {
        return std::get<Image>(ripMessages(datagrams_.at(i).bytes).at(0));
    }

    const std::string prefix = "/api/v1/integration/";
    types::Time now_{1'700'000'000'000'000};
    std::vector<types::SonarSettings> requests_;
    std::vector<Datagram> datagrams_;
    std::vector<std::string> warnings_;
    Sonar3dEmulator emulator_{{},
                              {[this](const types::SonarSettings& settings) { requests_.push_back(settings); },
                               [this](const std::string& address, uint16_t port, Bytes bytes) {
                                   datagrams_.push_back({address, port, std::move(bytes)});
                               },
                               [this](const std::string& text) { warnings_.push_back(text); }}};
};

TEST_F(Sonar3dEmulatorTest, ReportsDeviceInformation) {
    EXPECT_EQ(json("about")["product_name"], "Sonar 3D-15");
    EXPECT_EQ(json("about")["is_ready"], true);
    for (const char* part : {"api", "temperature", "systems_check", "time"}) {
        EXPECT_EQ(json("status")[part]["status"], "ok") << part;
        EXPECT_EQ(json("status")[part]["operational"], true) << part;
    }
    EXPECT_EQ(json("temperature"), 12.0);
    EXPECT_EQ(json("acoustics/enabled"), false) << "as at power-on";
    EXPECT_EQ(json("acoustics/mode"), "low-frequency");
    EXPECT_EQ(json("udp")["mode"], "multicast");
}

/** As Water Linked's extension of BlueOS searches the network: GET, and "Sonar 3D-15" in the product's name. */
TEST_F(Sonar3dEmulatorTest, TheMakersFinderFindsIt) {
    const HttpReply found = emulator_.answer({"GET", "/api/v1/about", ""}, now_);
    EXPECT_EQ(found.status, 200);
    EXPECT_THAT(Json::parse(found.body)["product_name"].get<std::string>(), HasSubstr("Sonar 3D-15"));
    EXPECT_EQ(Json::parse(found.body), json("about"));
    EXPECT_EQ(emulator_.answer({"POST", "/api/v1/about", "1"}, now_).status, 405);
    for (const char* other : {"/api/v1/about/", "/api/v1/status", "/api/v1/", "/api/about", "/about", "/api/v1/udp"})
        EXPECT_EQ(emulator_.answer({"GET", other, ""}, now_).status, 404) << other;
}

TEST_F(Sonar3dEmulatorTest, KeepsItsSettings) {
    const std::vector<std::pair<std::string, std::string>> settings = {
        {"acoustics/enabled", "true"},
        {"acoustics/range", R"({"max":7.5,"min":0.5})"},
        {"acoustics/speed_of_sound", "1512.5"},
        {"acoustics/mode", R"("high-frequency")"},
        {"acoustics/salinity", R"("fresh")"},
        {"output/imu-batch/enabled", "true"},
        {"time/ntp", R"({"ntp_address":"10.0.0.1"})"},
        {"udp", R"({"mode":"unicast","unicast_destination_ip":"127.0.0.1","unicast_destination_port":4000})"}};
    for (const auto& [path, body] : settings) {
        const HttpReply reply = post(path, body);
        EXPECT_EQ(reply.status, 204) << path << reply.body;
        EXPECT_EQ(reply.body, "");
        EXPECT_EQ(json(path), Json::parse(body)) << path;
    }
}

TEST_F(Sonar3dEmulatorTest, RefusesValuesOutOfBoundsWithoutChanges) {
    const auto expectRefused = [&](const std::string& path, const std::string& body, const std::string& words) {
        const Json before = json(path);
        const HttpReply reply = post(path, body);
        EXPECT_EQ(reply.status, 400) << path << body;
        EXPECT_THAT(Json::parse(reply.body)["error"].get<std::string>(), HasSubstr(words)) << path << body;
        EXPECT_EQ(json(path), before);
    };
    expectRefused("acoustics/range", R"({"min": 1, "max": 15.1})", "must be 0 <= min < max <= 15");
    expectRefused("acoustics/range", R"({"min": 5, "max": 5})", "a range of 5 to 5 m");
    expectRefused("acoustics/range", R"({"min": -1, "max": 5})", "a range of -1 to 5 m");
    expectRefused("acoustics/range", R"({"max": 5})", "an object with min");
    expectRefused("acoustics/range", R"({"min": 0, "max": "5"})", "max must be a number");
    expectRefused("acoustics/range", "[1, 2]", "an object with min");
    expectRefused("acoustics/speed_of_sound", "999", "must be 1000 to 2000, or 0: automatic");
    expectRefused("acoustics/speed_of_sound", "2000.5", "a speed of sound of 2000.5 m/s");
    expectRefused("acoustics/speed_of_sound", "1e400", "JSON");
    expectRefused("acoustics/enabled", "1", "true or false");
    expectRefused("acoustics/enabled", "", "no JSON");
    expectRefused("acoustics/enabled", "tru", "no JSON");
    expectRefused("acoustics/mode", R"("low")", "neither");
    expectRefused("acoustics/salinity", "35", "must be a string");
    expectRefused("output/imu-batch/enabled", "null", "true or false");
    expectRefused("udp", R"({"mode": "broadcast"})", "must be \"multicast\", \"unicast\" or \"disabled\"");
    expectRefused("udp", R"({"mode": "unicast"})", "unicast_destination_ip is \"\"");
    expectRefused("udp", R"({"mode": "unicast", "unicast_destination_ip": "1.2.3.256"})", "must be like");
    expectRefused("udp", R"({"mode": "unicast", "unicast_destination_ip": "01.2.3.4"})", "must be like");
    expectRefused("udp", R"({"mode": "unicast", "unicast_destination_ip": "1.2.3.4"})", "must be 1 to 65535");
    expectRefused("udp", R"({"mode": "disabled", "unicast_destination_port": 65536})", "port is 65536");
    expectRefused("udp", R"({"mode": "disabled", "unicast_destination_port": 1.5})", "port is 1.5");
    expectRefused("time/ntp", R"({"ntp_address": ""})", "must be a host");
    EXPECT_EQ(get("acoustics").status, 404);
    EXPECT_EQ(emulator_.answer({"GET", "/", ""}, now_).status, 404);
    EXPECT_EQ(post("about", "1").status, 405);
    EXPECT_EQ(get("time/manual").status, 405);
    EXPECT_EQ(emulator_.answer({"DELETE", prefix + "udp", ""}, now_).status, 405);
}

TEST_F(Sonar3dEmulatorTest, TheInitialRangeIsWithinItsLimit) {
    Sonar3dDevice device;
    device.longest_range = 7;
    EXPECT_EQ(Sonar3dEmulator(device, {}).state().range_max, 7);
    EXPECT_EQ(emulator_.state().range_max, 15);
}

TEST_F(Sonar3dEmulatorTest, RequestsPingsAtTheRateOfItsModeOnceEnabled) {
    advance(1);
    EXPECT_THAT(requests_, IsEmpty());
    post("acoustics/enabled", "true");
    post("acoustics/speed_of_sound", "1500");
    advance(0);
    ASSERT_EQ(requests_.size(), 1u);
    EXPECT_EQ(requests_[0].time, now_);
    EXPECT_EQ(requests_[0].range, 15);
    EXPECT_EQ(requests_[0].speed_of_sound, 1500);
    EXPECT_EQ(requests_[0].frequency_khz, 1200);
    EXPECT_NEAR(requests_[0].field_of_view.deg() * 255 / 256, 90, 1e-9) << "between the outermost of 256 columns";
    advance(0.1);
    emulator_.setPing(map());
    advance(0.05);
    EXPECT_EQ(requests_.size(), 1u) << "five a second";
    advance(0.05);
    EXPECT_EQ(requests_.size(), 2u);
    advance(1);
    EXPECT_EQ(requests_.size(), 2u) << "one at a time";
    post("acoustics/mode", R"("high-frequency")");
    post("acoustics/range", R"({"min": 0, "max": 5})");
    emulator_.setPing(map());
    EXPECT_EQ(sent<RangePixels>(2).frequency_hz, 1'200'000u) << "of an earlier request";
    advance(0);
    EXPECT_EQ(requests_.at(2).frequency_khz, 2400);
    EXPECT_EQ(requests_[2].range, 5);
    EXPECT_NEAR(requests_[2].field_of_view.deg() * 255 / 256, 40, 1e-9);
    emulator_.setPing(map());
    advance(0.05);
    EXPECT_EQ(requests_.size(), 4u) << "twenty a second";
    post("acoustics/enabled", "false");
    emulator_.setPing(map());
    EXPECT_EQ(datagrams_.size(), 6u) << "the ping in progress is not sent";
}

TEST_F(Sonar3dEmulatorTest, AnImageHasRowsFromBelowAndItsScale) {
    post("acoustics/enabled", "true");
    post("acoustics/range", R"({"min": 1.5, "max": 15})");
    advance(0);
    emulator_.setPing(map());
    ASSERT_EQ(datagrams_.size(), 2u);
    EXPECT_EQ(datagrams_[0].address, "224.0.0.96");
    EXPECT_EQ(datagrams_[0].port, 4747);
    const auto ranges = sent<RangePixels>(0);
    EXPECT_EQ(ranges.time, now_);
    EXPECT_EQ(ranges.sequence, 1u);
    EXPECT_EQ(ranges.width, 3u);
    EXPECT_EQ(ranges.height, 2u);
    EXPECT_NEAR(ranges.field_of_view_deg, 0.8 * 180 / M_PI, 1e-4);
    EXPECT_NEAR(ranges.vertical_opening_deg, 0.2 * 180 / M_PI, 1e-4);
    EXPECT_EQ(ranges.range, 15);
    EXPECT_THAT(ranges.pixels, ElementsAre(4000, 5000, 0, 0, 2000, 3000)) << "1 m is less than the min range";
    const auto strengths = sent<StrengthPixels>(1);
    EXPECT_EQ(strengths.sequence, 1u);
    EXPECT_THAT(strengths.pixels, ElementsAre(155, 1, 0, 0, 255, 55)) << "50 for each 10 dB, the strongest 255";
}

TEST_F(Sonar3dEmulatorTest, SendsToTheConfiguredAddress) {
    post("acoustics/enabled", "true");
    post("udp", R"({"mode":"unicast","unicast_destination_ip":"10.0.0.7","unicast_destination_port":4001})");
    advance(0);
    emulator_.setPing(map());
    ASSERT_EQ(datagrams_.size(), 2u);
    EXPECT_EQ(datagrams_[1].address, "10.0.0.7");
    EXPECT_EQ(datagrams_[1].port, 4001);
    post("udp", R"({"mode":"disabled","unicast_destination_ip":"","unicast_destination_port":0})");
    advance(1);
    emulator_.setPing(map());
    EXPECT_EQ(datagrams_.size(), 2u);
}

TEST_F(Sonar3dEmulatorTest, TheAutomaticSpeedOfSoundIsThatOfTheWater) {
    post("acoustics/speed_of_sound", "0");
    post("acoustics/enabled", "true");
    advance(0);
    EXPECT_NEAR(requests_.at(0).speed_of_sound, 1497.0, 0.2) << "12 degrees, 35 psu (Medwin: 1496.98)";
    emulator_.setPing(map());
    post("acoustics/salinity", R"("fresh")");
    advance(1);
    EXPECT_NEAR(requests_.at(1).speed_of_sound, 1497.0 - 35 * (1.34 - 0.12), 0.2);
}

TEST_F(Sonar3dEmulatorTest, ClientsMaySetItsClock) {
    EXPECT_EQ(json("time/status")["system_time"], "2023-11-14T22:13:20.000000Z");
    EXPECT_EQ(json("time/status")["ntp_synced"], false);
    EXPECT_TRUE(json("time/status")["ntp_seconds_since_last_sync"].is_null());
    EXPECT_EQ(post("time/manual", R"({"now": "2026-01-01T00:00:00+00:00"})").status, 204);
    EXPECT_EQ(post("time/manual", R"({"now": "yesterday"})").status, 400);
    advance(2);
    EXPECT_EQ(json("time/status")["system_time"], "2026-01-01T00:00:02.000000Z");
    post("acoustics/enabled", "true");
    advance(0);
    emulator_.setPing(map());
    EXPECT_EQ(sent<RangePixels>(0).time.microseconds, 1'767'225'602'000'000) << "images too";
    const Json synced = Json::parse(post("time/ntp/force-sync", R"({"timeout_seconds": 5})").body);
    EXPECT_EQ(synced["success"], true);
    EXPECT_EQ(synced["status"]["ntp_synced_to"], "auto");
    EXPECT_EQ(post("time/manual", R"({"now": "2026-01-01T00:00:00Z"})").status, 409) << "it is synchronised";
    EXPECT_EQ(post("time/ntp/force-sync", "{}").status, 400);
}

TEST_F(Sonar3dEmulatorTest, RequestsAMissingPingAgainAndWarnsOncePerOutage) {
    post("acoustics/enabled", "true");
    advance(0);
    for (int i = 0; i < 3; ++i) advance(3);
    EXPECT_EQ(requests_.size(), 4u);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_THAT(warnings_[0], HasSubstr("a requested ping gave no range image"));
    types::DepthMap silent;
    silent.time = now_;
    emulator_.setPing(silent);
    advance(1);
    types::DepthMap unmeasured = map();
    unmeasured.remissions.clear();
    emulator_.setPing(unmeasured);
    EXPECT_EQ(datagrams_.size(), 4u) << "an empty map, and one without strengths";
    EXPECT_THAT(sent<StrengthPixels>(3).pixels, ElementsAre(1, 1, 0, 1, 1, 1));
    EXPECT_EQ(warnings_.size(), 1u);
    advance(1);
    advance(3);
    EXPECT_EQ(warnings_.size(), 2u) << "of the next outage";
}

/** A sonar slower than the device's patience: each image has the settings of its request. */
TEST_F(Sonar3dEmulatorTest, ALateImageHasTheSettingsOfItsRequest) {
    post("acoustics/enabled", "true");
    advance(0);
    const types::DepthMap first = map();
    post("acoustics/mode", R"("high-frequency")");
    advance(3);
    ASSERT_EQ(requests_.size(), 2u);
    types::DepthMap earlier = first;
    earlier.time = earlier.time - types::Time{1};
    emulator_.setPing(earlier);
    EXPECT_THAT(datagrams_, IsEmpty()) << "no request for it";
    emulator_.setPing(first);
    EXPECT_EQ(sent<RangePixels>(0).frequency_hz, 1'200'000u);
    emulator_.setPing(map());
    EXPECT_EQ(sent<RangePixels>(2).frequency_hz, 2'400'000u);
    emulator_.setPing(map());
    EXPECT_EQ(datagrams_.size(), 4u) << "twice the same";
}

TEST_F(Sonar3dEmulatorTest, RefusesBodiesOfAnyDepth) {
    const auto nested = [](const std::string& open, const std::string& close, int levels) {
        std::string text;
        for (int i = 0; i < levels; ++i) text += open;
        text += "1";
        for (int i = 0; i < levels; ++i) text += close;
        return text;
    };
    for (const int levels : {9, 100, 32'000, 1'000'000})
        for (const std::string& deep :
             {nested("[", "]", levels), nested("{\"a\":", "}", levels), std::string(levels, '[')})
            for (const char* path : {"acoustics/enabled", "acoustics/range", "acoustics/mode", "udp", "time/manual",
                                     "time/ntp", "time/ntp/force-sync"})
                for (const std::string& body :
                     {deep, R"({"mode":"unicast","unicast_destination_ip":)" + deep + "}", R"({"min":)" + deep + "}"})
                    EXPECT_EQ(post(path, body).status, 400) << levels << " in " << path;
    EXPECT_EQ(json("udp")["mode"], "multicast");
}

}  // namespace
}  // namespace insonify::device
