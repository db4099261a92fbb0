// No operator new on the sonars' threads after the first pings, even when more is in view later.
#include <gmock/gmock.h>

#include "components/sonar/tasks/AltimeterTask.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "components/sonar/tasks/ProfilerTask.hpp"
#include "components/sonar/tasks/ScanningSonarTask.hpp"
#include "components/sonar/tasks/SideScanTask.hpp"
#include "components/sonar/tasks/Sonar3dTask.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::sonar {
namespace {

constexpr size_t warm_up = 1;  // ping

/** A bottom and ten balls in a row to port; the third follows a pose. */
types::GeometryPtr balls() {
    std::vector<types::Mesh> meshes = {test::ground(-3)};
    std::vector<glm::dvec3> positions = {glm::dvec3(0)};
    for (int i = 0; i < 10; ++i) {
        meshes.push_back(test::sphere(0.5f, 16));
        positions.emplace_back(i, 5, 0);
    }
    return test::makeScene(std::move(meshes), -10, positions);
}

/** Returns snapshots of a sonar that looks to starboard first, and then turns to port, where the objects are. */
std::vector<types::SnapshotPtr> turning() {
    const types::GeometryPtr geometry = balls();
    std::vector<types::SnapshotPtr> snapshots;
    for (int i = 0; i < 40; ++i) {
        types::Snapshot snapshot = test::makeSnapshot(geometry, {0.1 * i, 0, 0}, -1.5 + 0.1 * i);
        snapshot.time = types::Time::fromSeconds(1 + 0.1 * i);
        glm::dmat4 place(1);
        place[3] = glm::dvec4(2, 4, 0.01 * i, 1);
        snapshot.moved = {{3, place}};
        snapshot.targets = {{{2, 4, 0.8}, -20}, {{5, -3, 0}, -20}};
        snapshots.push_back(std::make_shared<types::Snapshot>(snapshot));
    }
    return snapshots;
}

/** Returns the number of pings that allocate among `count` pings of equal snapshots. The same number of pings before
 *  lets the quality settle. */
int pingsThatAllocate(const SonarConfig& config, int count) {
    SonarTask task("sonar");
    test::Writer<types::SnapshotPtr> in;
    test::Reader<types::SonarPtr> out;
    in.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(4));
    task.ping.connectTo(out.port, framework::ConnPolicy::data());
    task.config.set(config);
    if (!task.configure() || !task.start()) return count;
    const types::SnapshotPtr snapshot = turning().back();
    int allocating = 0;
    for (int i = 0; i < 2 * count; ++i) {
        const auto allocations = test::allocationsOn(task, [&] {
            in.port.write(snapshot);
            task.update();
        });
        allocating += i >= count && !allocations.empty();
    }
    return allocating;
}

enum class Truth { NotRead, Received };

/** A reader of a task's other outputs. */
template <class Task>
struct Second {
    explicit Second(Task&) {}
};
template <class Task>
requires requires(Task& task) { task.soundings; }
struct Second<Task> {
    explicit Second(Task& task) {
        task.soundings.connectTo(reader.port, framework::ConnPolicy::data());
        task.detections.connectTo(beams.port, framework::ConnPolicy::data());
    }
    test::Reader<types::PointCloudPtr> reader;
    test::Reader<types::SonarDetectionsPtr> beams;
};

template <class Task, class Config>
void expectNoAllocation(const Config& config, Truth truth = Truth::NotRead) {
    Task task("sonar");
    const Second<Task> second(task);
    test::Writer<types::SnapshotPtr> in;
    test::Reader<types::SonarPtr> out;
    test::Reader<types::SonarTruthPtr> truths{"truths"};
    test::Reader<types::SonarReturnsPtr> returns{"returns"};
    if (truth == Truth::Received) {
        task.truth.connectTo(truths.port, framework::ConnPolicy::data());
        task.returns.connectTo(returns.port, framework::ConnPolicy::data());
    }
    in.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(4));
    task.ping.connectTo(out.port, framework::ConnPolicy::data());
    task.config.set(config);
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const std::vector<types::SnapshotPtr> snapshots = turning();
    const auto cycle = [&](const types::SnapshotPtr& snapshot) {
        in.port.write(snapshot);
        task.update();
    };
    for (size_t i = 0; i < warm_up; ++i) cycle(snapshots[i]);
    const auto allocations = test::allocationsOn(task, [&] {
        for (size_t i = warm_up; i < snapshots.size(); ++i) cycle(snapshots[i]);
    });
    EXPECT_THAT(allocations, testing::IsEmpty());
    EXPECT_EQ(task.ping.written(), snapshots.size()) << task.lastError();
    EXPECT_EQ(task.truth.written(), truth == Truth::Received ? snapshots.size() : 0);
}

SonarConfig fan() {
    SonarConfig config;
    config.range = 20;
    config.bin_count = 100;
    config.beam_count = 64;
    config.quality.rows = 64;
    config.device = "software";
    return config;
}

TEST(AllocationTest, AForwardLookingSonarAllocatesNothingAfterItsFirstPings) { expectNoAllocation<SonarTask>(fan()); }

TEST(AllocationTest, ARayTracedSonarAllocatesNothingAfterItsFirstPings) {
    SonarConfig config = fan();
    config.device.clear();
    config.visibility = Visibility::Cpu;
    expectNoAllocation<SonarTask>(config);
}

TEST(AllocationTest, PatternsAndAPulseAllocateNothing) {
    SonarConfig config = fan();
    acoustics::BeamLaw law;
    law.width_deg = 3;
    config.beam_pattern.emplace().receive.azimuth = law;
    law.width_deg = 20;
    config.beam_pattern->transmit.elevation = law;
    config.pulse.emplace().bandwidth_khz = 1;
    for (const Visibility visibility : {Visibility::Gl, Visibility::Cpu}) {
        config.visibility = visibility;
        config.device = visibility == Visibility::Gl ? "software" : "";
        expectNoAllocation<SonarTask>(config);
    }
}

TEST(AllocationTest, TruthAllocatesNothing) {
    SonarConfig config = fan();
    expectNoAllocation<SonarTask>(config, Truth::Received);
    config.deposit = Deposit::Gpu;
    expectNoAllocation<SonarTask>(config, Truth::Received);
    config.visibility = Visibility::Cpu;
    config.device.clear();
    expectNoAllocation<SonarTask>(config, Truth::Received);
    acoustics::BeamLaw law;
    law.width_deg = 3;
    config.beam_pattern.emplace().receive.azimuth = law;
    expectNoAllocation<SonarTask>(config, Truth::Received);
    config.volume = {{{}, {}, -70}};
    expectNoAllocation<SonarTask>(config, Truth::Received);
    config.visibility = Visibility::Gl;
    config.device = "software";
    expectNoAllocation<SonarTask>(config, Truth::Received);
}

TEST(AllocationTest, TheDepositOnTheDeviceAllocatesNothing) {
    SonarConfig config = fan();
    config.deposit = Deposit::Gpu;
    expectNoAllocation<SonarTask>(config);
}

TEST(AllocationTest, AllEffectsTogetherAllocateNothing) {
    SonarConfig config = fan();
    config.water.emplace();
    config.absorption.emplace().frequency_khz = 700;
    config.beam_geometry = BeamGeometry::Conical;
    expectNoAllocation<SonarTask>(config);
}

TEST(AllocationTest, AQualityControllerAllocatesOnlyInMeasuredPings) {
    SonarConfig config = fan();
    config.quality = {};
    const int allocating = pingsThatAllocate(config, 40);
    EXPECT_GE(allocating, 9) << "about every fourth is rendered coarser as well";
    EXPECT_LE(allocating, 12);
}

TEST(AllocationTest, ThePublishedModelAllocatesNothing) {
    SonarConfig config = fan();
    config.model = Model::Cerqueira2017;
    expectNoAllocation<SonarTask>(config);
}

TEST(AllocationTest, OtherKindsOfSonarAllocateNothing) {
    ProfilerConfig profiler;
    profiler.sonar = fan();
    expectNoAllocation<ProfilerTask>(profiler);
    Sonar3dConfig grid;
    grid.sonar.bin_count = 100;
    grid.horizontal.beam_count = 16;
    grid.vertical.beam_count = 8;
    expectNoAllocation<Sonar3dTask>(grid);
    SideScanConfig side_scan;
    side_scan.sonar.bin_count = 100;
    side_scan.sonar.quality.columns_per_beam = 64;
    expectNoAllocation<SideScanTask>(side_scan);
    AltimeterConfig altimeter;
    altimeter.sonar.bin_count = 100;
    altimeter.sonar.quality.rows = 64;
    expectNoAllocation<AltimeterTask>(altimeter);
}

TEST(AllocationTest, AScanningSonarAllocatesNothingAfterItsFirstPings) {
    ScanningSonarConfig config;
    config.sonar.range = 20;
    config.sonar.bin_count = 100;
    config.sonar.quality.rows = 64;
    config.sonar.device = "software";
    expectNoAllocation<ScanningSonarTask>(config);
}

}  // namespace
}  // namespace insonify::sonar
