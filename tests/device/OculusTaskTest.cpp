// Drivers connect to an emulated Oculus over the network, while a simulated sonar answers.
#include <gmock/gmock.h>

#include <atomic>
#include <memory>
#include <thread>

#include "components/device/DeviceTask.hpp"
#include "components/device/oculus/OculusTask.hpp"
#include "components/framework/Deployment.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/OculusDriver.hpp"

namespace insonify::device {
namespace {

using namespace std::chrono_literals;
using test::EnstaDriver;
using test::OculusDriver;
using test::OculusListener;
using test::RockDriver;
using test::UwDriver;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/** Answers settings with a ping: the code in each bin is the number of the beam, except for a target at 5 m to
 *  starboard. */
class EchoTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    framework::InputPort<types::SonarSettings> settings{this, "settings", ""};
    framework::OutputPort<types::SonarPtr> ping{this, "ping", "", types::left_receiver};

private:
    void updateHook() override {
        types::SonarSettings request;
        while (settings.readNew(request)) ping.write(answer(request));
    }
    static types::SonarPtr answer(const types::SonarSettings& request) {
        auto ping = std::make_shared<types::Sonar>();
        ping->time = request.time;
        ping->setBins(request.range / request.bin_count, 1500);
        ping->bin_count = request.bin_count;
        ping->beam_count = request.beam_count;
        ping->bins.assign(size_t{request.bin_count} * request.beam_count, 6554);
        for (uint32_t beam = 0; beam < request.beam_count; ++beam)
            ping->bearings.push_back(
                {(beam + 0.5) / request.beam_count * request.field_of_view.rad - request.field_of_view.rad / 2});
        const auto bin = static_cast<size_t>(5 / request.range * request.bin_count);
        ping->bins[10 * size_t{request.bin_count} + bin] = 65535;
        return ping;
    }
};

struct OculusTaskTest : ::testing::Test {
    OculusTaskTest() {
        registry_.add<EchoTask>("test::EchoTask", "");
        registerTasks(registry_);
    }
    void start(const std::vector<std::string>& set = {}) {
        auto spec = framework::DeploymentSpec::parse(R"(
schedule: realtime
tasks:
  echo:   {type: test::EchoTask, activity: {trigger: [settings]}}
  device: {type: device::OculusTask, properties: {port: 0}}
connections:
  - {from: device.settings, to: echo.settings, policy: {type: buffer, size: 4}}
  - {from: echo.ping, to: device.ping}
)",
                                                     "test.yml");
        spec.set("device.status_port=" + std::to_string(listener_.port()));
        for (const std::string& each : set) spec.set(each);
        deployment_ = std::make_unique<framework::Deployment>(spec, registry_);
        deployment_->configure();
        port_ = task().port();
        thread_ = std::thread([this] { deployment_->run({}, stop_); });
    }
    ~OculusTaskTest() override {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
    }
    OculusTask& task() const { return dynamic_cast<OculusTask&>(*deployment_->task("device")); }
    std::string makeNotice(const std::string& part) const {
        for (const std::string& notice : types::lines(task().notices()))
            if (notice.find(part) != std::string::npos) return notice;
        return "";
    }

    OculusListener listener_;
    framework::Registry registry_;
    std::unique_ptr<framework::Deployment> deployment_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
    uint16_t port_ = 0;
};

TEST_F(OculusTaskTest, TheDriverOfEnstaFindsItConfiguresItAndSetsItToStandby) {
    start();
    EnstaDriver driver(listener_.next(), port_);
    EXPECT_TRUE(oculusHeader(driver.nextMessage())->is(OculusId::Dummy)) << "it is in standby";
    OculusFire fire{.mode = 2, .rate = 2, .gamma = 0xFF, .flags = 0x19, .range = 7.3, .gain_percent = 20};
    EXPECT_LT(driver.request(fire), 100);
    const OculusResult ping = driver.nextPing();
    EXPECT_EQ(ping.frequency_hz, 1.2e6);
    EXPECT_EQ(ping.beam_count, 256);
    const auto bin = static_cast<size_t>(5 / 7.3 * 1000);
    EXPECT_NEAR(EnstaDriver::amplitude(ping, bin, 245), 255, 1e-9) << "to starboard of the middle";
    EXPECT_NEAR(EnstaDriver::amplitude(ping, bin, 10), 25.5, 1);
    EXPECT_NEAR(EnstaDriver::amplitude(ping, 5, 10), 25.5, 0.1) << "finer by the row's gain";
    fire.rate = OculusFire::standby;
    EXPECT_LT(driver.request(fire), 100);
}

TEST_F(OculusTaskTest, SendsItsStatusEachSecondWithoutAClient) {
    start();
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 3; ++i) EXPECT_EQ(listener_.next().part, 1032);
    EXPECT_GE(std::chrono::steady_clock::now() - begin, 1s);
}

TEST_F(OculusTaskTest, TheDriverOfRockFiresWithPayloadSizeZeroAndReadsEightBits) {
    start();
    RockDriver driver(port_);
    for (const double range : {10.0, 20.0}) {
        for (int i = 0; i < 3; ++i) driver.fire({.rate = 2, .range = range});
        OculusResult ping = driver.nextPing();
        while (ping.fire.range != range) ping = driver.nextPing();
        EXPECT_EQ(ping.fire.header.version, 0);
        EXPECT_EQ(ping.image.size(), 256 * 1000u);
        const auto bin = static_cast<size_t>(5 / range * 1000);
        EXPECT_EQ(ping.image[bin * 256 + 245], 255);
        EXPECT_EQ(ping.image[bin * 256 + 244], 26);
    }
}

TEST_F(OculusTaskTest, TheDriverOfTheUniversityOfWashingtonReads32BitsOf512Beams) {
    start();
    UwDriver driver(listener_.next(), port_);
    driver.fire({.rate = 2, .range = 10});
    const OculusResult ping = driver.nextPing();
    EXPECT_EQ(ping.fixedSize(), 202u);
    EXPECT_GT(ping.image_offset, 122u);
    EXPECT_EQ(ping.image.size(), 4 * 512 * 1000u);
    EXPECT_EQ(read<uint32_t>(ping.image, 4 * (500 * 512 + 501)), 4294967295u);
    EXPECT_EQ(ping.range_resolution, 0.01);
}

TEST_F(OculusTaskTest, RecordsSentPings) {
    const Folder folder;
    start({"device.record=" + (folder / "dive.oculus").string()});
    std::vector<Bytes> echoes;
    {
        OculusDriver driver(port_);
        driver.send(toBytes({.rate = 2, .range = 10}));
        for (int i = 0; i < 3; ++i) echoes.push_back(toBytes(driver.nextPing()));
    }
    stop_ = true;
    thread_.join();
    OculusPings pings(folder / "dive.oculus");
    std::vector<Bytes> recorded;
    while (const auto ping = pings.next()) {
        EXPECT_GT(ping->time, 1.6e9) << "since the epoch";
        recorded.push_back(toBytes(ping->ping));
    }
    EXPECT_EQ(pings.diagnostic(), "");
    for (const Bytes& ping : echoes) EXPECT_THAT(recorded, ::testing::Contains(ping));
}

TEST_F(OculusTaskTest, AFullDiskEndsTheRecordingAndNotThePings) {
    const Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "dive.oculus");
    start({"device.record=" + (folder / "dive.oculus").string()});
    OculusDriver driver(port_);
    driver.send(toBytes({.rate = 2, .range = 10}));
    for (int i = 0; i < 10; ++i) EXPECT_GT(driver.nextPing().bin_count, 0);
    EXPECT_EQ(task().state(), framework::TaskState::RunTimeError);
    EXPECT_THAT(task().lastError(), HasSubstr("the recording ends here"));
    EXPECT_THAT(makeNotice("pings are not in"), HasSubstr("dive.oculus"));
    stop_ = true;
    thread_.join();
    EXPECT_EQ(task().state(), framework::TaskState::Stopped);
}

/** Other threads read the notices while the task counts: each has the whole reason. ThreadSanitizer sees a race. */
TEST_F(OculusTaskTest, NoticesOfAFullDiskHaveTheirReasonFromTheFirst) {
    const Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "dive.oculus");
    start({"device.record=" + (folder / "dive.oculus").string()});
    std::atomic<bool> done{false};
    std::atomic<int> found{0}, bare{0};
    std::thread reader([&] {
        while (!done) {
            const std::string notice = makeNotice("pings are not in");
            if (notice.empty()) continue;
            ++found;
            bare += notice.ends_with("dive.oculus: ") ? 1 : 0;
        }
    });
    OculusDriver driver(port_);
    driver.send(toBytes({.rate = 2, .range = 10}));
    for (int i = 0; i < 10; ++i) driver.nextPing();
    EXPECT_TRUE(test::becomesTrue([&] { return found > 0; }));
    done = true;
    reader.join();
    EXPECT_EQ(bare, 0);
}

TEST_F(OculusTaskTest, AClientThatDoesNotReadDelaysNoOther) {
    start();
    OculusDriver deaf(port_), driver(port_);
    OculusFire fire{.rate = 2, .flags = 0x4B, .range = 10};
    driver.send(toBytes(fire));
    deaf.send(toBytes(fire));
    uint32_t last = 0;
    for (int i = 0; i < 40; ++i) {  // of a megabyte each
        const uint32_t number = driver.nextPing().number;
        EXPECT_TRUE(i == 0 || number > last);
        last = number;
    }
    EXPECT_NO_THROW(deaf.nextPing()) << "it is still connected, and reads complete messages";
}

TEST_F(OculusTaskTest, DamagedBytesCostNoOtherMessage) {
    start();
    OculusDriver driver(port_);
    const Bytes fire = toBytes({.rate = 2, .range = 4});
    driver.send({'G', 'E', 'T', ' ', '/', 'S', 'O', 0, 1, 2});
    Bytes wrong = fire;
    write<uint32_t>(wrong, 10, 0xFFFFFFFF);
    driver.send(wrong);
    driver.send(fire);
    EXPECT_EQ(driver.nextPing().fire.range, 4);
}

TEST_F(OculusTaskTest, SurvivesAThousandDriversThatLeaveDuringAPing) {
    start();
    for (int i = 0; i < 1000; ++i) OculusDriver(port_).send(toBytes({.rate = 2, .range = 100}));
    const auto pings = [&] {
        try {
            OculusDriver driver(port_);
            driver.send(toBytes({.rate = 2, .range = 6}));
            for (int i = 0; i < 10; ++i)
                if (driver.nextPing().fire.range == 6) return true;
        } catch (const std::runtime_error&) {
            // closed at once while many others have not been closed yet
        }
        return false;
    };
    EXPECT_TRUE(test::becomesTrue(pings));
}

TEST_F(OculusTaskTest, RefusesImpossiblePropertiesWithTheirKeys) {
    const auto makeMessage = [&](const std::string& set) -> std::string {
        try {
            start({set});
        } catch (const types::ConfigError& error) {
            std::string all;
            for (const types::Diagnostic& diagnostic : error.diagnostics()) all += diagnostic.text() + "\n";
            return all;
        }
        return "";
    };
    EXPECT_THAT(makeMessage("device.address=nowhere"), HasSubstr("tasks.device.properties.address: is nowhere"));
    EXPECT_THAT(makeMessage("device.status_address=nowhere"), HasSubstr("properties.status_address: is nowhere"));
    for (const char* every : {"0.0.0.0", "'::'", "'::1'"})
        EXPECT_THAT(makeMessage(std::string("device.address=") + every), HasSubstr("device_address: is empty"))
            << every;
    for (const char* wrong : {"host", "192.168.2", "192.168.2.300", "0.0.0.0", "'::1'"})
        EXPECT_THAT(makeMessage(std::string("device.device_address=") + wrong), HasSubstr("must be an IPv4 address"))
            << wrong;
    EXPECT_THAT(makeMessage("device.record=/nowhere/a.oculus"),
                HasSubstr("properties.record: is /nowhere/a.oculus, which"));
    EXPECT_THAT(makeMessage("device.model=m900"), HasSubstr("m900"));
    EXPECT_THAT(makeMessage("device.gain_min_db=90"), HasSubstr("properties.gain_min_db: is above gain_max_db"));
    EXPECT_THAT(makeMessage("device.port=70000"), HasSubstr("properties.port: is 70000"));
}

}  // namespace
}  // namespace insonify::device
