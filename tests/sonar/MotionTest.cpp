// Motion during the travel of sound, compared with exact solutions of the two-way path (ACOUSTICS.md 5.20).
#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <random>

#include "components/sonar/rays/RayPaths.hpp"
#include "components/sonar/rays/RayVisibility.hpp"
#include "components/sonar/renderer/PlanReport.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/surfaces/Motion.hpp"
#include "components/sonar/tasks/ScanningSonarTask.hpp"
#include "tests/sonar/MovingFan.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/TaskBench.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using test::makePing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using types::radians;

constexpr double c = 1500;

/** A plate of 1 m across the x axis about its object's origin. */
types::Mesh facingPlate(float size = 1) { return test::quad({0, -size / 2, -size / 2}, {0, size, 0}, {0, 0, size}); }

struct Loudest {
    double range;
    double bearing;  ///< [rad]
    float intensity;
};

Loudest findLoudest(const types::Sonar& ping, double bin_width = 0.1) {
    const auto at = static_cast<size_t>(std::ranges::max_element(ping.bins) - ping.bins.begin());
    return {bin_width * (static_cast<double>(at % ping.bin_count) + 0.5), ping.bearings[at / ping.bin_count].rad,
            ping.bins[at]};
}

types::Snapshot movingSonar(const types::GeometryPtr& geometry, glm::dvec3 velocity, glm::dvec3 turn = {}) {
    types::Snapshot snapshot = test::makeSnapshot(geometry);
    snapshot.sonar.velocity = velocity;
    snapshot.sonar.angular_velocity = turn;
    return snapshot;
}

/** Returns the second ping of an object that has moved for 0.5 s, by its velocity, to its place. */
types::Sonar pingOfMoving(const SonarConfig& config, const types::GeometryPtr& geometry, glm::dvec3 place,
                          glm::dvec3 velocity, glm::dvec3 sonar_velocity = {}) {
    SonarRenderer renderer(config, geometry);
    types::Sonar ping;
    for (const double ago : {0.5, 0.0}) {
        types::Snapshot snapshot = test::makeSnapshot(geometry, -ago * sonar_velocity);
        snapshot.time = types::Time::fromSeconds(10 - ago);
        glm::dmat4 there(1);
        there[3] = glm::dvec4(place - ago * velocity, 1);
        snapshot.moved = {{0, there}};
        renderer.render(snapshot, ping);
    }
    return ping;
}

/** Returns the slant range and the direction of a point's echo: |p(t1) - s(0)| = c t1, |s(t2) - p(t1)| = c (t2 - t1),
 *  solved by bisection. */
struct ReceivedAt {
    double range;
    glm::dvec3 direction;
};
double root(const auto& f, double low, double high) {
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (f(middle) < 0 ? low : high) = middle;
    }
    return low;
}
ReceivedAt exactly(glm::dvec3 point, glm::dvec3 point_velocity, glm::dvec3 sonar_velocity) {
    const double out =
        root([&](double t) { return c * t - glm::length(point + point_velocity * t); }, 0, 4 * glm::length(point) / c);
    const glm::dvec3 met = point + point_velocity * out;
    const double back = root([&](double t) { return c * (t - out) - glm::length(sonar_velocity * t - met); }, out,
                             8 * glm::length(point) / c);
    return {c * back / 2, glm::normalize(met - sonar_velocity * back)};
}

TEST(MotionTest, APointEchoesAtTheRangeOfTheExactTwoWayPath) {
    struct Case {
        glm::dvec3 place, velocity, sonar;
    };
    for (const Case& moving :
         {Case{{200, 5, 0}, {-20, 0, 0}, {}}, Case{{200, 5, 0}, {}, {15, 0, 0}},
          Case{{250, -40, 3}, {10, 12, 0}, {25, -3, 0.5}}, Case{{80, 10, 0}, {30, 0, 0}, {-20, 0, 0}}}) {
        const types::Sonar ping =
            pingOfMoving(movingFan(), test::makeScene({facingPlate()}), moving.place, moving.velocity, moving.sonar);
        const ReceivedAt exact = exactly(moving.place, moving.velocity, moving.sonar);
        const Loudest loudest = findLoudest(ping);
        EXPECT_NEAR(loudest.range, exact.range, 0.11);
        EXPECT_NEAR(loudest.bearing, std::atan2(exact.direction.y, exact.direction.x), radians(0.6));
        EXPECT_GT(std::abs(exact.range - glm::length(moving.place)), 1) << "where it was, stop and hop does not pass";
    }
}

TEST(MotionTest, AWallAheadOfAMovingSonarEchoesNearerInEachBeam) {
    const auto geometry = test::makeScene({test::wall(200)});
    const glm::dvec3 velocity{25, 8, 0};
    SonarRenderer renderer(movingFan(), geometry);
    types::Sonar ping;
    types::SonarTruth truth;
    renderer.setTruth(ping, &truth);
    renderer.render(movingSonar(geometry, velocity), ping);
    for (size_t beam = 0; beam < 40; beam += 3) {
        // The first echo of the beam is at its edge nearer to the wall's foot, at the range where the arriving ray has
        // met the wall.
        const double edge = std::abs(ping.bearings[beam].rad) - radians(0.5);
        const double bearing = std::copysign(edge, ping.bearings[beam].rad);
        const glm::dvec3 ray(std::cos(bearing), std::sin(bearing), 0);
        const double range = root(
            [&](double r) {
                const glm::dvec3 there = velocity * (2 * r / c);
                const double leg = (4 * r * r - glm::dot(there, there)) / (4 * r + 2 * glm::dot(ray, there));
                return (there + leg * ray).x - 200;
            },
            100, 400);
        const float* bins = &ping.bins[beam * ping.bin_count];
        const auto first = std::find_if(bins, bins + ping.bin_count, [](float x) { return x > 0; }) - bins;
        EXPECT_NEAR(0.1 * static_cast<double>(first), range, 0.2) << beam;
        EXPECT_GT(std::abs(range - 200 / ray.x), 2) << "ranges without motion do not pass";
    }
}

TEST(MotionTest, AFloorHasTheSameEnergyUnderAMovingSonarAndAtRest) {
    const auto geometry = test::makeScene({test::ground(-10)});
    SonarConfig config = movingFan();
    config.beam_height_deg = 40;
    const auto sumEnergy = [&](glm::dvec3 velocity) {
        double sum = 0;
        const types::Sonar ping = makePing(config, movingSonar(geometry, velocity));
        for (size_t i = 0; i < ping.bins.size(); ++i) sum += ping.bins[i];
        return sum;
    };
    const double rest = sumEnergy({});
    EXPECT_GT(rest, 0);
    EXPECT_NEAR(sumEnergy({15, 0, 0}) / rest, 1, 4 * 15 / c);
}

/** The range at which sound along a ray meets a plate of 2 m that turns about its centre [m]: at each range the plate
 * is placed as it is when sound is there. Infinite beyond its edges, NaN within 0.15 m of them. */
double rangeOfTurning(const glm::dvec3& direction, const glm::dmat4& place, const glm::dvec3& turn) {
    const double angle = glm::length(turn);
    const auto inPlate = [&](double range) {
        const glm::dquat back = glm::angleAxis(-angle * range / c, turn / angle);
        const glm::dvec3 centre(place[3]);
        return glm::transpose(glm::dmat3(place)) * (back * (direction * range - centre));
    };
    const double step = 0.01, middle = glm::length(glm::dvec3(place[3]));
    for (double range = middle - 2; range < middle + 2; range += step) {
        const glm::dvec3 here = inPlate(range);
        if (here.x * inPlate(range + step).x > 0) continue;
        const double aside = std::max(std::abs(here.y), std::abs(here.z));
        if (std::abs(aside - 1) < 0.15) return std::numeric_limits<double>::quiet_NaN();
        if (aside < 1) return range;
    }
    return std::numeric_limits<double>::infinity();
}

TEST(MotionTest, RaysMeetAPlateThatTurnsFast) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto geometry = test::makeScene({facingPlate(2)});
    const RenderPlan plan = makeRenderPlan(movingFan(), *geometry);
    int met = 0, missed = 0;
    for (int trial = 0; trial < 100; ++trial) {
        types::Snapshot snapshot = test::makeSnapshot(geometry);
        const double distance = 150 + 100 * number(random);
        const glm::dvec3 turn(1.5 * number(random), 1.5 * number(random), 1.5 * number(random));
        glm::dmat4 place = glm::mat4_cast(glm::angleAxis(0.4 * number(random), glm::dvec3(0, 0, 1)) *
                                          glm::angleAxis(0.4 * number(random), glm::dvec3(0, 1, 0)));
        glm::dmat4 rate(0);
        for (int axis = 0; axis < 3; ++axis) rate[axis] = glm::dvec4(glm::cross(turn, glm::dvec3(place[axis])), 0);
        place[3] = glm::dvec4(distance, 0.1 * distance * number(random), 0.05 * distance * number(random), 1);
        snapshot.moved = {{0, place, rate}};
        RayPaths paths(plan, *geometry);
        paths.place(snapshot);
        RayVisibility visibility(*geometry);
        visibility.place(snapshot);
        TileRays rays{};
        TileHits hits{};
        rays.active = (1u << tile_samples) - 1;
        for (int i = 0; i < tile_samples; ++i) {
            const glm::dvec3 at(place[3].x, place[3].y + 1.6 * number(random), place[3].z + 1.6 * number(random));
            const glm::dvec3 direction = glm::normalize(at);
            rays.x[i] = static_cast<float>(direction.x);
            rays.y[i] = static_cast<float>(direction.y);
            rays.z[i] = static_cast<float>(direction.z);
        }
        visibility.traceAlong(paths, rays, hits);
        for (int i = 0; i < tile_samples; ++i) {
            const glm::dvec3 direction(rays.x[i], rays.y[i], rays.z[i]);
            const double range = rangeOfTurning(glm::normalize(direction), place, turn);
            if (std::isnan(range)) continue;
            const bool is_met = hits.command[i] != TileHits::nothing;
            ASSERT_EQ(is_met, std::isfinite(range)) << trial << " " << i;
            ++(is_met ? met : missed);
            if (!is_met) continue;
            EXPECT_NEAR(static_cast<double>(hits.range[i]), range, 0.1) << trial;
        }
    }
    EXPECT_GT(met, 200);
    EXPECT_GT(missed, 100);
}

TEST(MotionTest, APointTargetEchoesAtTheRangeOfTheExactPath) {
    const auto nothing = test::openWater();
    SonarRenderer renderer(movingFan(), nothing);
    types::Sonar ping;
    const glm::dvec3 place(240, 30, 2), velocity(-15, 4, 0), sonar(20, 1, 0);
    for (const double ago : {0.5, 0.0}) {
        types::Snapshot snapshot = test::makeSnapshot(nothing, -ago * sonar);
        snapshot.time = types::Time::fromSeconds(10 - ago);
        snapshot.targets = {{place - ago * velocity, 0}};
        renderer.render(snapshot, ping);
    }
    const ReceivedAt exact = exactly(place, velocity, sonar);
    EXPECT_NEAR(findLoudest(ping).range, exact.range, 0.051) << "its own bin";
    EXPECT_NEAR(findLoudest(ping).bearing, std::atan2(exact.direction.y, exact.direction.x), radians(0.51));
    EXPECT_GT(std::abs(exact.range - glm::length(place)), 4);
}

TEST(MotionTest, ARotatingReceiverGetsAnEchoAtItsBearingOnArrival) {
    const double turn = radians(30), flight = 2 * 200 / c, bearing = radians(5);
    const auto geometry = test::makeScene({facingPlate()}, 0, {{200 * std::cos(bearing), 200 * std::sin(bearing), 0}});
    const Loudest loudest = findLoudest(makePing(movingFan(), movingSonar(geometry, {}, {0, 0, turn})));
    EXPECT_NEAR(loudest.range, 200, 0.11);
    EXPECT_NEAR(loudest.bearing, bearing - turn * flight, radians(0.6));
    EXPECT_GT(turn * flight, radians(7)) << "where it was is seven beams off";
}

TEST(MotionTest, ASonarOfOneBeamShiftsByHalfBecauseItAlsoTransmitsWithTheBeam) {
    const double turn = radians(45), flight = 2 * 200 / c;
    SonarConfig one = movingFan();
    one.beam_count = 1;
    one.field_of_view_deg = 2;
    const auto receivedAt = [&](double bearing) {
        const auto geometry =
            test::makeScene({facingPlate(3)}, 0, {{200 * std::cos(bearing), 200 * std::sin(bearing), 0}});
        return findLoudest(makePing(one, movingSonar(geometry, {}, {0, 0, turn}))).intensity;
    };
    EXPECT_GT(receivedAt(turn * flight / 2), 0);
    EXPECT_EQ(receivedAt(0), 0);
    EXPECT_EQ(receivedAt(turn * flight), 0);
}

TEST(MotionTest, AChirpShiftsMovingTargetsByRangeDopplerCoupling) {
    SonarConfig config = movingFan();
    config.frequency_khz = 300;
    config.pulse.emplace().bandwidth_khz = 5;
    config.pulse->chirp_us = 20000;
    const double seconds = 0.02 * 300e3 / 5e3, speed = 2;  // f T / B = 1.2 s
    EXPECT_DOUBLE_EQ(dopplerCoupling(config), seconds);
    const auto geometry = test::makeScene({facingPlate()});
    for (const double away : {speed, -speed}) {
        const ReceivedAt exact = exactly({150, 1, 0}, {away, 0, 0}, {});
        EXPECT_NEAR(findLoudest(pingOfMoving(config, geometry, {150, 1, 0}, {away, 0, 0})).range,
                    exact.range + away * seconds, 0.11);
    }
    config.pulse->chirp_us.reset();
    const double plain = findLoudest(pingOfMoving(config, geometry, {150, 1, 0}, {speed, 0, 0})).range;
    EXPECT_NEAR(plain, exactly({150, 1, 0}, {speed, 0, 0}, {}).range, 0.11) << "no chirp, no shift";
}

TEST(MotionTest, ASonarAtRestAndOneThatIsSlowChangeNoBit) {
    const auto geometry = test::makeScene({test::ground(-10), facingPlate(5)}, -10, {{}, {100, 3, 0}});
    SonarConfig without = movingFan();
    without.motion_in_ping = false;
    const types::Sonar absent = makePing(without, movingSonar(geometry, {}));
    EXPECT_GT(findLoudest(absent).intensity, 0);
    const double slow = 0.99 * motionBound(movingFan(), makeBinGrid(movingFan())).speed;
    EXPECT_NEAR(slow, 0.99 * 0.1 * c / (4 * 300), 1e-9);
    for (const glm::dvec3& velocity : {glm::dvec3(0), glm::dvec3(slow, 0, 0), glm::dvec3(types::Pose::unknown)})
        EXPECT_EQ(makePing(movingFan(), movingSonar(geometry, velocity)).bins, absent.bins);
    EXPECT_NE(makePing(movingFan(), movingSonar(geometry, {slow / 0.9, 0, 0})).bins, absent.bins);
}

TEST(MotionTest, ThePlanStatesTheMinSpeedForMotion) {
    const auto geometry = test::makeScene({test::ground(-10)});
    const RenderPlan plan = makeRenderPlan(movingFan(), *geometry);
    EXPECT_TRUE(plan.hasFeature("motion_in_ping"));
    EXPECT_FALSE(plan.findOmitted("motion within a ping"));
    EXPECT_THAT(report(plan, *geometry).notices,
                testing::Contains(HasSubstr("motion within a ping is simulated from 0.12 m/s or 1.2 deg/s")));
    SonarConfig without = movingFan();
    without.motion_in_ping = false;
    EXPECT_TRUE(makeRenderPlan(without, *geometry).findOmitted("motion within a ping"));
}

TEST(MotionTest, ReportsMissingRequirements) {
    EXPECT_THAT(test::countRefusals(movingFan()), testing::IsEmpty());
    SonarConfig config = movingFan();
    config.visibility = Visibility::Auto;
    EXPECT_TRUE(config.tracesRays()) << "on any device";
    config.visibility = Visibility::Gl;
    config.device = "software";
    EXPECT_THAT(test::countRefusals(config),
                Contains(HasSubstr("visibility: is gl with motion_in_ping, which needs rays")));
    config = movingFan();
    config.pulse.emplace().bandwidth_khz = 50;
    config.pulse->chirp_us = 1000;
    EXPECT_THAT(test::countRefusals(config),
                Contains(HasSubstr("pulse.chirp_us: is given without motion_in_ping: true and frequency_khz")));
    acoustics::PulseConfig tone;
    tone.duration_us = tone.chirp_us = 100;
    EXPECT_THAT(test::countRefusals(tone), ElementsAre(StartsWith("chirp_us: ")));
    ScanningSonarConfig head;
    head.head.sweeps = true;
    EXPECT_THAT(test::countRefusals(head), ElementsAre(StartsWith("head.sweeps: ")));
}

TEST(MotionTest, AJumpIsAPlacementAndNotAMotion) {
    const auto geometry = test::makeScene({facingPlate()});
    Motion motion(*geometry, 150);
    types::Snapshot snapshot = test::makeSnapshot(geometry);
    const auto putAt = [&](double x) {
        glm::dmat4 place(1);
        place[3] = {x, 0, 0, 1};
        snapshot.moved = {{0, place}};
        snapshot.targets = {{{x, 0, 0}, 0}};
        snapshot.time.microseconds += 100'000;
        motion.follow(snapshot);
    };
    putAt(0);
    putAt(1);
    EXPECT_NEAR(motion.fastest(), 10, 1e-6);
    EXPECT_NE(motion.drift(0), nullptr);
    putAt(100);
    EXPECT_EQ(motion.fastest(), 0);
    EXPECT_EQ(motion.drift(0), nullptr);
    EXPECT_EQ(motion.targetVelocity(0), glm::dvec3(0));
}

TEST(MotionTest, AJumpingSonarHasOnlyTheVelocityOfItsPose) {
    const auto geometry = test::makeScene({facingPlate()});
    Motion motion(*geometry, 150);
    types::Snapshot snapshot = test::makeSnapshot(geometry);
    const auto putAt = [&](double x, double yaw) {
        snapshot.sonar.position.x = x;
        snapshot.sonar.orientation = glm::angleAxis(yaw, glm::dvec3(0, 0, 1));
        snapshot.time.microseconds += 100'000;
        motion.follow(snapshot);
    };
    putAt(0, 0);
    putAt(14, 0.1);
    EXPECT_NEAR(motion.velocity().x, 140, 1e-6);
    EXPECT_NEAR(motion.turn().z, 1, 1e-6);
    for (const double x : {1e3, 1e9, 1e30, 1e300, -1e300}) {
        putAt(x, x > 1e9 ? 0.5 : 1.5);
        EXPECT_EQ(motion.velocity(), glm::dvec3(0)) << x;
        EXPECT_EQ(motion.turn(), glm::dvec3(0)) << x << ": what is put elsewhere has not turned there";
    }
    snapshot.sonar.velocity = {3, 0, 0};
    snapshot.sonar.angular_velocity = {0, 0, 0.2};
    putAt(0, 0);
    EXPECT_EQ(motion.velocity(), glm::dvec3(3, 0, 0));
    EXPECT_NEAR(motion.turn().z, 0.2, 1e-12);
    snapshot.sonar.velocity.x = 1e4;
    putAt(1, 0);
    EXPECT_NEAR(motion.velocity().x, 10, 1e-6) << "no vehicle is so fast: that of the two places";
}

TEST(MotionTest, VelocitiesAreFromThePoseOrElseFromTwoSnapshots) {
    const auto geometry = test::makeScene({facingPlate(), facingPlate()});
    Motion motion(*geometry, 150);
    types::Snapshot snapshot = test::makeSnapshot(geometry, {1e6, 2, 3}, 0.2);
    glm::dmat4 place(1);
    place[3] = {1e6, 10, 0, 1};
    snapshot.moved = {{1, place}};
    snapshot.targets = {{{5, 0, 0}, 0}};
    motion.follow(snapshot);
    EXPECT_EQ(motion.velocity(), glm::dvec3(0));
    EXPECT_EQ(motion.fastest(), 0);
    snapshot.time.microseconds += 500'000;
    snapshot.sonar.position += glm::dvec3(1, -2, 0.5);
    snapshot.sonar.orientation = glm::angleAxis(0.3, glm::dvec3(0, 0, 1));
    const glm::dquat spun = glm::angleAxis(0.01, glm::dvec3(0, 0, 1));
    snapshot.moved[0].world_from_object = glm::mat4_cast(spun);
    snapshot.moved[0].world_from_object[3] = {1e6 + 3, 10, 0, 1};
    snapshot.targets[0].position.y = 4;
    for (int again = 0; again < 2; ++again) {  // a ping that is rendered twice
        motion.follow(snapshot);
        EXPECT_NEAR(glm::distance(motion.velocity(), {2, -4, 1}), 0, 1e-9);
        EXPECT_NEAR(glm::distance(motion.turn(), {0, 0, 0.2}), 0, 1e-9);
        EXPECT_NEAR(glm::distance(motion.targetVelocity(0), {0, 8, 0}), 0, 1e-9);
        EXPECT_FALSE(motion.drift(0));
        ASSERT_TRUE(motion.drift(1));
        const glm::dvec3 origin =
            glm::conjugate(snapshot.sonar.orientation) * (glm::dvec3(1e6 + 3, 10, 0) - snapshot.sonar.position);
        const glm::dvec3 seen = snapshot.sonar.orientation * motion.drift(1)->at(origin);
        EXPECT_NEAR(glm::distance(seen, {6, 0, 0}), 0, 1e-6);
        EXPECT_NEAR(motion.drift(1)->linear[0].y, 0.02, 1e-4);
    }
    snapshot.time.microseconds += 500'000;
    snapshot.sonar.velocity = {7, 0, 0};
    snapshot.sonar.angular_velocity = {0, 0.5, 0};
    motion.follow(snapshot);
    EXPECT_EQ(motion.velocity(), glm::dvec3(7, 0, 0));
    EXPECT_NEAR(glm::distance(motion.turn(), snapshot.sonar.orientation * glm::dvec3(0, 0.5, 0)), 0, 1e-12);
}

struct SweepTest : test::TaskBench<ScanningSonarTask, types::SnapshotPtr, types::SonarPtr> {
    SweepTest() : TaskBench(&ScanningSonarTask::snapshot, &ScanningSonarTask::ping) {}
    void start(bool sweeps) {
        ScanningSonarConfig config;
        config.sonar = movingFan();
        config.sonar.beam_width_deg = 2;
        config.head = {.left_deg = 180, .right_deg = -180, .step_deg = 10, .continuous = {}, .speed_deg_per_s = {}};
        config.head.sweeps = sweeps;
        startWith(config);
    }
    /** Returns the max of the ping at a time, for a plate at 200 m and a bearing in the body. */
    Loudest receivedAt(double seconds, double bearing_deg) {
        types::Snapshot snapshot = test::makeSnapshot(nullptr);
        const double bearing = radians(bearing_deg);
        auto geometry =
            test::makeScene({test::sphere(2, 24)}, 0, {{200 * std::cos(bearing), 200 * std::sin(bearing), 0}});
        snapshot.geometry = geometry;
        snapshot.time = types::Time::fromSeconds(seconds);
        const types::SonarPtr ping = answerTo(std::make_shared<types::Snapshot>(snapshot));
        return ping ? findLoudest(*ping) : Loudest{};
    }
};

TEST_F(SweepTest, ASweepingHeadReceivesHalfWayToItsBearingOnArrival) {
    const double behind = 10 / 0.5 * (2 * 200 / c) / 2;  // of steps of 10 deg in 0.5 s
    EXPECT_GT(behind, 2.5) << "more than the beam of 2 deg";
    start(true);
    receivedAt(1, 180);
    EXPECT_GT(receivedAt(1.5, 170 - behind).intensity, 0);
    EXPECT_EQ(receivedAt(2, 160).intensity, 0);
    const Loudest last = receivedAt(2.5, 150 - behind);
    EXPECT_GT(last.intensity, 0);
    EXPECT_NEAR(last.range, 198.5, 0.5);
}

TEST_F(SweepTest, ASteppingHeadReceivesAtItsBearing) {
    const double behind = 10 / 0.5 * (2 * 200 / c) / 2;
    start(false);
    receivedAt(1, 180);
    EXPECT_GT(receivedAt(1.5, 170).intensity, 0);
    EXPECT_EQ(receivedAt(2, 160 - behind).intensity, 0);
}

}  // namespace
}  // namespace insonify::sonar
