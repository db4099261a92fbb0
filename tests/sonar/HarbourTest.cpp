// The harbour of the demo with the scene, trajectory, mount and sonar of its deployment.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/YamlText.hpp"
#include "components/pose/Trajectory.hpp"
#include "components/scene/Scene.hpp"
#include "components/scene/SceneConfig.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Paths.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

const std::filesystem::path deploy = std::filesystem::path(test::source_dir) / "deploy";

template <class Config>
Config getProperties(const std::string& task) {
    const std::filesystem::path file = deploy / "harbour_fls.yml";
    framework::ConfigReader reader(file);
    Config config;
    EXPECT_TRUE(reader.read(YAML::LoadFile(file)["tasks"][task]["properties"], task, config)) << task;
    return config;
}

/** A pose with one of an object's vertices in view, and the range and bearing of this vertex [m, rad]. */
struct View {
    double range, bearing;
    size_t pose;
};

struct HarbourTest : testing::Test {
    static void SetUpTestSuite() {
        const auto scene = getProperties<scene::SceneConfig>("scene");
        geometry = scene::loadScene(deploy / scene.file);
        const auto file = getProperties<pose::TrajectoryConfig>("vehicle").file;
        const auto pass = pose::Trajectory::fromFile(deploy / *file);
        for (double time = 0; time <= pass.stamps().back().time; time += 0.25) {
            poses.emplace_back();
            types::place(pass.at(time), scene.mount, poses.back());
        }
        sonar = getProperties<SonarConfig>("sonar");
        sonar.device = "software";
    }
    static void TearDownTestSuite() { geometry.reset(); }

    static bool inView(const glm::dvec3& p) {
        const double range = glm::length(p);
        return range > 0.5 && range < sonar.range &&
               std::abs(std::atan2(p.y, p.x)) < types::radians(sonar.fieldOfViewDeg() / 2) &&
               std::abs(std::asin(p.z / range)) < types::radians(sonar.beam_height_deg / 2);
    }
    static types::Snapshot snapshotAt(size_t pose) {
        types::Snapshot snapshot;
        snapshot.sonar = poses[pose];
        snapshot.geometry = geometry;
        return snapshot;
    }

    /** Points along some of the triangles' edges. */
    static std::vector<glm::dvec3> getPoints(const types::Mesh& mesh) {
        std::vector<glm::dvec3> points;
        const size_t triangles = mesh.indices.size() / 3;
        for (size_t t = 0; t < triangles; t += 1 + triangles / 40)
            for (double along = 0; along < 1; along += 0.125)
                points.push_back(glm::mix(glm::dvec3(mesh.positions[mesh.indices[3 * t]]),
                                          glm::dvec3(mesh.positions[mesh.indices[3 * t + 1]]), along));
        return points;
    }
    static std::vector<View> getViews(const types::Object& object) {
        const auto points = getPoints(geometry->meshes[static_cast<size_t>(object.mesh)]);
        std::vector<View> views;
        for (size_t k = 0; k < poses.size(); ++k) {
            const glm::dmat4 sonar_from_object = glm::inverse(poses[k].worldFromBody()) * object.world_from_object;
            View nearest{1e9, 0, k};
            for (const glm::dvec3& point : points)
                if (const glm::dvec3 p = sonar_from_object * glm::dvec4(point, 1);
                    inView(p) && glm::length(p) < nearest.range)
                    nearest = {glm::length(p), std::atan2(p.y, p.x), k};
            if (nearest.range < 1e9) views.push_back(nearest);
        }
        std::ranges::sort(views, {}, &View::range);
        views.resize(std::min<size_t>(views.size(), 60));
        return views;
    }
    /** Returns whether the object changes some bin of the ping by more than half. */
    static bool differs(SonarRenderer& renderer, uint32_t object, const View& view) {
        types::Snapshot snapshot = snapshotAt(view.pose);
        snapshot.sonar.orientation *= glm::angleAxis(view.bearing, glm::dvec3(0, 0, 1));
        types::Sonar with, without;
        renderer.render(snapshot, with);
        glm::dmat4 away = geometry->objects[object].world_from_object;
        away[3].z += 1e5;
        snapshot.moved = {{object, away}};
        renderer.render(snapshot, without);
        const float floor = 1e-4f * *std::ranges::max_element(with.bins);
        for (size_t b = 0; b < with.bins.size(); ++b)
            if (with.bins[b] > floor && with.bins[b] > 2 * without.bins[b]) return true;
        return false;
    }

    static inline types::GeometryPtr geometry;
    static inline std::vector<types::Pose> poses;  ///< Poses of the sonar, four per second.
    static inline SonarConfig sonar;
};

}  // namespace

TEST_F(HarbourTest, MoreThanAHundredThousandTrianglesAreInViewOverThePass) {
    size_t total = 0;
    for (const types::Object& object : geometry->objects) {
        const types::Mesh& mesh = geometry->meshes[static_cast<size_t>(object.mesh)];
        std::vector<bool> vertex_seen(mesh.positions.size());
        for (const types::Pose& pose : poses) {
            const glm::dmat4 sonar_from_object = glm::inverse(pose.worldFromBody()) * object.world_from_object;
            for (size_t i = 0; i < vertex_seen.size(); ++i)
                if (!vertex_seen[i]) vertex_seen[i] = inView(sonar_from_object * glm::dvec4(mesh.positions[i], 1));
        }
        for (size_t i = 0; i < mesh.indices.size(); i += 3)
            total +=
                vertex_seen[mesh.indices[i]] || vertex_seen[mesh.indices[i + 1]] || vertex_seen[mesh.indices[i + 2]];
    }
    EXPECT_GT(total, 100'000u);
    RecordProperty("triangles", std::to_string(total));
}

TEST_F(HarbourTest, EveryNamedObjectAppearsInSomePing) {
    // Sixteen beams of the fan about the object. The sonar is rotated to them, which changes no bin (BeamFanTest.cpp).
    SonarConfig beams = sonar;
    beams.beam_count = 16;
    beams.field_of_view_deg = 16 * sonar.beamWidthDeg();
    SonarRenderer renderer(beams, geometry);
    std::map<std::string, std::vector<std::string>> shown, hidden;  // numbered objects together
    for (uint32_t i = 0; i < geometry->objects.size(); ++i) {
        const std::string& name = geometry->objects[i].name;
        if (name == "sea_floor") continue;
        const auto views = getViews(geometry->objects[i]);
        const bool appears = std::ranges::any_of(views, [&](const View& view) { return differs(renderer, i, view); });
        (appears ? shown : hidden)[name.substr(0, name.find_last_not_of("0123456789_") + 1)].push_back(name);
    }
    EXPECT_EQ(shown.size(), 11u) << "wall, ladder, piles, fenders, hull, pipeline, saddles, block, chain, buoy, rocks";
    EXPECT_TRUE(hidden.empty()) << testing::PrintToString(hidden);
}

}  // namespace insonify::sonar
