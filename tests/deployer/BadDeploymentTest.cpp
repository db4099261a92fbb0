// Errors in deployments: exit code 2, a message with its place, and nothing started.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

struct BadDeployment {
    const char* name;
    std::string text;
    std::vector<std::string> messages;  ///< The output has all of them.
};

void PrintTo(const BadDeployment& tested, std::ostream* stream) { *stream << tested.name; }

BadDeployment edited(const char* name, const char* what, const char* with, std::vector<std::string> messages) {
    return {name, replaced(wall_deployment, what, with), std::move(messages)};
}

/** Adds a receiver between the sonar and the noise. */
std::string receiverBeforeNoise() {
    const std::string more =
        replaced(wall_deployment, "  noise:\n", "  receiver: {type: receiver::ReceiverTask}\n  noise:\n");
    return replaced(more, "{from: sonar.ping, to: noise.clean}",
                    "{from: sonar.ping, to: receiver.intensity}\n  - {from: receiver.ping, to: noise.clean}");
}

/** Returns the scene with these point targets. */
BadDeployment targets(const char* name, const std::string& list, std::vector<std::string> messages) {
    return edited(name, "{file: wall.gltf}", ("{file: wall.gltf, targets: [" + list + "]}").c_str(),
                  std::move(messages));
}

const BadDeployment cases[] = {
    {"Empty", "", {"wall.yml"}},
    edited("YamlSyntax", "tasks:\n", "tasks: [\n", {"wall.yml:"}),
    edited("UnknownTaskType", "noise::NoiseTask", "noise::NoisyTask", {"wall.yml:23:", "noise::NoisyTask"}),
    edited("UnknownTaskInConnection", "from: sonar.ping", "from: sonor.ping", {"wall.yml:32:", "sonor"}),
    edited("UnknownPort", "from: sonar.ping", "from: sonar.pong", {"wall.yml:32:", "pong"}),
    edited("UnknownProperty", "range: 20", "rnage: 20", {"wall.yml:16:7:", "tasks.sonar.properties", "rnage", "range"}),
    edited("UnknownTopLevelKey", "schedule: lockstep", "shedule: lockstep", {"wall.yml:1:1:", "shedule"}),
    edited("UnknownPolicy", "type: buffer", "type: bufer", {"wall.yml:33:", "bufer", "buffer"}),
    edited("WrongType", "beam_count: 16", "beam_count: many", {"wall.yml:17:", "beam_count", "many"}),
    edited("OutOfBounds", "range: 20", "range: -20", {"wall.yml:16:14:", "range", "-20"}),
    edited("NotANumber", "range: 20", "range: .nan", {"wall.yml:16:14:", "range"}),
    edited("PortTypesThatDiffer", "from: sonar.ping, to: noise.clean", "from: vehicle.pose, to: noise.clean",
           {"wall.yml:32:", "/base/samples/RigidBodyState", "/base/samples/Sonar"}),
    edited("UnconnectedRequiredInput", "  - {from: scene.snapshot, to: sonar.snapshot}\n", "",
           {"wall.yml:", "sonar", "snapshot"}),
    edited("TwoTasksOfOneName", "  noise:\n", "  sonar:\n", {"wall.yml:22:", "sonar"}),
    edited("KeyGivenTwice", "range: 20", "range: 20\n      range: 30", {"wall.yml:17:", "range"}),
    edited("WindFromNowhere", "range: 20", "range: 20\n      multipath: {surface: {wind_m_s: -3}}",
           {"wall.yml:17:", "multipath.surface.wind_m_s", "-3", "50"}),
    edited("WindOfNoNumber", "range: 20", "range: 20\n      multipath: {surface: {wind_m_s: .nan}}",
           {"wall.yml:17:", "multipath.surface.wind_m_s"}),
    edited("TooManyBounces", "range: 20", "range: 20\n      multipath: {bounces: 3}",
           {"wall.yml:17:", "multipath.bounces", "3", "2"}),
    edited("MultipathThatIsDrawn", "range: 20", "range: 20\n      visibility: gl\n      multipath: {}",
           {"wall.yml:17:", "visibility: is gl with multipath, which needs rays"}),
    edited("KeyOfTheReceiver", "range: 20", "range: 20\n      tvg: {log_coefficient: 40}",
           {"wall.yml:17:7: tasks.sonar.properties.tvg: is not a key here", "; receiver::ReceiverTask has it"}),
    targets("TargetWithoutAPlace", "{name: buoy, strength_db: 0}",
            {"wall.yml:11:", "tasks.scene.properties.targets[0].position: is missing", "or attached_to"}),
    targets("TargetWithoutAStrength", "{name: buoy, position: [1, 2, 3]}",
            {"wall.yml:11:", "tasks.scene.properties.targets[0].strength_db: is missing"}),
    targets("TargetWithoutAName", "{position: [1, 2, 3], strength_db: 0}",
            {"wall.yml:11:", "tasks.scene.properties.targets[0].name: is missing"}),
    targets("TargetTooStrong", "{name: buoy, position: [1, 2, 3], strength_db: 300}",
            {"wall.yml:11:", "targets[0].strength_db", "300", "200"}),
    targets("TargetNowhere", "{name: buoy, position: [1, 2, .inf], strength_db: 0}",
            {"wall.yml:11:", "targets[0].position"}),
    targets("TargetsOfOneName",
            "{name: buoy, position: [1, 2, 3], strength_db: 0}, {name: buoy, position: [0, 0, 0], strength_db: 0}",
            {"wall.yml:11:", "tasks.scene.properties.targets[1].name: is buoy, which targets[0] has"}),
    targets("TargetOnNoNode", "{name: buoy, attached_to: wal, strength_db: 0}",
            {"wall.yml:11:", "tasks.scene.properties.targets[0].attached_to: is wal, which is no node of the scene",
             "wall"}),
    targets("TargetOfUnknownKey", "{name: buoy, positon: [1, 2, 3], strength_db: 0}",
            {"wall.yml:11:", "targets[0]", "positon", "position"}),
    edited("RingDownWithoutADecay", "range: 20",
           "range: 20\n      pulse: {bandwidth_khz: 10, ring_down: {level_db: 0}}",
           {"wall.yml:17:", "tasks.sonar.properties.pulse.ring_down.decay_db_per_m: is missing"}),
    edited("RingDownWithoutALevel", "range: 20",
           "range: 20\n      pulse: {bandwidth_khz: 10, ring_down: {decay_db_per_m: 20}}",
           {"wall.yml:17:", "tasks.sonar.properties.pulse.ring_down.level_db: is missing"}),
    edited("RingDownWithoutAPulse", "range: 20",
           "range: 20\n      pulse: {ring_down: {level_db: 0, decay_db_per_m: 20}}",
           {"wall.yml:17:", "tasks.sonar.properties.pulse: has no length; give bandwidth_khz"}),
    {"ReceiverBeforeTheNoise",
     receiverBeforeNoise(),
     {"wall.yml:34:5: connections[3]: receiver.ping gives what a receiver has amplified, noise.clean takes intensities "
      "that reach a receiver"}},
    edited("SurfaceAbove20Decibels", "{file: wall.gltf}", "{file: wall.gltf, materials: {wall: {lambert_db: 21}}}",
           {"wall.yml:11:", "tasks.scene.properties.materials.wall.lambert_db: is 21 dB; ", "-200 to 20"}),
    edited("WallOfGramsPerCubicCentimetre", "{file: wall.gltf}",
           "{file: wall.gltf, materials: {wall: {shell: {thickness_mm: 2, density: 7.85, sound_speed: 5900}}}}",
           {"wall.yml:11:", "materials.wall.shell.density: is 7.85 kg/m^3; ", "25"}),
    edited("WaterSurfaceBeyondTheWorld", "{file: wall.gltf}", "{file: wall.gltf, water_surface: 1.0e+300}",
           {"wall.yml:11:", "tasks.scene.properties.water_surface: is 1e+300 m; ", "100000"}),
    edited("SonarFarFromItsVehicle", "{file: wall.gltf}", "{file: wall.gltf, mount: {position: [0, 1.0e+300, 0]}}",
           {"wall.yml:11:", "tasks.scene.properties.mount.position[1]: is 1e+300 m; ", "100000"}),
    edited("SpeedInKilometresPerSecond", "range: 20", "range: 20\n      speed_of_sound: 1.5",
           {"wall.yml:17:", "tasks.sonar.properties.speed_of_sound: is 1.5 m/s; ", "100", "20000"}),
    edited("BandBelowZero", "range: 20", "range: 20\n      frequency_khz: 10\n      pulse: {bandwidth_khz: 30}",
           {"wall.yml:18:", "tasks.sonar.properties.pulse.bandwidth_khz: is 30 kHz; a band about 10 kHz may have 20"}),
    edited("AbsorptionOfNoFrequency", "range: 20", "range: 20\n      absorption: {frequency_khz: 0}",
           {"wall.yml:17:", "tasks.sonar.properties.absorption.frequency_khz: is 0 kHz; "}),
    edited("AbsorptionThatAmplifies", "range: 20", "range: 20\n      absorption: {db_per_m: -0.1}",
           {"wall.yml:17:", "tasks.sonar.properties.absorption.db_per_m: is -0.1 dB/m; "}),
    edited("NoiseOfABandBelowZero", "law: rayleigh}",
           "law: rayleigh}, ambient: {wind_m_s: 5, frequency_khz: 20, bandwidth_khz: 50, source_level_db: 200}",
           {"wall.yml:", "tasks.noise.properties.ambient.bandwidth_khz: is 50 kHz; a band about 20 kHz may have 40"}),
    edited("SourceAbove300Decibels", "law: rayleigh}",
           "law: rayleigh}, ambient: {wind_m_s: 5, bandwidth_khz: 50, source_level_db: 390}",
           {"wall.yml:", "tasks.noise.properties.ambient.source_level_db: is 390 dB re 1 uPa m; ", "300"}),
    edited("LibraryMissing", "tasks:\n", "libraries: [here.so, /nowhere/mine.so]\ntasks:\n",
           {"wall.yml:2:13: libraries[0]: is here.so: ", "wall.yml:2:22: libraries[1]: is /nowhere/mine.so: "}),
    edited("TrajectoryFileMissing",
           "waypoints: [{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}]", "file: nowhere.csv",
           {"nowhere.csv"}),
};

class BadDeploymentTest : public testing::TestWithParam<BadDeployment> {};

}  // namespace

TEST_P(BadDeploymentTest, IsRefusedWithItsPlaceBeforeAnythingStarts) {
    const WallFolder folder(GetParam().text);
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"run", "wall.yml", "--out", "out"}, {"check", "wall.yml"}}) {
        const Outcome outcome = callInsonify(folder, command);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        for (const std::string& message : GetParam().messages) EXPECT_THAT(outcome.err, HasSubstr(message));
        EXPECT_EQ(outcome.out, "");
    }
    EXPECT_FALSE(fs::exists(folder / "out"));
}

INSTANTIATE_TEST_SUITE_P(All, BadDeploymentTest, testing::ValuesIn(cases),
                         [](const auto& tested) { return tested.param.name; });

TEST(BadDeploymentsTest, NamesAMissingFile) {
    const TestFolder folder;
    EXPECT_THAT(callInsonify(folder, {"run", "nowhere.yml"}), isRefused(HasSubstr("nowhere.yml")));
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(BadDeploymentsTest, RefusesAFolderWithoutADeployment) {
    const TestFolder folder;
    EXPECT_EQ(callInsonify(folder, {"run", "."}).code, 2);
}

TEST(BadDeploymentsTest, ReportsAllErrors) {
    std::string text = replaced(wall_deployment, "range: 20", "range: -20");
    text = replaced(text, "bin_count: 50", "bin_count: few");
    text = replaced(text, "to: noise.clean", "to: noise.dirty");
    const WallFolder folder(text);
    const Outcome outcome = folder.run();
    EXPECT_EQ(outcome.code, 2);
    for (const char* place : {"wall.yml:16:", "wall.yml:18:", "wall.yml:32:"})
        EXPECT_THAT(outcome.err, HasSubstr(place));
}

TEST(BadDeploymentsTest, ReplayRefusesAFileThatIsNotALog) {
    const WallFolder folder;
    writeFile(folder / "no.0.log", "this is no log at all, but it is longer than a header of one would be");
    EXPECT_THAT(callInsonify(folder, {"replay", "no.0.log", "wall.yml", "--out", "out"}),
                isRefused(HasSubstr("no.0.log")));
    EXPECT_FALSE(fs::exists(folder / "out"));
}
