#pragma once
// Sonars of every kind with random properties, and random scenes in front of them.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "components/sonar/tasks/ScanningSonarTask.hpp"
#include "tests/support/Draw.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::test {

/** One thing in front of a random sonar. */
struct RandomObject {
    std::string name;
    types::Mesh mesh;
    glm::dvec3 place;
    types::Material material;
};

/** Kinds of sonars whose task renders pings. */
enum class Kind { Fan, Scanning, Profiler, SideScan, Grid, Altimeter };
inline constexpr int kinds = 6;

/** A sonar by its task and its properties, and the things around it. The sonar is at the origin of the world. */
struct RandomSonar {
    Kind kind = Kind::Fan;
    std::map<std::string, std::string> properties;
    std::vector<RandomObject> objects;
    bool is_coherent = false;
    std::optional<double> water_surface;  ///< Its height [m].
    std::vector<types::PointTarget> targets;

    static constexpr int scan_pings = 5;  ///< Of one turn of a scanning sonar.
    int pings() const { return kind == Kind::Scanning ? scan_pings : 1; }

    const char* type() const {
        static constexpr const char* types[] = {"sonar::SonarTask",    "sonar::ScanningSonarTask",
                                                "sonar::ProfilerTask", "sonar::SideScanTask",
                                                "sonar::Sonar3dTask",  "sonar::AltimeterTask"};
        return types[static_cast<int>(kind)];
    }
    std::string text() const {
        std::string text = fmt::format("type: {}\nproperties:\n", type());
        for (const auto& [name, value] : properties) text += fmt::format("  {}: {}\n", name, value);
        for (const RandomObject& object : objects)
            text += fmt::format(
                "# {}: {} triangles at [{:.17g}, {:.17g}, {:.17g}], {:.9g} dB {}, reflection {}, slope {}\n",
                object.name, object.mesh.indices.size() / 3, object.place.x, object.place.y, object.place.z,
                object.material.lambert_db, object.material.seabed, object.material.reflection,
                object.material.roughness_slope.value_or(0));
        return text;
    }
    RandomSonar with(const std::string& name, const std::string& value) const {
        RandomSonar other = *this;
        other.properties[name] = value;
        return other;
    }
    types::Snapshot scene() const { return with(objects); }
    /** Returns the scene with other objects. */
    types::Snapshot with(const std::vector<RandomObject>& others) const {
        types::Snapshot scene = makeScene(others);
        scene.water_surface = water_surface;
        scene.targets = targets;
        return scene;
    }

    static types::Snapshot makeScene(const std::vector<RandomObject>& objects) {
        auto geometry = std::make_shared<types::Geometry>();
        std::vector<types::Mesh> meshes;
        for (const RandomObject& object : objects) {
            const int index = static_cast<int>(meshes.size());
            types::Mesh mesh = object.mesh;
            for (types::Cluster& cluster : mesh.clusters) cluster.material = index;
            meshes.push_back(std::move(mesh));
            glm::dmat4 place(1);
            place[3] = glm::dvec4(object.place, 1);
            geometry->objects.push_back({object.name, index, place});
            geometry->materials.push_back(object.material);
        }
        if (objects.empty()) geometry = std::make_shared<types::Geometry>(*openWater());
        if (!objects.empty()) geometry->meshes = std::move(meshes);
        return makeSnapshot(std::move(geometry));
    }
};

/** A task of a random sonar, whose pings and truths are read. */
class SonarBench {
public:
    explicit SonarBench(const RandomSonar& one, int threads = 2, bool with_truth = false) : pings_(one.pings()) {
        framework::Registry registry;
        sonar::registerTasks(registry);
        task_ = registry.make(one.type(), "sonar");
        auto& task = dynamic_cast<sonar::PingTask&>(*task_);
        task.properties().front()->setAll(one.properties);
        task.useThreads(threads);
        in_.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(4));
        task.ping.connectTo(out_.port, framework::ConnPolicy::buffer(4));
        if (with_truth) task.truth.connectTo(truth_.port, framework::ConnPolicy::buffer(4));
        if (!task.configure() || !task.start()) throw std::runtime_error(task.lastError());
    }
    /** Returns the pings of a scene that stands still, of a scanning sonar those from its left limit to the right. */
    std::vector<types::Sonar> getPings(types::Snapshot scene) {
        std::vector<types::Sonar> pings;
        for (int k = 0; k < pings_; ++k) {
            scene.time.microseconds += 1'000'000;
            in_.port.write(std::make_shared<const types::Snapshot>(scene));
            task_->update();
            types::SonarPtr ping;
            if (!out_.port.readNew(ping)) throw std::runtime_error("no ping: " + task_->lastError());
            pings.push_back(*ping);
            truth_.port.readNew(truth);
        }
        return pings;
    }
    /** Changes the properties of the running task from those of one sonar to those of another. */
    void change(const RandomSonar& from, const RandomSonar& to) {
        std::map<std::string, std::string> values = to.properties;
        for (const auto& [name, value] : from.properties)
            if (!values.try_emplace(name, "null").second && values[name] == value) values.erase(name);
        for (const auto& [name, value] : values)  // a block is replaced, not merged
            if (value.starts_with('{')) task_->properties().front()->setAll({{name, "null"}});
        task_->properties().front()->setAll(values);
    }
    sonar::PingTask& task() const { return dynamic_cast<sonar::PingTask&>(*task_); }
    const sonar::Counts& counts() const { return task().counted().counts; }
    types::SonarTruthPtr truth;  ///< Of the last ping.

private:
    std::unique_ptr<framework::TaskContext> task_;
    Writer<types::SnapshotPtr> in_;
    Reader<types::SonarPtr> out_;
    Reader<types::SonarTruthPtr> truth_;
    int pings_;
};

/** Returns the bins of all pings, one after the other. */
inline std::vector<float> getBins(const std::vector<types::Sonar>& pings) {
    std::vector<float> bins;
    for (const types::Sonar& ping : pings) bins.insert(bins.end(), ping.bins.begin(), ping.bins.end());
    return bins;
}
inline std::vector<float> getBins(const RandomSonar& one, const types::Snapshot& scene, int threads = 2) {
    return getBins(SonarBench(one, threads).getPings(scene));
}

namespace random_sonars {

inline std::string drawLaw(Draw& draw) {
    static constexpr const char* weightings[] = {"hann", "hamming", "taylor", "gaussian", "uniform"};
    return draw.once(2)
               ? fmt::format("{{width_deg: {:.3f}}}", draw.between(2, 30))
               : fmt::format("{{width_deg: {:.3f}, weighting: {}}}", draw.between(2, 30), draw.oneOf(weightings));
}

/** Draws the bins, the beams and the samples of a kind. */
inline void drawGrid(Draw& draw, RandomSonar& made) {
    auto& p = made.properties;
    p["range"] = fmt::format("{:.3f}", draw.between(13, 30));
    p["bin_count"] = fmt::format("{}", 40 + draw.upTo(100));
    p["range_rounding"] = draw.once(2) ? "exact" : "sample";
    p["speed_of_sound"] = fmt::format("{:.2f}", draw.between(1400, 1560));
    p["frequency_khz"] = fmt::format("{:.1f}", draw.between(100, 900));
    p["visibility"] = "cpu";
    const bool is_fan = made.kind == Kind::Fan || made.kind == Kind::Profiler;
    if (is_fan) {
        p["beam_count"] = fmt::format("{}", 1 + draw.upTo(24));
        p["field_of_view_deg"] = fmt::format("{:.3f}", draw.between(20, 140));
    }
    if (is_fan || made.kind == Kind::Scanning) p["beam_geometry"] = draw.once(2) ? "conical" : "planar";
    if (made.kind == Kind::Grid) {
        p["horizontal"] =
            fmt::format("{{beam_count: {}, field_of_view_deg: {:.2f}}}", 1 + draw.upTo(6), draw.between(30, 80));
        p["vertical"] =
            fmt::format("{{beam_count: {}, field_of_view_deg: {:.2f}}}", 1 + draw.upTo(5), draw.between(10, 40));
        p["beam_height_deg"] = fmt::format("{:.2f}", draw.between(3, 12));
        p["quality"] = fmt::format("{{rows: {}, columns_per_beam: {}}}", 4 + draw.upTo(12), 4 + draw.upTo(12));
        return;
    }
    if (made.kind == Kind::SideScan) {
        p["beam_width_deg"] = fmt::format("{:.2f}", draw.between(4, 16));
        p["beam_height_deg"] = fmt::format("{:.2f}", draw.between(20, 80));
        p["depression_deg"] = fmt::format("{:.2f}", draw.between(10, 50));
        p["quality"] = fmt::format("{{rows: {}, columns_per_beam: {}}}", 8 + draw.upTo(8), 64 + draw.upTo(200));
        return;
    }
    if (!is_fan) p["beam_width_deg"] = fmt::format("{:.2f}", draw.between(6, 40));
    p["beam_height_deg"] = fmt::format("{:.2f}", draw.between(6, 60));
    p["quality"] = fmt::format("{{rows: {}, columns_per_beam: {}}}", 16 + draw.upTo(48),
                               (is_fan ? 1 : 16) + draw.upTo(is_fan ? 4 : 32));
    if (made.kind != Kind::Scanning) return;
    const int step = 5 + draw.upTo(25), half = step * (RandomSonar::scan_pings - 1) / 2;
    p["head"] = fmt::format("{{left_deg: {}, right_deg: {}, step_deg: {}, continuous: false}}", half, -half, step);
}

inline void drawEffects(Draw& draw, RandomSonar& made) {
    static constexpr const char* windows[] = {"none", "hann", "hamming", "taylor"};
    auto& p = made.properties;
    if (draw.once(2)) {
        std::string transmit, receive;
        if (made.kind != Kind::Grid) transmit = "azimuth: " + drawLaw(draw);
        if (made.kind != Kind::SideScan && draw.once(2))
            transmit += (transmit.empty() ? "elevation: " : ", elevation: ") + drawLaw(draw);
        receive = "azimuth: " + drawLaw(draw);
        if (draw.once(3)) receive += ", elevation: " + drawLaw(draw);
        p["beam_pattern"] = fmt::format("{{transmit: {{{}}}, receive: {{{}}}, floor_db: {:.1f}}}", transmit, receive,
                                        draw.between(-60, -20));
    }
    if (draw.once(2)) {
        const std::string ring = draw.once(2) ? fmt::format(", ring_down: {{level_db: {:.1f}, decay_db_per_m: {:.1f}}}",
                                                            draw.between(-60, 0), draw.between(5, 60))
                                              : "";
        p["pulse"] = draw.once(2) ? fmt::format("{{duration_us: {:.1f}{}}}", draw.between(50, 800), ring)
                                  : fmt::format("{{bandwidth_khz: {:.2f}, window: {}{}}}", draw.between(2, 40),
                                                draw.oneOf(windows), ring);
    }
    if (draw.once(2)) p["absorption"] = fmt::format("{{db_per_m: {:.3f}}}", draw.between(0, 0.3));
    if (draw.once(3)) p["volume"] = fmt::format("{{strength_db: {:.1f}}}", draw.between(-90, -50));
    made.is_coherent = draw.once(4);
    if (made.is_coherent)
        p["speckle"] = draw.once(2) ? "{coherent: true}" : "{coherent: true, scatterers_per_m2: 2000}";
}

/** Returns the direction of object `i` of `count` from the sonar, about where its beams look. */
inline glm::dvec3 drawDirection(Draw& draw, Kind kind, int i, int count) {
    double azimuth = draw.between(-3, 3) + 80 * (i - 0.5 * (count - 1)) / count, elevation = draw.between(-6, 6);
    if (kind == Kind::SideScan) azimuth = draw.between(-3, 3) + (i % 2 ? 90 : -90), elevation = -20 - 15.0 * i;
    const double a = types::radians(azimuth), e = types::radians(elevation);
    return {std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e)};
}

inline types::Mesh drawMesh(Draw& draw) {
    const double size = draw.between(0.15, 0.4);
    if (draw.once(2)) return sphere(size, 8);
    return quad({0, -size, -size}, {draw.between(-0.2, 0.2), 2 * size, 0}, {draw.between(-0.2, 0.2), 0, 2 * size});
}

inline types::Material drawMaterial(Draw& draw) {
    static constexpr const char* seabeds[] = {"coarse_sand", "medium_silt", "rock"};
    types::Material material;
    material.has_acoustics = true;
    material.lambert_db = static_cast<float>(draw.between(-30, 0));
    const int choice = draw.upTo(6);
    if (choice == 0) material.seabed = draw.oneOf(seabeds);
    if (choice == 1) {
        material.reflection = static_cast<float>(draw.between(0.1, 1));
        if (draw.once(2)) material.roughness_slope = static_cast<float>(draw.between(0.05, 0.4));
    }
    return material;
}

}  // namespace random_sonars

/** Draws a sonar, and objects in sectors of their own, so that none is behind another. */
inline RandomSonar randomSonar(uint64_t seed) {
    Draw draw(seed);
    RandomSonar made;
    made.kind = static_cast<Kind>(seed % kinds);
    random_sonars::drawGrid(draw, made);
    random_sonars::drawEffects(draw, made);
    const int objects = 2 + draw.upTo(3);
    for (int i = 0; i < objects; ++i) {
        RandomObject object;
        object.name = fmt::format("object_{}", i);
        object.place = draw.between(6, 11) * random_sonars::drawDirection(draw, made.kind, i, objects);
        object.mesh = random_sonars::drawMesh(draw);
        object.material = random_sonars::drawMaterial(draw);
        made.objects.push_back(std::move(object));
    }
    return made;
}

/** Adds what changes how sound travels: walls, mirrors, the water surface, edges, targets and errors of the device. */
inline RandomSonar withPaths(RandomSonar one, Draw& draw) {
    auto& p = one.properties;
    for (RandomObject& object : one.objects) {
        const int choice = draw.upTo(4);
        if (choice == 0) object.material.shell = {.thickness = 0.004, .density = 7800, .sound_speed = 5900};
        if (choice == 0) object.material.shell->shear_speed = 3200;
        if (choice == 1) object.material.mirror = true;
    }
    if (draw.once(2)) p["multipath"] = fmt::format("{{surface: {{wind_m_s: 3}}, bounces: {}}}", 1 + draw.upTo(2));
    if (draw.once(2)) p["effects"] = "{edge_diffraction: {min_turn_deg: 60}}";
    if (draw.once(2))
        p["imperfections"] = "{beam_gain_error_db: 1, dead_beam_share: 0.1, crosstalk_db: -25, clock_jitter_us: 20}";
    one.water_surface = 2.5;
    one.targets = {{{6, 0.5, 0.2}, -15}, {{9, -1, -0.3}, -25}};
    return one;
}

/** Calls `hold` with each drawn sonar, and with numbers for the property that it tests. */
inline void forEachSonar(uint64_t few, const std::function<void(const RandomSonar&, Draw&)>& hold) {
    const Seeds seeds(few);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        const RandomSonar one = randomSonar(seed);
        SCOPED_TRACE(fmt::format("seed {}\n{}", seed, one.text()));
        Draw more(1000 + seed);
        hold(one, more);
        if (testing::Test::HasFailure() && seeds.count == few) return;
    }
}

}  // namespace insonify::test
