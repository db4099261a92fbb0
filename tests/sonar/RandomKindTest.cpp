// Properties that hold for every kind of sonar: sonars and scenes are drawn from a seed, and a failure prints both.
#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "tests/support/Pings.hpp"
#include "tests/support/RandomSonars.hpp"
#include "tests/support/Sonars.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::sonar {
namespace {

using test::Draw;
using test::forEachSonar;
using test::getBins;
using test::Kind;
using test::RandomObject;
using test::RandomSonar;
using test::relativeL2;

constexpr uint64_t few = 12;  ///< Sonars for each property: two of each kind.

void expectAlike(const std::vector<float>& got, const std::vector<float>& expected, double tolerance,
                 const char* what = "") {
    ASSERT_EQ(got.size(), expected.size());
    const bool is_empty = std::ranges::all_of(expected, [](float bin) { return bin == 0; });
    const double sum = std::accumulate(got.begin(), got.end(), 0.0);
    size_t worst = 0;
    const auto off = [&](size_t k) { return std::abs(got[k] - expected[k]); };
    for (size_t k = 0; k < got.size(); ++k)
        if (off(k) > off(worst)) worst = k;
    EXPECT_LE(is_empty ? sum : relativeL2(got, expected), is_empty ? 0 : tolerance)
        << what << " bin " << worst << " is " << got[worst] << " rather than " << expected[worst];
}

TEST(RandomKindTest, PingsOfEveryKindHaveEchoes) {
    std::map<Kind, int> with_echoes;
    forEachSonar(4 * test::kinds, [&](const RandomSonar& one, Draw&) {
        RandomSonar dry = one;
        dry.properties.erase("volume");
        dry.properties.erase("pulse");
        const auto bins = getBins(dry, one.scene());
        with_echoes[one.kind] += std::accumulate(bins.begin(), bins.end(), 0.0) > 0;
    });
    for (int kind = 0; kind < test::kinds; ++kind) EXPECT_GE(with_echoes[static_cast<Kind>(kind)], 1) << kind;
}

/** The beams of a fan and the pings of a scan change places. */
TEST(RandomKindTest, TheMirrorImageOfASceneHasTheMirrorImageOfItsPings) {
    forEachSonar(few, [](const RandomSonar& drawn, Draw&) {
        if (drawn.is_coherent) return;  // its scatterers are not mirrored
        RandomSonar one = drawn;
        const bool has_pattern = one.properties.contains("beam_pattern");  // whose columns begin at one side
        if (has_pattern) one.properties["quality"] = "{rows: 48, columns_per_beam: 48}";
        std::vector<RandomObject> objects = one.objects;
        for (RandomObject& object : objects) {
            for (glm::vec3& p : object.mesh.positions) p.y = -p.y;
            for (size_t i = 0; i < object.mesh.indices.size(); i += 3)
                std::swap(object.mesh.indices[i + 1], object.mesh.indices[i + 2]);
            for (types::Cluster& cluster : object.mesh.clusters) cluster.centre.y = -cluster.centre.y;
            object.place.y = -object.place.y;
        }
        std::vector<types::Sonar> mirrored = test::SonarBench(one).getPings(RandomSonar::makeScene(objects));
        std::ranges::reverse(mirrored);
        for (types::Sonar& ping : mirrored)
            for (uint32_t beam = 0; beam < ping.beam_count / 2; ++beam)
                std::swap_ranges(ping.bins.begin() + beam * ping.bin_count,
                                 ping.bins.begin() + (beam + 1) * ping.bin_count,
                                 ping.bins.end() - (beam + 1) * ping.bin_count);
        expectAlike(getBins(mirrored), getBins(one, one.scene()), has_pattern ? 0.1 : 0.01);
    });
}

/** The renderer keeps its data of the scene when properties change. */
TEST(RandomKindTest, ASonarWhosePropertiesChangePingsAsOneMadeWithThem) {
    forEachSonar(2 * few, [](const RandomSonar& drawn, Draw& draw) {
        RandomSonar from = drawn, to = test::randomSonar(static_cast<uint64_t>(drawn.kind) + 6000 +
                                                         static_cast<uint64_t>(draw.upTo(100) * test::kinds));
        if (draw.once(2)) from = withPaths(from, draw);
        if (draw.once(2)) to = withPaths(to, draw);
        if (drawn.kind == Kind::Scanning) to.properties["head"] = from.properties["head"];  // stays where it is
        RandomSonar nearer = to;
        nearer.properties["range"] = fmt::format("{:.3f}", draw.between(8, 40));
        nearer.properties["speed_of_sound"] = fmt::format("{:.2f}", draw.between(1400, 1560));
        nearer.properties["frequency_khz"] = fmt::format("{:.1f}", draw.between(100, 900));
        const types::Snapshot scene = from.scene();
        const bool with_truth = draw.once(2);
        test::SonarBench changed(from, 2, with_truth);
        changed.getPings(scene);
        int turns = 1;  // of a head, which goes on where it is
        const RandomSonar* before = &from;
        for (const RandomSonar* now : {&to, &nearer, &from}) {
            test::SonarBench made(*now, 2, with_truth);
            for (int turn = 0; turn < turns; ++turn) made.getPings(scene);
            changed.change(*before, *now);
            expectAlike(getBins(changed.getPings(scene)), getBins(made.getPings(scene)), 0);
            EXPECT_TRUE(!with_truth || test::getBits(*changed.truth) == test::getBits(*made.truth)) << "truth";
            before = now;
            ++turns;
        }
    });
}

TEST(RandomKindTest, TheOrderOfObjectsChangesNoBit) {
    forEachSonar(few, [](const RandomSonar& drawn, Draw& draw) {
        for (const RandomSonar& one : {drawn, withPaths(drawn, draw)}) {
            std::vector<RandomObject> objects = one.objects;
            std::ranges::reverse(objects);
            if (draw.once(2)) std::swap(objects[0], objects[1]);
            expectAlike(getBins(one, one.with(objects)), getBins(one, one.scene()), 0);
        }
    });
}

/** Poses whose directions have components that are rounding, as those of a level sonar that is turned. */
TEST(RandomKindTest, APoseThatIsLevelButForRoundingIsLevel) {
    SonarConfig config =
        test::getSonar({.beams = 8, .width_deg = 80, .height_deg = 30, .bins = 150, .rows = 63, .columns = 6});
    config.visibility = Visibility::Cpu;
    std::vector<types::Mesh> meshes;
    std::vector<glm::dvec3> places;
    for (int i = 0; i < 5; ++i) {
        meshes.push_back(test::quad({0, -0.5f, -0.4f}, {0.1f, 1, 0}, {0.05f, 0, 0.8f}));
        places.push_back({6 + i, 2.0 * i - 4, 0.1 * i - 0.2});
    }
    types::Snapshot scene = test::makeSnapshot(test::makeScene(meshes, 0, places));
    const types::Sonar level = test::makePing(config, scene);
    for (const double exponent : {-16.0, -17.0, -17.7, -18.0, -18.3, -19.0, -25.0})
        for (const double sign : {-1.0, 1.0})
            for (const glm::dvec3 axis : {glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0)}) {
                scene.sonar.orientation = glm::dquat(1, sign * std::pow(10, exponent) * axis);
                expectAlike(test::makePing(config, scene).bins, level.bins, 1e-6);
            }
}

/** Speckle too: a pair of scenes with and without a thing has common speckle. */
TEST(RandomKindTest, AnObjectOutOfRangeChangesNoBit) {
    forEachSonar(few, [](const RandomSonar& drawn, Draw& draw) {
        for (const RandomSonar& one : {drawn, withPaths(drawn, draw)}) {
            std::vector<RandomObject> objects = one.objects;
            RandomObject far = drawn.objects[0];
            far.name = "far";
            far.place = glm::dvec3(draw.between(50, 200), draw.between(-20, 20), draw.between(-20, 20));
            objects.insert(objects.begin() + draw.upTo(static_cast<int>(objects.size())), far);
            expectAlike(getBins(one, one.with(objects)), getBins(one, one.scene()), 0);
        }
    });
}

void expectThatEnergiesAdd(RandomSonar one) {
    if (one.is_coherent) return;                                                           // fields add
    one.properties.erase("volume");                                                        // objects hide water
    if (one.properties.contains("pulse")) one.properties["pulse"] = "{duration_us: 200}";  // rings once
    const auto together = getBins(one, one.scene());
    std::vector<float> sum(together.size(), 0);
    for (const RandomObject& object : one.objects) {
        const auto alone = getBins(one, RandomSonar::makeScene({object}));
        for (size_t k = 0; k < sum.size(); ++k) sum[k] += alone[k];
    }
    expectAlike(together, sum, 1e-4);
}

TEST(RandomKindTest, EnergiesOfObjectsThatDoNotHideEachOtherAdd) {
    forEachSonar(few, [](const RandomSonar& one, Draw&) { expectThatEnergiesAdd(one); });
    for (const uint64_t seed : {94, 136}) expectThatEnergiesAdd(test::randomSonar(seed));  // directions near an axis
}

TEST(RandomKindTest, ThreadsChangeNoBit) {
    forEachSonar(few, [](const RandomSonar& drawn, Draw& draw) {
        for (const RandomSonar& one : {drawn, withPaths(drawn, draw)}) {
            const auto single = getBins(one, one.scene(), 1);
            for (const int threads : {2, 5})
                EXPECT_TRUE(getBins(one, one.scene(), threads) == single) << threads << " threads\n" << one.text();
        }
    });
}

/** The world turns and moves, as far as float positions are exact. */
TEST(RandomKindTest, PingsDoNotDependOnWhereTheWorldsAxesAre) {
    int with_echoes = 0, all = 0;
    forEachSonar(4 * test::kinds, [&](const RandomSonar& drawn, Draw& draw) {
        RandomSonar one = drawn;
        if (one.is_coherent) one.properties.erase("volume");  // the scatterers of the water stay in the world
        const types::Snapshot scene = one.scene();
        const glm::dquat turn = glm::angleAxis(draw.between(-3, 3), glm::normalize(glm::dvec3(0.2, -0.1, 1)));
        const glm::dvec3 way(draw.between(-100, 100), draw.between(-100, 100), draw.between(-20, 20));
        types::Snapshot turned = scene;
        auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
        for (types::Object& object : geometry->objects) {
            object.world_from_object = glm::mat4_cast(turn) * object.world_from_object;
            object.world_from_object[3] += glm::dvec4(way, 0);
        }
        turned.geometry = geometry;
        turned.sonar.position = turn * scene.sonar.position + way;
        turned.sonar.orientation = turn * scene.sonar.orientation;
        const auto expected = getBins(one, scene);
        expectAlike(getBins(one, turned), expected, one.is_coherent ? 0.05 : 0.01);
        with_echoes += std::ranges::any_of(expected, [](float bin) { return bin > 0; });
        ++all;
    });
    EXPECT_GE(2 * with_echoes, all);
}

TEST(RandomKindTest, TheOrderOfBeamsDoesNotChangeThem) {
    int fans = 0;
    forEachSonar(8 * test::kinds, [&](const RandomSonar& one, Draw& draw) {
        if (one.kind != Kind::Fan) return;  // others have no list of bearings
        RandomSonar listed = one;
        const int beams = 2 + draw.upTo(6);
        std::string there, back;
        for (int k = 0; k < beams; ++k) {
            const std::string bearing = fmt::format("{:.3f}", -50 + 100.0 * k / beams);
            there += (k > 0 ? ", " : "") + bearing;
            back = bearing + (k > 0 ? ", " : "") + back;
        }
        for (const char* replaced : {"beam_count", "field_of_view_deg"}) listed.properties.erase(replaced);
        listed = listed.with("beam_width_deg", "6").with("bearings_deg", "[" + there + "]");
        types::Sonar ping = test::SonarBench(listed.with("bearings_deg", "[" + back + "]")).getPings(one.scene())[0];
        for (uint32_t beam = 0; beam < ping.beam_count / 2; ++beam)
            std::swap_ranges(ping.bins.begin() + beam * ping.bin_count, ping.bins.begin() + (beam + 1) * ping.bin_count,
                             ping.bins.end() - (beam + 1) * ping.bin_count);
        expectAlike(ping.bins, getBins(listed, one.scene()), 1e-5);
        ++fans;
    });
    EXPECT_GT(fans, 0);
}

/** A world in another unit of length: E/S0 falls with the square of it, where nothing is given in metres. */
TEST(RandomKindTest, AScaledWorldHasTheSamePictures) {
    forEachSonar(few, [](const RandomSonar& drawn, Draw& draw) {
        if (drawn.is_coherent) return;  // the lattice of scatterers has steps of its own
        RandomSonar one = drawn;
        for (const char* metric : {"volume", "absorption"}) one.properties.erase(metric);
        one.properties["range_rounding"] = "exact";
        one.properties["range_min"] = "0.5";
        for (RandomObject& object : one.objects) object.material.seabed.clear();  // laws of frequencies in kHz
        if (one.properties.contains("pulse")) one.properties["pulse"] = "{duration_us: 200}";
        const double scale = std::exp2(1 + draw.upTo(3));
        RandomSonar other = one;
        for (const char* length : {"range", "range_min", "speed_of_sound"})
            other.properties[length] = fmt::format("{:.17g}", scale * std::stod(one.properties[length]));
        for (RandomObject& object : other.objects) {
            object.place *= scale;
            for (glm::vec3& p : object.mesh.positions) p *= static_cast<float>(scale);
            for (types::Cluster& cluster : object.mesh.clusters) {
                cluster.centre *= static_cast<float>(scale);
                cluster.half *= static_cast<float>(scale);
            }
        }
        auto bins = getBins(other, other.scene());
        for (float& bin : bins) bin *= static_cast<float>(scale * scale);
        expectAlike(bins, getBins(one, one.scene()), 1e-3);
    });
}

/** Splits each flat object along a line at random, and gives both parts the same material. */
TEST(RandomKindTest, AFlatObjectIsHeardAlikeInTwoParts) {
    forEachSonar(few, [](const RandomSonar& one, Draw& draw) {
        if (one.is_coherent) return;
        std::vector<RandomObject> whole, parts;
        bool has_lobes = false;
        for (const RandomObject& object : one.objects) {
            has_lobes = has_lobes || object.material.reflection > 0;
            const double size = draw.between(0.15, 0.4), at = draw.between(0.2, 0.8);
            const glm::vec3 low(0, -size, -size), a(draw.between(-0.2, 0.2), 2 * size, 0),
                b(draw.between(-0.2, 0.2), 0, 2 * size), there = static_cast<float>(at) * a;
            whole.push_back(object);
            whole.back().mesh = test::quad(low, a, b);
            for (int part = 0; part < 2; ++part) {
                parts.push_back(object);
                parts.back().name += part == 0 ? "_right" : "_left";
                parts.back().mesh = part == 0 ? test::quad(low, there, b) : test::quad(low + there, a - there, b);
            }
        }
        // The lobe of a smooth surface is integrated facet by facet, and is narrower than few columns of samples.
        expectAlike(getBins(one, RandomSonar::makeScene(parts)), getBins(one, RandomSonar::makeScene(whole)),
                    has_lobes ? 0.2 : 1e-4);
    });
}

/** Scatterers are numbered by the name of their object: two parts have other speckle, of the same mean. */
TEST(RandomKindTest, AFlatObjectInTwoPartsHasOtherSpeckleOfTheSameMean) {
    SonarConfig config =
        test::getSonar({.beams = 8, .width_deg = 16, .height_deg = 12, .bins = 120, .rows = 48, .columns = 12});
    config.visibility = Visibility::Cpu;
    config.frequency_khz = 300;
    config.speckle.emplace().coherent = true;
    const auto computeMean = [&](const std::vector<std::pair<const char*, types::Mesh>>& parts,
                                 const std::string& drawn, double& mean) {
        std::vector<types::Mesh> meshes;
        for (const auto& part : parts) meshes.push_back(part.second);
        auto geometry = std::make_shared<types::Geometry>(*test::makeScene(meshes));
        for (size_t i = 0; i < parts.size(); ++i) geometry->objects[i].name = parts[i].first + drawn;
        const types::Sonar ping = test::makePing(config, test::makeSnapshot(geometry));
        mean += test::computeSum(ping);
        return ping.bins;
    };
    const glm::vec3 low(8, -1, -0.8f), across(0.6f, 2, 0), up(0.2f, 0, 1.6f), half = 0.4f * across;
    double whole = 0, parts = 0;
    for (int i = 0; i < 150; ++i) {
        const auto one = computeMean({{"whole", test::quad(low, across, up)}}, std::to_string(i), whole);
        const auto two =
            computeMean({{"right", test::quad(low, half, up)}, {"left", test::quad(low + half, across - half, up)}},
                        std::to_string(i), parts);
        EXPECT_NE(one, two);
    }
    EXPECT_NEAR(parts / whole, 1, 0.05);
}

/** The object in a bin reaches into the bin's ranges. */
TEST(RandomKindTest, TheTruthOfABinIsAnObjectWithinItsRange) {
    forEachSonar(few, [](const RandomSonar& one, Draw&) {
        test::SonarBench bench(one, 2, true);
        const types::Sonar ping = bench.getPings(one.scene()).back();
        ASSERT_TRUE(bench.truth);
        const types::SonarTruth& truth = *bench.truth;
        ASSERT_EQ(truth.diagnostic(), nullptr);
        EXPECT_EQ(ping.bins, test::SonarBench(one, 2).getPings(one.scene()).back().bins) << "truth changes no bit";
        for (size_t k = 0; k < truth.object.size(); ++k) {
            if (truth.object[k] < 0) continue;
            const RandomObject& object = one.objects[static_cast<size_t>(truth.object[k])];
            ASSERT_EQ(truth.objects[static_cast<size_t>(truth.object[k])], object.name);
            double nearest = 1e9, farthest = 0;
            for (const glm::vec3& p : object.mesh.positions) {
                const double range = glm::length(object.place + glm::dvec3(p));
                nearest = std::min(nearest, range);
                farthest = std::max(farthest, range);
            }
            const uint32_t bin = static_cast<uint32_t>(k % truth.bin_count);
            // A facet is nearer in its middle than at its corners.
            ASSERT_GE(ping.binStart(bin + 1), nearest - 0.1) << "bin " << bin;
            ASSERT_LE(ping.binStart(bin), farthest + 1e-3) << "bin " << bin;
            ASSERT_GT(truth.share[k], 0);
            ASSERT_LE(truth.share[k], 1.0001);
        }
    });
}

/** A value of a key that means that it does nothing, for sonars for which `holds`. */
struct Neutral {
    const char* key;
    const char* value;
    bool (*holds)(const RandomSonar&) = [](const RandomSonar&) { return true; };
};

bool hasNoPulse(const RandomSonar& one) { return !one.properties.contains("pulse"); }
bool hasNoVolume(const RandomSonar& one) { return !one.properties.contains("volume"); }
bool hasNoAbsorption(const RandomSonar& one) { return !one.properties.contains("absorption"); }
bool isOfEnergies(const RandomSonar& one) { return !one.is_coherent; }

const std::vector<Neutral>& neutrals() {
    static const std::vector<Neutral> all = {
        {"absorption", "{db_per_m: 0}", hasNoAbsorption},
        {"volume", "[]", hasNoVolume},
        {"volume", "{strength_db: -200}", hasNoVolume},
        {"volume", "[{bottom_m: 2, strength_db: -200}, {top_m: 2, strength_db: -200}]", hasNoVolume},
        {"pulse", "{duration_us: 0.1}", hasNoPulse},
        {"pulse", "{duration_us: 0.1, ring_down: {level_db: -3000, decay_db_per_m: 1}}", hasNoPulse},
        {"motion_in_ping", "false"},
        {"motion_in_ping", "true", isOfEnergies},  // nothing moves
        {"speckle", "{coherent: false}", isOfEnergies},
        {"speckle", "{coherent: false, scatterers_per_cell: 50}", isOfEnergies},
        {"multipath", "{bounces: 0}"},
        {"multipath", "{bounces: 1}"},  // nothing is a mirror
        {"multipath", "{surface: {wind_m_s: 5}, bounces: 0}"},
        {"max_walls", "4"},
        {"max_walls", "0"},  // nothing is a wall
        {"max_walls", "16"},
        {"imperfections", "{}"},
        {"imperfections",
         "{seed: 9, elements: 64, gain_error_db: 0, phase_error_deg: 0, dead_element_share: 0, "
         "dead_elements: [], beam_gain_error_db: 0, dead_beam_share: 0, dead_beams: [], "
         "clock_jitter_us: 0}"},
        {"imperfections", "{crosstalk_db: -200}"},
        {"crosstalk", "{}"},
        {"crosstalk", "{echoes: false, rejection_db: 300, source_level_db: 200}"},
        {"effects", "{}"},
        {"water", "{}", hasNoAbsorption},
        {"water", "{temperature_celsius: 25, salinity_psu: 5, depth: 300, ph: 7.7, latitude_deg: 10}"},
        {"published", "false"},
        {"draw_all", "true"},
        {"deposit", "cpu"},
        {"deposit", "auto"},
        {"device", "''"},
        {"model", "physical"},
        {"bearings_deg", "[]"},
        {"beam_width_convention", "total_fov", [](const RandomSonar& one) { return one.kind != Kind::Altimeter; }},
        {"detection", "{threshold_db: -10, floor_db: 10, gate_db: 3}"},
        {"head", "{speed_deg_per_s: 1e6, sweeps: false}"},
    };
    return all;
}

TEST(RandomKindTest, NeutralValuesChangeNoBit) {
    std::map<std::string, int> tried;
    forEachSonar(few, [&](const RandomSonar& one, Draw&) {
        const auto plain = getBins(one, one.scene());
        framework::Registry registry;
        registerTasks(registry);
        std::set<std::string> known;
        for (const auto& property : registry.make(one.type(), "x")->properties().front()->list())
            known.insert(property.name);
        for (const Neutral& neutral : neutrals()) {
            if (!known.contains(neutral.key) || !neutral.holds(one)) continue;
            RandomSonar with = one;
            std::string& value = with.properties[neutral.key];
            if (neutral.key == std::string("head"))
                value.insert(value.size() - 1, std::string(", ") + (neutral.value + 1)), value.pop_back();
            else
                value = neutral.value;
            std::vector<float> got;
            try {
                got = getBins(with, one.scene());
            } catch (const types::ConfigError& error) {
                ADD_FAILURE() << neutral.key << ": " << neutral.value << ": " << error.what();
                continue;
            }
            ++tried[fmt::format("{}: {}", neutral.key, neutral.value)];
            EXPECT_TRUE(got == plain) << neutral.key << ": " << neutral.value << " changes " << relativeL2(got, plain);
        }
    });
    for (const Neutral& neutral : neutrals())
        EXPECT_GT(tried[fmt::format("{}: {}", neutral.key, neutral.value)], 0) << neutral.key << " was never tried";
}

/** The default of a key, written out, is the key's absence; each key has a default, a neutral value, or none. */
TEST(RandomKindTest, DefaultsThatAreWrittenOutChangeNoBit) {
    static const std::set<std::string> without_neutral = {
        // what a sonar is: its grid, its beams, its water
        "range", "range_min", "bin_count", "beam_count", "beam_height_deg", "field_of_view_deg", "beam_width_deg",
        "speed_of_sound", "frequency_khz", "quality", "floor_db", "max_gap_db", "beam_pattern", "horizontal",
        "vertical", "depression_deg",
        // writes signals on a port
        "elements"};
    forEachSonar(few, [&](const RandomSonar& one, Draw&) {
        framework::Registry registry;
        registerTasks(registry);
        RandomSonar with = one;
        for (const auto& property : registry.make(one.type(), "x")->properties().front()->list()) {
            if (property.name.find('.') != std::string::npos || property.name.find('[') != std::string::npos) continue;
            const bool is_neutral =
                std::ranges::any_of(neutrals(), [&](const Neutral& each) { return each.key == property.name; });
            EXPECT_TRUE(is_neutral || !property.default_value.empty() || without_neutral.contains(property.name))
                << property.name << " needs a neutral value here, or a reason for having none";
            if (!property.default_value.empty() && property.name != "visibility")
                with.properties.try_emplace(property.name, property.default_value);
        }
        EXPECT_TRUE(getBins(with, one.scene()) == getBins(one, one.scene()));
    });
}

}  // namespace
}  // namespace insonify::sonar
