// Properties that hold for every sonar: configurations and scenes are drawn from a seed, and a failure prints both.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>
#include <map>

#include "components/sonar/tasks/SonarTask.hpp"
#include "tests/support/Draw.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"

namespace insonify::sonar {
namespace {

using test::Draw;
using test::relativeL2;

constexpr int random_configurations = 24;  ///< Configurations for each property.

/** A sonar by its properties, and the meshes in front of it, by their places. */
struct Drawn {
    std::map<std::string, std::string> properties;
    std::vector<types::Mesh> meshes;
    std::vector<glm::dvec3> places;
    std::vector<float> levels_db;  ///< Backscatter of each mesh.
    bool is_coherent = false;

    SonarConfig config() const {
        SonarTask task("sonar");
        task.properties().front()->setAll(properties);
        return task.sonarConfig();
    }
    std::string text() const {
        std::string text = "properties:\n";
        for (const auto& [name, value] : properties) text += fmt::format("  {}: {}\n", name, value);
        for (size_t i = 0; i < places.size(); ++i)
            text += fmt::format("# object {}: {} triangles at [{:.17g}, {:.17g}, {:.17g}], {:.9g} dB\n", i,
                                meshes[i].indices.size() / 3, places[i].x, places[i].y, places[i].z, levels_db[i]);
        return text;
    }
    types::Snapshot scene() const { return sceneOf(meshes, places); }
    /** Returns the scene with other meshes or places, in the same order. */
    types::Snapshot sceneOf(const std::vector<types::Mesh>& shapes, const std::vector<glm::dvec3>& at) const {
        std::vector<types::Mesh> meshes = shapes;
        for (size_t i = 0; i < meshes.size(); ++i)
            for (types::Cluster& cluster : meshes[i].clusters) cluster.material = static_cast<int>(i);
        auto geometry = std::make_shared<types::Geometry>(*test::sceneOf(meshes, 0, at));
        geometry->materials.resize(meshes.size(), geometry->materials[0]);
        for (size_t i = 0; i < meshes.size(); ++i) geometry->materials[i].lambert_db = levels_db[i];
        return test::snapshotOf(std::move(geometry));
    }
};

std::string drawLaw(Draw& draw) {
    static constexpr const char* weightings[] = {"hann", "hamming", "taylor"};
    return draw.once(2)
               ? fmt::format("{{width_deg: {:.3f}}}", draw.between(2, 30))
               : fmt::format("{{width_deg: {:.3f}, weighting: {}}}", draw.between(2, 30), draw.oneOf(weightings));
}

void drawFan(Draw& draw, Drawn& made) {
    auto& p = made.properties;
    p["range"] = fmt::format("{:.3f}", draw.between(12, 30));
    p["bin_count"] = fmt::format("{}", 40 + draw.upTo(120));
    p["range_rounding"] = draw.once(2) ? "exact" : "sample";
    p["speed_of_sound"] = fmt::format("{:.2f}", draw.between(1400, 1560));
    p["frequency_khz"] = fmt::format("{:.1f}", draw.between(100, 900));
    p["beam_height_deg"] = fmt::format("{:.2f}", draw.between(6, 60));
    p["visibility"] = "cpu";
    p["quality"] = fmt::format("{{rows: {}, columns_per_beam: {}}}", 16 + draw.upTo(48), 1 + draw.upTo(4));
    p["beam_geometry"] = draw.once(2) ? "conical" : "planar";
    p["beam_count"] = fmt::format("{}", 1 + draw.upTo(24));
    p["field_of_view_deg"] = fmt::format("{:.3f}", draw.between(20, 140));
}

void drawEffects(Draw& draw, Drawn& made) {
    static constexpr const char* windows[] = {"hann", "hamming"};
    auto& p = made.properties;
    if (draw.once(2))
        p["beam_pattern"] =
            fmt::format("{{transmit: {{azimuth: {}, elevation: {}}}, receive: {{azimuth: {}}}, floor_db: {:.1f}}}",
                        drawLaw(draw), drawLaw(draw), drawLaw(draw), draw.between(-60, -20));
    if (draw.once(2))
        p["pulse"] = draw.once(2) ? fmt::format("{{duration_us: {:.1f}}}", draw.between(50, 800))
                                  : fmt::format("{{bandwidth_khz: {:.2f}, window: {}}}", draw.between(2, 40),
                                                draw.oneOf(windows));
    if (draw.once(2)) p["absorption"] = fmt::format("{{db_per_m: {:.3f}}}", draw.between(0, 0.3));
    if (draw.once(3)) p["volume"] = fmt::format("{{strength_db: {:.1f}}}", draw.between(-90, -50));
    made.is_coherent = draw.once(4);
    if (made.is_coherent) p["speckle"] = "{coherent: true}";
}

/** Draws objects in sectors of their own, so that none is behind another. */
Drawn drawnFrom(uint64_t seed) {
    Draw draw(seed);
    Drawn made;
    drawFan(draw, made);
    drawEffects(draw, made);
    const int objects = 2 + draw.upTo(3);
    for (int i = 0; i < objects; ++i) {
        const double bearing = types::radians(draw.between(-3, 3) + 40 * (i - 0.5 * (objects - 1)) / objects * 2);
        const double range = draw.between(6, 11), height = draw.between(-0.6, 0.6);
        made.places.push_back({range * std::cos(bearing), range * std::sin(bearing), height});
        const double size = draw.between(0.15, 0.4);
        if (draw.once(2))
            made.meshes.push_back(test::sphere(size, 8));
        else
            made.meshes.push_back(test::quad({0, -size, -size}, {draw.between(-0.2, 0.2), 2 * size, 0},
                                             {draw.between(-0.2, 0.2), 0, 2 * size}));
        made.levels_db.push_back(static_cast<float>(draw.between(-30, 0)));
    }
    return made;
}

types::Sonar pingOf(const Drawn& one, const types::Snapshot& scene, const RenderOptions& options = {}) {
    return test::pingOf(one.config(), scene, options);
}

/** Calls `hold` with each configuration, and with its number. */
void forEachDrawn(const std::function<void(const Drawn&, Draw&)>& hold) {
    const test::Seeds seeds(random_configurations);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        const Drawn one = drawnFrom(seed);
        SCOPED_TRACE(fmt::format("seed {}\n{}", seed, one.text()));
        Draw more(1000 + seed);
        hold(one, more);
        if (testing::Test::HasFailure() && seeds.count == random_configurations) return;
    }
}

types::Mesh mirrorImage(types::Mesh mesh) {
    for (glm::vec3& p : mesh.positions) p.y = -p.y;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    for (types::Cluster& cluster : mesh.clusters) cluster.centre.y = -cluster.centre.y;
    return mesh;
}

types::Sonar mirrorImage(types::Sonar ping) {
    for (uint32_t beam = 0; beam < ping.beam_count / 2; ++beam)
        std::swap_ranges(ping.bins.begin() + beam * ping.bin_count, ping.bins.begin() + (beam + 1) * ping.bin_count,
                         ping.bins.end() - (beam + 1) * ping.bin_count);
    return ping;
}

/** Makes sure that pings which are compared are not empty. */
void expectAlike(const types::Sonar& got, const types::Sonar& expected, double tolerance) {
    ASSERT_EQ(got.bins.size(), expected.bins.size());
    const bool is_empty = !(test::sumOf(expected) > 0);
    EXPECT_LE(is_empty ? test::sumOf(got) : relativeL2(got, expected), is_empty ? 0 : tolerance);
}

TEST(RandomConfigurationTest, DrawsPingsWithEchoes) {
    int with_echoes = 0;
    for (uint64_t seed = 1; seed <= random_configurations; ++seed) {
        const Drawn one = drawnFrom(seed);
        with_echoes += test::sumOf(pingOf(one, one.scene())) > 0;
    }
    EXPECT_GE(with_echoes, random_configurations * 3 / 4);
}

/** The world turns about the vertical and moves, as far as float positions are exact. */
TEST(RandomConfigurationTest, APingDoesNotDependOnWhereTheWorldsAxesAre) {
    forEachDrawn([](const Drawn& drawn, Draw& draw) {
        Drawn one = drawn;
        if (one.is_coherent) one.properties.erase("volume");  // the scatterers of the water stay in the world
        const types::Snapshot scene = one.scene();
        const glm::dquat turn = glm::angleAxis(draw.between(-3, 3), glm::normalize(glm::dvec3(0.2, -0.1, 1)));
        const glm::dvec3 way(draw.between(-100, 100), draw.between(-100, 100), draw.between(-20, 20));
        types::Snapshot turned = scene;
        auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
        for (types::Object& object : geometry->objects) {
            const glm::dmat4 place = glm::mat4_cast(turn) * object.world_from_object;
            object.world_from_object = place;
            object.world_from_object[3] += glm::dvec4(way, 0);
        }
        turned.geometry = geometry;
        turned.sonar.position = turn * scene.sonar.position + way;
        turned.sonar.orientation = turn * scene.sonar.orientation;
        expectAlike(pingOf(one, turned), pingOf(one, scene), one.is_coherent ? 0.05 : 0.01);
    });
}

TEST(RandomConfigurationTest, TheMirrorImageOfASceneHasTheMirrorImageOfItsPing) {
    forEachDrawn([](const Drawn& drawn, Draw&) {
        if (drawn.is_coherent) return;  // its scatterers are not mirrored
        Drawn one = drawn;
        const bool has_pattern = one.properties.contains("beam_pattern");  // whose columns begin at one side
        if (has_pattern) one.properties["quality"] = "{rows: 64, columns_per_beam: 32}";
        std::vector<types::Mesh> meshes;
        std::vector<glm::dvec3> places;
        for (size_t i = 0; i < one.meshes.size(); ++i) {
            meshes.push_back(mirrorImage(one.meshes[i]));
            places.push_back(one.places[i] * glm::dvec3(1, -1, 1));
        }
        expectAlike(mirrorImage(pingOf(one, one.sceneOf(meshes, places))), pingOf(one, one.scene()),
                    has_pattern ? 0.1 : 0.01);
    });
}

TEST(RandomConfigurationTest, EnergiesOfObjectsThatDoNotHideEachOtherAdd) {
    forEachDrawn([](const Drawn& one, Draw&) {
        if (one.is_coherent || one.properties.contains("volume")) return;  // fields add, and objects hide water
        const types::Sonar together = pingOf(one, one.scene());
        types::Sonar sum = together;
        std::ranges::fill(sum.bins, 0.0F);
        for (size_t i = 0; i < one.meshes.size(); ++i) {
            std::vector<glm::dvec3> places(one.places.size(), glm::dvec3(-500, 0, 0));  // behind, out of range
            places[i] = one.places[i];
            const types::Sonar alone = pingOf(one, one.sceneOf(one.meshes, places));
            for (size_t k = 0; k < sum.bins.size(); ++k) sum.bins[k] += alone.bins[k];
        }
        expectAlike(together, sum, 1e-4);
    });
}

TEST(RandomConfigurationTest, ThreadsDoNotChangeAPing) {
    forEachDrawn([](const Drawn& one, Draw& draw) {
        RenderOptions single, many;
        single.threads = 1;
        many.threads = 2 + draw.upTo(4);
        EXPECT_EQ(pingOf(one, one.scene(), many).bins, pingOf(one, one.scene(), single).bins);
    });
}

TEST(RandomConfigurationTest, TheOrderOfBeamsDoesNotChangeThem) {
    forEachDrawn([](const Drawn& one, Draw& draw) {
        Drawn listed = one, reversed = one;
        const int beams = 2 + draw.upTo(6);
        std::string there, back;
        for (int k = 0; k < beams; ++k) {
            const std::string bearing = fmt::format("{:.3f}", -50 + 100.0 * k / beams);
            there += (k > 0 ? ", " : "") + bearing;
            back = bearing + (k > 0 ? ", " : "") + back;
        }
        for (Drawn* each : {&listed, &reversed}) {
            each->properties.erase("beam_count");
            each->properties.erase("field_of_view_deg");
            each->properties["beam_width_deg"] = "6";
            each->properties["bearings_deg"] = "[" + (each == &listed ? there : back) + "]";
        }
        expectAlike(mirrorImage(pingOf(reversed, one.scene())), pingOf(listed, one.scene()), 1e-5);
    });
}

/** The object in a bin reaches into the bin's ranges. */
TEST(RandomConfigurationTest, TheTruthOfABinIsAnObjectWithinItsRange) {
    forEachDrawn([](const Drawn& one, Draw&) {
        const types::Snapshot scene = one.scene();
        SonarRenderer renderer(one.config(), scene.geometry, {});
        types::Sonar ping;
        types::SonarTruth truth;
        renderer.setTruth(ping, &truth);
        renderer.render(scene, ping);
        const double width = one.config().range / ping.bin_count;
        for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
            for (uint32_t bin = 0; bin < ping.bin_count; ++bin) {
                const int object = truth.object[beam * ping.bin_count + bin];
                ASSERT_GE(object, -1);
                ASSERT_LT(object, static_cast<int>(one.meshes.size()));
                if (object < 0) continue;
                double nearest = 1e9, farthest = 0;
                for (const glm::vec3& p : one.meshes[static_cast<size_t>(object)].positions) {
                    const double range = glm::length(one.places[static_cast<size_t>(object)] + glm::dvec3(p));
                    nearest = std::min(nearest, range);
                    farthest = std::max(farthest, range);
                }
                // A facet is nearer in its middle than at its corners.
                ASSERT_GE((bin + 1) * width * 1.05, nearest - 0.1) << "beam " << beam << ", bin " << bin;
                ASSERT_LE(bin * width * 0.95, farthest + 0.1) << "beam " << beam << ", bin " << bin;
            }
    });
}

TEST(RandomConfigurationTest, NeutralValuesChangeNothing) {
    forEachDrawn([](const Drawn& one, Draw&) {
        const types::Sonar plain = pingOf(one, one.scene());
        for (const auto& [name, value] : {std::pair("multipath", "{bounces: 0}"),
                                          {"motion_in_ping", "false"},
                                          {"effects", "{}"},
                                          {"max_walls", "4"},
                                          {"published", "false"}}) {
            Drawn with = one;
            with.properties[name] = value;
            EXPECT_EQ(pingOf(with, one.scene()).bins, plain.bins) << name << ": " << value;
        }
    });
}

}  // namespace
}  // namespace insonify::sonar
