// Properties that hold for every receiver and every noise: pings and settings are drawn from a seed.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "components/noise/Noise.hpp"
#include "components/noise/NoiseTask.hpp"
#include "components/receiver/Receiver.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "tests/support/Draw.hpp"
#include "tests/support/Pings.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::receiver {
namespace {

using test::Draw;
using Properties = std::map<std::string, std::string>;

/** Intensities, and the settings of what follows the sonar. */
struct Drawn {
    types::Sonar ping;
    Properties noise, receiver;

    std::string text() const {
        std::string text = fmt::format("{} beams, {} bins of {} m\n", ping.beam_count, ping.bin_count, ping.binWidth());
        for (const auto& [name, value] : noise) text += fmt::format("noise.{}: {}\n", name, value);
        for (const auto& [name, value] : receiver) text += fmt::format("receiver.{}: {}\n", name, value);
        return text;
    }
};

template <class Task>
auto getConfig(const Properties& properties) {
    Task task("task");
    task.properties().front()->setAll(properties);
    return *task.config;
}
types::Sonar received(const Properties& properties, const types::Sonar& ping) {
    types::Sonar result;
    Receiver(getConfig<ReceiverTask>(properties)).receive(ping, result);
    return result;
}
types::Sonar noisy(const Properties& properties, const types::Sonar& ping) {
    types::Sonar result;
    noise::Noise(getConfig<noise::NoiseTask>(properties)).add(ping, result);
    return result;
}

types::Sonar drawPing(Draw& draw) {
    types::Sonar ping = test::emptyPing(draw.between(1, 120), static_cast<uint32_t>(1 + draw.upTo(20)),
                                        static_cast<uint32_t>(20 + draw.upTo(600)));
    ping.time.microseconds = static_cast<int64_t>(draw.between(1, 1e15));
    ping.speed_of_sound = static_cast<float>(draw.between(1400, 1600));
    for (float& bin : ping.bins) bin = draw.once(8) ? 0.0f : static_cast<float>(std::pow(10, draw.between(-14, 2)));
    return ping;
}

Drawn drawnFrom(uint64_t seed) {
    Draw draw(seed);
    Drawn made{.ping = drawPing(draw), .noise = {}, .receiver = {}};
    auto& n = made.noise;
    n["seed"] = fmt::format("{}", draw.upTo(1000000));
    static constexpr const char* speckles[] = {"{law: rayleigh}", "{law: k, shape: 3}", "{law: gamma, looks: 5}",
                                               "{law: gaussian}"};
    const int speckle = draw.upTo(5);
    if (speckle < 4) n["speckle"] = speckles[speckle];
    if (draw.once(2)) n["ambient"] = fmt::format("{{level_db: {:.1f}}}", draw.between(-120, -20));
    if (draw.once(2) || n.size() == 1) n["additive"] = fmt::format("{{level_db: {:.1f}}}", draw.between(-120, -20));
    auto& r = made.receiver;
    static constexpr const char* outputs[] = {"intensity", "amplitude", "level_db", "received_level_db", "code"};
    r["output"] = outputs[draw.upTo(5)];
    if (draw.once(2)) r["gain_db"] = fmt::format("{:.2f}", draw.between(-60, 60));
    if (draw.once(2))
        r["tvg"] = fmt::format("{{log_coefficient: {:.2f}, db_per_m: {:.3f}, max_db: {:.1f}}}", draw.between(0, 50),
                               draw.between(0, 0.5), draw.between(10, 90));
    if (draw.once(2)) r["blanking"] = fmt::format("{{range_min: {:.3f}}}", draw.between(0, 20));
    if (draw.once(3)) r["saturation_db"] = fmt::format("{:.2f}", draw.between(-80, 20));
    if (r["output"] == "received_level_db") r["source_level_db"] = fmt::format("{:.1f}", draw.between(150, 230));
    static constexpr const char* laws[] = {"linear", "sqrt", "log"};
    if (r["output"] == "code")
        r["code"] = fmt::format("{{bits: {}, law: {}, full_scale_db: {:.2f}, dynamic_range_db: {:.2f}}}",
                                8 + draw.upTo(9), draw.oneOf(laws), draw.between(-80, 10), draw.between(20, 120));
    return made;
}

void forEachDrawn(const std::function<void(const Drawn&, Draw&)>& hold) {
    constexpr uint64_t few = 60;
    const test::Seeds seeds(few);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        const Drawn one = drawnFrom(seed);
        SCOPED_TRACE(fmt::format("seed {}\n{}", seed, one.text()));
        Draw more(1000 + seed);
        hold(one, more);
        if (testing::Test::HasFailure() && seeds.count == few) return;
    }
}

/** The output of one bin by the formulas of the page, in double [unit of the output]. */
double expected(const ReceiverConfig& config, double intensity, double r, bool is_blanked) {
    const double ceiling = config.saturation_db.value_or(1e9);
    const bool is_silent = is_blanked || intensity == 0;
    double level = 10 * std::log10(intensity) + config.gain_db + (config.tvg ? tvgDb(*config.tvg, r) : 0);
    level = is_silent ? -std::numeric_limits<double>::infinity() : std::min(level, ceiling);
    if (config.output == Output::Intensity) return std::pow(10, level / 10);
    if (config.output == Output::Amplitude) return std::pow(10, level / 20);
    if (config.output == Output::LevelDb) return std::max(level, -3000.0);
    if (config.output == Output::ReceivedLevelDb) return std::max(level + config.source_level_db, -3000.0);
    const CodeConfig code = config.code.value_or(CodeConfig{});
    const double maximum = (1 << code.bits) - 1, full = level - code.full_scale_db;
    double share = 1 + full / code.dynamic_range_db;
    if (code.law == CodeLaw::Linear) share = std::pow(10, full / 10);
    if (code.law == CodeLaw::Sqrt) share = std::pow(10, full / 20);
    return std::clamp(share, 0.0, 1.0) * maximum;
}

TEST(RandomReceiverTest, EachBinIsByTheFormulas) {
    forEachDrawn([](const Drawn& one, Draw&) {
        const auto config = getConfig<ReceiverTask>(one.receiver);
        const types::Sonar ping = received(one.receiver, one.ping);
        ASSERT_EQ(ping.bins.size(), one.ping.bins.size());
        for (size_t k = 0; k < ping.bins.size(); ++k) {
            const double bin = static_cast<double>(k % ping.bin_count);
            const bool is_blanked = config.blanking && ping.binStart(bin) < config.blanking->range_min * (1 - 1e-9);
            const double wanted = expected(config, double{one.ping.bins[k]}, ping.binStart(bin + 0.5), is_blanked);
            const double tolerance = config.output == Output::Code              ? 0.5 + 1e-5 * wanted + 1e-3
                                     : config.output == Output::LevelDb         ? 1e-3
                                     : config.output == Output::ReceivedLevelDb ? 1e-3
                                                                                : 1e-5 * wanted;
            ASSERT_NEAR(ping.bins[k], wanted, tolerance) << "bin " << k;
            const bool is_whole = ping.bins[k] == std::round(ping.bins[k]);
            ASSERT_TRUE(config.output != Output::Code || is_whole) << ping.bins[k];
        }
    });
}

TEST(RandomReceiverTest, LouderEchoesAreNeverWeakerInTheOutput) {
    forEachDrawn([](const Drawn& one, Draw& draw) {
        types::Sonar louder = one.ping;
        const float factor = static_cast<float>(draw.between(1, 3));
        for (float& bin : louder.bins) bin *= factor;
        const auto loud = received(one.receiver, louder).bins, soft = received(one.receiver, one.ping).bins;
        for (size_t k = 0; k < loud.size(); ++k) ASSERT_GE(loud[k], soft[k]) << "bin " << k;
    });
}

/** Beams change places with the echoes in them, also with automatic gain, which follows the mean of the beams. */
TEST(RandomReceiverTest, TheOrderOfBeamsDoesNotMatter) {
    forEachDrawn([](const Drawn& one, Draw& draw) {
        Properties receiver = one.receiver;
        if (draw.once(2)) receiver["automatic_gain"] = "{target_db: -30}";
        const auto reversed = [](types::Sonar ping) {
            for (uint32_t beam = 0; beam < ping.beam_count / 2; ++beam)
                std::swap_ranges(ping.bins.begin() + beam * ping.bin_count,
                                 ping.bins.begin() + (beam + 1) * ping.bin_count,
                                 ping.bins.end() - (beam + 1) * ping.bin_count);
            return ping;
        };
        const auto there = received(receiver, one.ping).bins,
                   back = reversed(received(receiver, reversed(one.ping))).bins;
        const float step = receiver["output"] == "code" ? 1.0f : 0.0f;
        for (size_t k = 0; k < there.size(); ++k)
            ASSERT_NEAR(there[k], back[k], 1e-5f * std::abs(there[k]) + step) << "bin " << k;
    });
}

/** A ping with fewer bins, and one after another, has the same noise where both have bins. */
TEST(RandomReceiverTest, NoiseDoesNotDependOnTheSizeOfThePingOrOnPingsBefore) {
    forEachDrawn([](const Drawn& one, Draw&) {
        types::Sonar shorter = one.ping;
        shorter.bin_count = one.ping.bin_count / 2;
        shorter.bins.resize(size_t{shorter.bin_count} * shorter.beam_count);
        for (size_t k = 0; k < shorter.bins.size(); ++k)
            shorter.bins[k] = one.ping.bins[k / shorter.bin_count * one.ping.bin_count + k % shorter.bin_count];
        noise::Noise adding(getConfig<noise::NoiseTask>(one.noise));
        types::Sonar first, second;
        adding.add(one.ping, first);
        adding.add(shorter, second);
        for (size_t k = 0; k < second.bins.size(); ++k)
            ASSERT_EQ(second.bins[k], first.bins[k / shorter.bin_count * one.ping.bin_count + k % shorter.bin_count]);
        adding.add(one.ping, second);
        EXPECT_EQ(second.bins, first.bins);
    });
}

TEST(RandomReceiverTest, NoiseAndEchoesScaleTogether) {
    forEachDrawn([](const Drawn& one, Draw&) {
        Properties louder = one.noise;
        for (const char* name : {"ambient", "additive"})
            if (louder.contains(name)) {
                const auto config = getConfig<noise::NoiseTask>(one.noise);
                const double level = name[1] == 'm' ? *config.ambient->level_db : config.additive->level_db;
                louder[name] = fmt::format("{{level_db: {:.17g}}}", level + 20);
            }
        types::Sonar ping = one.ping;
        for (float& bin : ping.bins) bin *= 100;
        const auto loud = noisy(louder, ping).bins, soft = noisy(one.noise, one.ping).bins;
        for (size_t k = 0; k < loud.size(); ++k) ASSERT_NEAR(loud[k], 100 * soft[k], 1e-3 * loud[k]) << "bin " << k;
    });
}

/** Automatic gain with random settings, which reaches every level of drawPing() where `max_db` permits. */
Properties withAutomaticGain(const Drawn& one, Draw& draw, const std::string& output, double max_db) {
    Properties receiver = one.receiver;
    receiver.erase("saturation_db");
    receiver["output"] = output;
    receiver["automatic_gain"] = fmt::format(
        "{{target_db: {:.2f}, attack_ms: {:.3f}, release_ms: {:.3f}, max_db: {:.9g}}}", draw.between(-80, 20),
        draw.once(3) ? 0 : draw.between(0, 10), draw.once(3) ? 0 : draw.between(0, 50), max_db);
    return receiver;
}
Properties without(const char* key, Properties properties) {
    properties.erase(key);
    return properties;
}

/** One gain for all beams of a bin, of at most max_db, up or down. */
TEST(RandomReceiverTest, AutomaticGainIsBoundedAndKeepsTheDifferencesOfBeams) {
    forEachDrawn([](const Drawn& one, Draw& draw) {
        const double max_db = draw.once(4) ? 0 : draw.between(0, 60);
        const Properties receiver = withAutomaticGain(one, draw, "level_db", max_db);
        const auto got = received(receiver, one.ping).bins,
                   plain = received(without("automatic_gain", receiver), one.ping).bins;
        std::vector<double> gain(one.ping.bin_count, NAN);
        for (size_t i = 0; i < got.size(); ++i) {
            if (plain[i] <= -3000) {
                ASSERT_EQ(got[i], plain[i]) << "bin " << i << " is silent";
                continue;
            }
            const double here = got[i] - plain[i];
            double& of_bin = gain[i % one.ping.bin_count];
            ASSERT_LE(std::abs(here), max_db + 1e-3) << "bin " << i;
            ASSERT_TRUE(std::isnan(of_bin) || std::abs(here - of_bin) < 1e-3) << "bin " << i;
            of_bin = here;
            ASSERT_TRUE(max_db > 0 || got[i] == plain[i]) << "bin " << i << ": a bound of 0 dB changes no bit";
        }
    });
}

/** Where it is not at its bound, the mean of the beams is that of the target at once or in the times of its setting,
 * and a louder sea changes nothing. */
TEST(RandomReceiverTest, AutomaticGainMovesWithItsTargetAndNotWithTheLevel) {
    forEachDrawn([](const Drawn& one, Draw& draw) {
        Properties receiver = withAutomaticGain(one, draw, "level_db", 1000);
        const auto got = received(receiver, one.ping).bins;
        types::Sonar louder = one.ping;
        const float factor = static_cast<float>(draw.between(1, 100));
        for (float& bin : louder.bins) bin *= factor;
        const auto loud = received(receiver, louder).bins;
        Properties raised = receiver;
        const double target = std::stod(receiver["automatic_gain"].substr(12)), rise = draw.between(0, 30);
        raised["automatic_gain"].replace(12, receiver["automatic_gain"].find(',') - 12,
                                         fmt::format("{:.6f}", target + rise));
        const auto high = received(raised, one.ping).bins;
        for (size_t i = 0; i < got.size(); ++i) {
            const bool is_silent = got[i] <= -3000;
            ASSERT_NEAR(loud[i], got[i], 2e-3) << "bin " << i;
            ASSERT_NEAR(high[i], is_silent ? got[i] : got[i] + rise, 2e-3) << "bin " << i;
        }
        receiver["automatic_gain"] =
            fmt::format("{{target_db: {}, attack_ms: 0, release_ms: 0, max_db: 1000}}", target);
        const types::Sonar level = received(receiver, one.ping);
        for (uint32_t k = 0; k < level.bin_count; ++k) {
            double mean = 0;
            for (uint32_t beam = 0; beam < level.beam_count; ++beam)
                mean += std::pow(10, level.bins[beam * level.bin_count + k] / 10.0) / level.beam_count;
            const bool is_silent = mean < 1e-290;
            ASSERT_NEAR(is_silent ? target : 10 * std::log10(mean), target, 1e-3) << "bin " << k;
        }
    });
}

/** By the formula of the page, with the gain at 0.5 the neutral value of published pings. */
TEST(RandomReceiverTest, BrightnessIsBetweenZeroAndOneAndRisesWithGainAndEcho) {
    forEachDrawn([](const Drawn& one, Draw& draw) {
        const types::Sonar& ping = one.ping;
        const bool is_physical = draw.once(2);
        const double gain = draw.once(4) ? 0.5 : draw.between(0, 1), more = draw.between(gain, 1);
        const auto shown = [&](double at, const types::Sonar& of) {
            return received({{"brightness", fmt::format("{{gain: {:.17g}, model: {}}}", at,
                                                        is_physical ? "physical" : "cerqueira2017")}},
                            of)
                .bins;
        };
        types::Sonar louder = ping;
        for (float& bin : louder.bins) bin *= static_cast<float>(draw.between(1, 3));
        const auto bins = shown(gain, ping), brighter = shown(more, ping), loud = shown(gain, louder),
                   dark = shown(0, ping), neutral = shown(0.5, ping);
        const double cell = std::pow(10, types::Material{}.lambert_db / 10.0) * ping.beam_width.rad * ping.binWidth();
        for (size_t i = 0; i < bins.size(); ++i) {
            const double r = ping.binStart(static_cast<double>(i % ping.bin_count) + 0.5);
            const double scale = 2 * gain * (is_physical ? r * r * r / cell : 1);
            ASSERT_NEAR(bins[i], std::min(1.0, scale * double{ping.bins[i]}), 1e-5) << "bin " << i;
            ASSERT_TRUE(bins[i] >= 0 && bins[i] <= 1) << "bin " << i << " is " << bins[i];
            ASSERT_TRUE(brighter[i] >= bins[i] && loud[i] >= bins[i] && dark[i] == 0) << "bin " << i;
            ASSERT_TRUE(is_physical || neutral[i] == std::min(1.0f, ping.bins[i])) << "bin " << i;
        }
    });
}

/** Values that mean that nothing happens, by key; a value for every key that has one. */
const std::map<std::string, std::vector<const char*>>& receiverNeutrals() {
    static const std::map<std::string, std::vector<const char*>> all = {
        {"tvg", {"{}", "{log_coefficient: 0, db_per_m: 0}", "{max_db: 1000}"}},
        {"gain_db", {"0"}},
        {"blanking", {"{}", "{range_min: 0}"}},
        {"source_level_db", {"0"}},
        {"code", {"{}"}},
        {"saturation_db", {"1000"}},
        {"automatic_gain", {"{max_db: 0}"}},
    };
    return all;
}
const std::map<std::string, std::vector<const char*>>& noiseNeutrals() {
    static const std::map<std::string, std::vector<const char*>> all = {
        {"speckle", {"{law: gaussian, mean: 1, deviation: 0}"}},
        {"ambient", {"{level_db: -3000}"}},
        {"additive", {"{level_db: -3000}"}},
        {"filter", {"{}", "{looks: 1}"}},
    };
    return all;
}

TEST(RandomReceiverTest, NeutralValuesChangeNoBit) {
    std::set<std::string> tried;
    forEachDrawn([&](const Drawn& one, Draw&) {
        const auto plain = received(one.receiver, one.ping).bins;
        for (const auto& [key, values] : receiverNeutrals())
            for (const char* value : values) {
                if (one.receiver.contains(key)) continue;
                Properties with = one.receiver;
                with[key] = value;
                tried.insert(key);
                EXPECT_TRUE(received(with, one.ping).bins == plain) << "receiver " << key << ": " << value;
            }
        const auto noise = noisy(one.noise, one.ping).bins;
        for (const auto& [key, values] : noiseNeutrals())
            for (const char* value : values) {
                const bool is_field = !one.noise.contains("speckle") || one.noise.at("speckle").find("law: ga") > 9;
                if (one.noise.contains(key) || (key == "filter" && !is_field)) continue;
                Properties with = one.noise;
                with[key] = value;
                tried.insert(key);
                EXPECT_TRUE(noisy(with, one.ping).bins == noise) << "noise " << key << ": " << value;
            }
    });
    for (const auto& [key, values] : receiverNeutrals()) EXPECT_TRUE(tried.contains(key)) << key;
    for (const auto& [key, values] : noiseNeutrals()) EXPECT_TRUE(tried.contains(key)) << key;
    ReceiverTask receiver("receiver");
    for (const auto& property : receiver.properties().front()->list())
        EXPECT_TRUE(property.name.find('.') != std::string::npos || receiverNeutrals().contains(property.name) ||
                    property.name == "output" || property.name == "brightness")  // both are scales
            << property.name << " needs a neutral value here, or a reason for having none";
    noise::NoiseTask task("noise");
    for (const auto& property : task.properties().front()->list())
        EXPECT_TRUE(property.name.find('.') != std::string::npos || noiseNeutrals().contains(property.name) ||
                    property.name == "seed")
            << property.name;
}

}  // namespace
}  // namespace insonify::receiver
