// Threads and extreme scenes (ACOUSTICS.md 11).
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <set>
#include <thread>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"

namespace insonify::sonar {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

SonarConfig oneFan() {
    SonarConfig config = test::getSonar({.beams = 32, .width_deg = 100, .height_deg = 40, .bins = 400, .rows = 128});
    config.device = "software";
    return config;
}

std::vector<float> binsSeen(const types::Snapshot& snapshot) { return test::makePing(oneFan(), snapshot).bins; }

double energy(const std::vector<float>& bins) { return std::accumulate(bins.begin(), bins.end(), 0.0); }

types::Mesh farWall() { return test::quad({10, -50, -50}, {0, 100, 0}, {0, 0, 100}); }

}  // namespace

TEST(SonarRendererTest, SonarsSideBySideRenderTheSameAsAlone) {
    const auto snapshot = test::makeSnapshot(test::surfaces());
    const std::vector<float> alone = binsSeen(snapshot);
    ASSERT_GT(energy(alone), 0);
    std::atomic<int> differing = 0;
    std::vector<std::thread> sonars;
    for (int i = 0; i < 3; ++i)
        sonars.emplace_back([&] {
            for (int made = 0; made < 4; ++made) {
                SonarRenderer renderer(oneFan(), snapshot.geometry);
                types::Sonar ping;
                for (int k = 0; k < 40; ++k) {
                    renderer.render(snapshot, ping);
                    differing += ping.bins == alone ? 0 : 1;
                }
            }
        });
    for (std::thread& sonar : sonars) sonar.join();
    EXPECT_EQ(differing, 0);
}

/** As when a driver changes the range: the device keeps the scene where it can. */
TEST(SonarRendererTest, ARasterisingSonarThatIsChangedRendersAsOneMadeSo) {
    auto surfaces = std::make_shared<types::Geometry>(*test::surfaces());
    surfaces->materials.front().has_acoustics = true;
    surfaces->materials.front().seabed = "coarse_sand";
    surfaces->materials.front().roughness_slope = 0.2;
    const auto snapshot = test::makeSnapshot(types::GeometryPtr(surfaces));
    std::vector<SonarConfig> all(9, oneFan());
    for (SonarConfig& config : all) config.frequency_khz = 60;
    all[1].range *= 1.7;
    all[2].frequency_khz = 30;
    all[3].range_min = 0.9 * all[3].range / 2;
    all[3].speed_of_sound = 1430;
    all[4].field_of_view_deg = 30;  // fewer images
    all[5].beam_count = 40;
    all[5].bin_count = 123;
    all[6].deposit = Deposit::Gpu;
    all[7].visibility = Visibility::Cpu;
    std::vector<std::vector<float>> made;  // first: one renderer on a thread at a time
    for (const SonarConfig& config : all) made.push_back(test::makePing(config, snapshot).bins);
    SonarRenderer changed(all[0], snapshot.geometry);
    types::Sonar ping;
    for (size_t i = 0; i < all.size(); ++i) {
        SCOPED_TRACE(i);
        changed.setConfig(all[i]);
        for (int again = 0; again < 2; ++again) {
            changed.render(snapshot, ping);
            EXPECT_TRUE(ping.bins == made[i]);
        }
    }
    EXPECT_GE(std::set(made.begin(), made.end()).size(), 6u) << "the settings matter";
}

TEST(SonarRendererTest, RejectsAnotherThread) {
    const auto snapshot = test::makeSnapshot(test::surfaces());
    SonarRenderer renderer(oneFan(), snapshot.geometry);
    std::string error;
    std::thread([&] {
        try {
            types::Sonar ping;
            renderer.render(snapshot, ping);
        } catch (const gpu::GlError& thrown) {
            error = thrown.what();
        }
    }).join();
    EXPECT_THAT(error, HasSubstr("another thread"));
}

TEST(SonarRendererTest, NothingInViewIsSilence) {
    const types::Snapshot ahead = test::makeSnapshot(test::makeScene({farWall()}));
    EXPECT_GT(energy(binsSeen(ahead)), 0);
    EXPECT_THAT(binsSeen(test::makeSnapshot(std::make_shared<types::Geometry>())), Each(0)) << "empty";
    EXPECT_THAT(binsSeen(test::makeSnapshot(ahead.geometry, {20, 0, 0})), Each(0)) << "behind";
    EXPECT_THAT(binsSeen(test::makeSnapshot(ahead.geometry, {-50, 0, 0})), Each(0)) << "beyond the range";
    EXPECT_THAT(binsSeen(test::makeSnapshot(ahead.geometry, {9.95, 0, 0})), Each(testing::Ge(0)))
        << "nearer than range_min";
}

TEST(SonarRendererTest, ObjectsNearerThanTheBlankingAreSilentAndCastShadows) {
    const types::Mesh plate = test::quad({0.5, -1, -1}, {0, 2, 0}, {0, 0, 2});
    const types::Mesh target = test::quad({5, -20, -20}, {0, 40, 0}, {0, 0, 40});
    const types::GeometryPtr both = test::makeScene({plate, target}), alone = test::makeScene({target});
    for (const Visibility visibility : {Visibility::Cpu, Visibility::Gl}) {
        const auto received = [&](const types::GeometryPtr& geometry, double range_min) {
            SonarConfig config = oneFan();
            config.visibility = visibility;
            if (visibility == Visibility::Cpu) config.device.clear();
            config.range_min = range_min;
            const types::Sonar ping = test::makePing(config, test::makeSnapshot(geometry));
            double near = 0, far = 0;  // of 2 m: all of the plate that is in view is within 0.9 m
            for (size_t i = 0; i < ping.bins.size(); ++i) (i % 400 < 20 ? near : far) += ping.bins[i];
            return std::pair(near, far);
        };
        for (const double range_min : {0.45, 0.55, 1.9}) {
            const auto [near, far] = received(both, range_min);
            EXPECT_EQ(far, 0) << "the plate hides the wall, blanked from " << range_min;
            EXPECT_EQ(near > 0, range_min < 1.9) << range_min;
            EXPECT_GT(received(alone, range_min).second, 0);
        }
        EXPECT_GT(received(both, 0.45).first, received(both, 0.55).first);
    }
}

TEST(SonarRendererTest, ASonarOnASurfaceOrInsideABodyHasFiniteEchoes) {
    const auto ball = test::makeScene({test::sphere(5, 32)});
    for (double x : {0.0, 4.0, 4.99, 5.0, 5.01})
        EXPECT_THAT(binsSeen(test::makeSnapshot(ball, {x, 0, 0}, 0.3)),
                    Each(testing::AllOf(testing::Ge(0), testing::Le(1e6f))))
            << x;
    EXPECT_GT(energy(binsSeen(test::makeSnapshot(ball))), 0) << "the inside reflects";
}

TEST(SonarRendererTest, FacesTurnedAwayReflectTheSame) {
    types::Mesh turned = farWall();
    std::ranges::reverse(turned.indices);
    EXPECT_EQ(binsSeen(test::makeSnapshot(test::makeScene({turned}))),
              binsSeen(test::makeSnapshot(test::makeScene({farWall()}))));
}

TEST(SonarRendererTest, DoubledFacesAndTrianglesWithoutAreaAddNothing) {
    types::Mesh doubled = farWall(), degenerate = farWall();
    doubled.indices.insert(doubled.indices.end(), {0, 1, 2, 0, 2, 3});
    doubled.clusters[0].index_count = 12;
    degenerate.indices.insert(degenerate.indices.end(), {0, 0, 1, 0, 2, 2});
    degenerate.clusters[0].index_count = 12;
    const auto bins = binsSeen(test::makeSnapshot(test::makeScene({farWall()})));
    EXPECT_EQ(binsSeen(test::makeSnapshot(test::makeScene({doubled}))), bins);
    EXPECT_EQ(binsSeen(test::makeSnapshot(test::makeScene({degenerate}))), bins);
    EXPECT_EQ(binsSeen(test::makeSnapshot(test::makeScene({farWall(), farWall()}))), bins)
        << "an object in the same place";
}

TEST(SonarRendererTest, FarFromTheOriginOfTheWorldEchoesAreTheSame) {
    const auto here = test::surfaces();
    auto there = std::make_shared<types::Geometry>(*here);
    const glm::dvec3 offset(500'000, 4'500'000, -100);  // as in UTM
    for (types::Object& object : there->objects) object.world_from_object[3] += glm::dvec4(offset, 0);
    const auto bins = binsSeen(test::makeSnapshot(here, {0, 0, 0}, 0.1, 0.1));
    EXPECT_LT(test::relativeL2(binsSeen(test::makeSnapshot(there, offset, 0.1, 0.1)), bins), 1e-6);
}

TEST(SonarRendererTest, FarFromTheOriginOfATileEchoesAreTheSame) {
    const glm::vec3 offset(4096, -3072, 512);  // vertices stay exact
    types::Mesh here = test::quad({4, -16, -6}, {40, 0, 9}, {0, 32, 5}), there = here;
    for (glm::vec3& p : there.positions) p += offset;
    SonarConfig config;
    config.range = 30;
    config.bin_count = 6000;  // of 5 mm
    config.beam_count = 16;
    config.field_of_view_deg = 40;
    config.range_rounding = RangeRounding::Exact;
    config.device = "software";
    const auto bins = [&](const types::Mesh& mesh, const glm::dvec3& sonar) {
        const auto scene = test::makeScene({mesh});
        types::Sonar ping;
        SonarRenderer(config, scene).render(test::makeSnapshot(scene, sonar, 0.3, 0.2), ping);
        return ping.bins;
    };
    EXPECT_LT(test::relativeL2(bins(there, offset), bins(here, {})), 1e-5);
}

TEST(SonarRendererTest, ASeaFloorOfTwoHugeTrianglesIsASeaFloor) {
    const auto small = binsSeen(test::makeSnapshot(test::makeScene({test::ground(-5, 1000)}), {}, 0, 0.2));
    EXPECT_LT(
        test::relativeL2(binsSeen(test::makeSnapshot(test::makeScene({test::ground(-5, 1e8f)}), {}, 0, 0.2)), small),
        0.01);
}

}  // namespace insonify::sonar
