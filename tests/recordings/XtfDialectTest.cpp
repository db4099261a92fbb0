// XTF files that declare other channels than they describe, or whose sides and pings are uneven: made here at random,
// and two given ones.
#include <gmock/gmock.h>

#include <cmath>
#include <optional>

#include "components/recordings/XtfLayout.hpp"
#include "tests/recordings/RecordedFileTest.hpp"
#include "tests/support/Draw.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::recordings {
namespace {

using test::Draw, test::putAt;
using testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty, testing::Not, testing::SizeIs;
namespace info = xtf::channel_info;

/** A channel as the header of a file describes it. */
struct Described {
    uint8_t type, format;
    uint16_t legacy_bytes;
    size_t bytes() const {
        if (format == info::legacy) return legacy_bytes;
        return format == info::int8 ? 1 : format == info::int16 ? 2 : 4;
    }
};
constexpr Described port{info::port, info::int16, 2}, starboard{info::starboard, info::int16, 2},
    sub_bottom{0, info::legacy, 2};

/** A channel of a ping; its samples from the nearest on. */
struct Sampled {
    uint16_t channel;
    std::vector<uint32_t> samples;
    float slant_range;
};
using MadePing = std::vector<Sampled>;

RecordedBytes header(const std::vector<Described>& described, size_t declared) {
    const size_t block = xtf::file_header::size, end = xtf::file_header::channel_infos + described.size() * info::size;
    RecordedBytes bytes((end + block - 1) / block * block);
    putAt(bytes, 0, xtf::file_header::mark);
    putAt(bytes, 1, uint8_t{1});
    putAt(bytes, xtf::file_header::channel_count, static_cast<uint16_t>(declared));
    for (size_t i = 0; i < described.size(); ++i) {
        const size_t at = xtf::file_header::channel_infos + i * info::size;
        putAt(bytes, at + info::type, described[i].type);
        putAt(bytes, at + info::sample_bytes, described[i].legacy_bytes);
        putAt(bytes, at + info::sample_count, uint32_t{1024});
        putAt(bytes, at + info::sample_format, described[i].format);
    }
    return bytes;
}

RecordedBytes makePacket(RecordedBytes bytes, uint8_t type) {
    const size_t unit = xtf::packet::unit;
    bytes.resize((bytes.size() + unit - 1) / unit * unit);
    putAt(bytes, xtf::packet::mark, xtf::packet::magic);
    putAt(bytes, xtf::packet::type, type);
    putAt(bytes, xtf::packet::bytes, static_cast<uint32_t>(bytes.size()));
    return bytes;
}

RecordedBytes pingBytes(const std::vector<Described>& described, const MadePing& ping, int number) {
    namespace fields = xtf::ping_header;
    namespace side = xtf::channel_header;
    RecordedBytes bytes(fields::size);
    putAt(bytes, xtf::packet::channel_count, static_cast<uint16_t>(ping.size()));
    putAt(bytes, fields::year, uint16_t{2024});
    putAt(bytes, fields::month, uint8_t{5});
    putAt(bytes, fields::day, uint8_t{3});
    putAt(bytes, fields::day_time + 1, static_cast<uint8_t>(number / 60 % 60));
    putAt(bytes, fields::day_time + 2, static_cast<uint8_t>(number % 60));
    putAt(bytes, fields::number, static_cast<uint32_t>(number));
    putAt(bytes, fields::sound_speed, 1500.0f);
    for (const Sampled& sampled : ping) {
        const size_t at = bytes.size();
        const Described kind = sampled.channel < described.size() ? described[sampled.channel] : port;
        bytes.resize(at + side::size + sampled.samples.size() * kind.bytes());
        putAt(bytes, at + side::channel, sampled.channel);
        putAt(bytes, at + side::slant_range, sampled.slant_range);
        putAt(bytes, at + side::sample_count, static_cast<uint32_t>(sampled.samples.size()));
        for (size_t i = 0; i < sampled.samples.size(); ++i) {
            const size_t far_first = sampled.samples.size() - 1 - i;
            const size_t place = at + side::size + (kind.type == info::port ? far_first : i) * kind.bytes();
            const uint32_t value = sampled.samples[i];
            if (kind.format == info::float32)
                putAt(bytes, place, static_cast<float>(value));
            else if (kind.bytes() == 1)
                putAt(bytes, place, static_cast<uint8_t>(value));
            else if (kind.bytes() == 2)
                putAt(bytes, place, static_cast<uint16_t>(value));
            else
                putAt(bytes, place, value);
        }
    }
    return makePacket(std::move(bytes), xtf::packet::sonar);
}

std::vector<uint32_t> counting(uint32_t from, size_t count) {
    std::vector<uint32_t> samples(count);
    for (size_t i = 0; i < count; ++i) samples[i] = from + static_cast<uint32_t>(i);
    return samples;
}

/** Expects in each bin of a beam the side's sample at its middle, either one of two that meet there, and 0 beyond. */
void expectBins(const std::vector<float>& bins, const Sampled& side, double width) {
    const double length = static_cast<double>(side.slant_range) / static_cast<double>(side.samples.size());
    const auto sampleAt = [&](double at) {
        return at < static_cast<double>(side.samples.size())
                   ? static_cast<float>(side.samples[static_cast<size_t>(std::max(at, 0.0))])
                   : 0;
    };
    for (size_t bin = 0; bin < bins.size(); ++bin) {
        const double at = (static_cast<double>(bin) + 0.5) * width / length;
        EXPECT_THAT(bins[bin], testing::AnyOf(sampleAt(at - 1e-6), sampleAt(at + 1e-6))) << bin;
    }
}

std::vector<float> getBeam(const types::Sonar& ping, size_t beam) {
    const auto begin = ping.bins.begin() + static_cast<std::ptrdiff_t>(beam * ping.bin_count);
    return {begin, begin + ping.bin_count};
}

struct XtfDialectTest : RecordedFileTest {
    XtfDialectTest() : RecordedFileTest("line.xtf") {}
    std::vector<RecordedPing> readPings(const std::vector<Described>& described, size_t declared,
                                        const std::vector<MadePing>& pings) {
        std::vector<RecordedBytes> parts{header(described, declared)};
        for (size_t i = 0; i < pings.size(); ++i) parts.push_back(pingBytes(described, pings[i], static_cast<int>(i)));
        return read(test::joinedBytes(parts));
    }
    /** Expects the first side of each kind that has samples, as a beam. */
    static void expectPing(const types::Sonar& read, const std::vector<Described>& described, const MadePing& made) {
        std::optional<Sampled> sides[2];  // starboard, port
        for (const Sampled& sampled : made) {
            const uint8_t type = described[sampled.channel].type;
            if ((type != info::port && type != info::starboard) || sampled.samples.empty()) continue;
            if (auto& side = sides[type == info::port]; !side) side = sampled;
        }
        double widths[2] = {1e9, 1e9}, length = 0;
        for (size_t i = 0; i < 2; ++i)
            if (sides[i]) {
                widths[i] = static_cast<double>(sides[i]->slant_range) / static_cast<double>(sides[i]->samples.size());
                length = std::max(length, static_cast<double>(sides[i]->slant_range));
            }
        const bool are_alike = std::abs(widths[0] / widths[1] - 1) <= 1e-3;
        const double width = are_alike ? widths[0] : std::min(widths[0], widths[1]);
        ASSERT_NEAR(read.binStart(1), width, 1e-6 * width);
        EXPECT_NEAR(read.binStart(read.bin_count), length, 0.5001 * width);
        ASSERT_EQ(read.beam_count, (sides[0] ? 1u : 0u) + (sides[1] ? 1u : 0u));
        size_t beam = 0;
        for (const auto& side : sides)
            if (side) {
                EXPECT_EQ(read.bearings[beam].deg(), &side == &sides[1] ? 90 : -90);
                expectBins(getBeam(read, beam++), *side, width);
            }
    }
};

TEST_F(XtfDialectTest, ChannelsAreReadAsDescribedWhateverNumberIsDeclared) {
    const std::vector<Described> described{port, starboard};
    const MadePing ping{{0, counting(100, 8), 4}, {1, counting(200, 8), 4}};
    for (const size_t declared : {0, 1, 2, 3, 6, 8, 300, 65535}) {
        const auto pings = readPings(described, declared, {ping, ping, ping});
        ASSERT_THAT(pings, SizeIs(3)) << declared;
        for (const RecordedPing& read : pings) expectPing(read.ping, described, ping);
        EXPECT_EQ(isNoticed("channel 1 of 3 pings is read as the header describes it, although the header declares "
                            "only " +
                            std::to_string(declared) + " channels"),
                  declared < 2);
    }
}

/** Nine channels take a header of two blocks, also if one is declared. */
TEST_F(XtfDialectTest, AHeaderOfSeveralBlocksEndsWhereAPacketBegins) {
    for (const size_t count : {6, 7, 9, 14, 15, 22}) {
        std::vector<Described> described(count, sub_bottom);
        described[count - 2] = port, described[count - 1] = starboard;
        const MadePing ping{{static_cast<uint16_t>(count - 2), counting(100, 8), 4},
                            {static_cast<uint16_t>(count - 1), counting(200, 8), 4}};
        for (const size_t declared : {size_t{0}, size_t{1}, size_t{6}, count, size_t{40}}) {
            const auto pings = readPings(described, declared, {ping, ping});
            ASSERT_THAT(pings, SizeIs(2)) << count << ", declared " << declared;
            expectPing(pings[0].ping, described, ping);
        }
    }
}

TEST_F(XtfDialectTest, PingsMayHaveOtherChannelsThanTheHeader) {
    const std::vector<Described> described{port, starboard, sub_bottom};
    const Sampled left{0, counting(100, 8), 4}, right{1, counting(200, 8), 4}, bottom{2, counting(300, 20), 4},
        unknown{5, counting(0, 8), 4};
    const auto pings =
        readPings(described, 3, {{left}, {right, left}, {bottom, right, left, left}, {left, unknown, right}});
    ASSERT_THAT(pings, SizeIs(4));
    expectPing(pings[0].ping, described, {left});
    expectPing(pings[1].ping, described, {left, right});
    expectPing(pings[2].ping, described, {left, right});
    expectPing(pings[3].ping, described, {left});
    EXPECT_TRUE(isNoticed("channel 2 is omitted in 1 pings"));
    EXPECT_TRUE(isNoticed("channel 0 is omitted in 1 pings")) << "the second to port";
    EXPECT_TRUE(isNoticed("1 pings are read up to a channel that cannot be read; the first: byte "));
    EXPECT_TRUE(isNoticed("the channel is 5; the header of the file describes 3 channels, from 0"));
}

TEST_F(XtfDialectTest, ASideWithoutSamplesIsOmitted) {
    const std::vector<Described> described{port, starboard};
    const Sampled none{0, {}, 4}, left{0, counting(100, 8), 4}, right{1, counting(200, 8), 4};
    const auto pings = readPings(described, 2, {{none, right}, {left, {1, {}, 4}}, {none, {1, {}, 4}}, {left, right}});
    ASSERT_THAT(pings, SizeIs(3));
    expectPing(pings[0].ping, described, {right});
    expectPing(pings[1].ping, described, {left});
    expectPing(pings[2].ping, described, {left, right});
    EXPECT_TRUE(isNoticed("4 sides of pings have no samples and are omitted; the first: byte 1280"));
    EXPECT_TRUE(isNoticed("1 pings have no channel to port or to starboard and are omitted"));
}

TEST_F(XtfDialectTest, APingWithoutNumbersOfSamplesHasThoseOfTheHeader) {
    const std::vector<Described> described{port, starboard};
    const MadePing ping{{0, counting(100, 1024), 512}, {1, counting(2000, 1024), 512}};
    RecordedBytes bytes = test::joinedBytes({header(described, 2), pingBytes(described, ping, 0)});
    const size_t first = xtf::file_header::size + xtf::ping_header::size;
    for (const size_t at : {first, first + xtf::channel_header::size + 2048})
        putAt(bytes, at + xtf::channel_header::sample_count, uint32_t{0});
    const auto pings = read(bytes);
    ASSERT_THAT(pings, SizeIs(1));
    expectPing(pings[0].ping, described, ping);
}

TEST_F(XtfDialectTest, APingThatContradictsItselfIsOmittedWithTheReason) {
    const std::vector<Described> described{port, starboard};
    const MadePing good{{0, counting(100, 8), 4}, {1, counting(200, 8), 4}};
    const auto with = [&](size_t at, auto value) {
        RecordedBytes odd = pingBytes(described, good, 1);
        putAt(odd, at, value);
        const auto pings = read(test::joinedBytes(
            {header(described, 2), pingBytes(described, good, 0), odd, pingBytes(described, good, 2)}));
        EXPECT_THAT(pings, SizeIs(2));
        EXPECT_TRUE(isNoticed("1 pings are omitted, because they contradict themselves; the first: byte "));
        return testing::PrintToString(notices_);
    };
    const size_t side = xtf::ping_header::size;
    EXPECT_THAT(with(xtf::ping_header::month, uint8_t{13}), HasSubstr("the time is 2024-13-03"));
    EXPECT_THAT(with(xtf::ping_header::sound_speed, 12.0f), HasSubstr("the speed of sound is 12 m/s"));
    EXPECT_THAT(with(side, uint16_t{7}), HasSubstr("the channel is 7; the header of the file describes 2 channels"));
    EXPECT_THAT(with(side + xtf::channel_header::slant_range, -1.0f), HasSubstr("the slant range is -1 m"));
    EXPECT_THAT(with(side + xtf::channel_header::slant_range, 0.3f),
                HasSubstr("the samples are 0.5 m long, and those to port 0.0375 m; one may be at most 10 times"));
    EXPECT_THAT(with(side + xtf::channel_header::sample_count, 1u << 30), HasSubstr("has 1073741824 samples of 2"));
}

/** Random files: places of channels, formats, numbers of samples and ranges of each side, packets of other types. */
TEST_F(XtfDialectTest, RandomDialectsAreReadAsFilledIn) {
    constexpr Described formats[] = {{0, info::legacy, 1}, {0, info::legacy, 2}, {0, info::legacy, 4},
                                     {0, info::int8, 1},   {0, info::int16, 2},  {0, info::int32, 4},
                                     {0, info::float32, 4}};
    size_t resampled = 0, uneven = 0;
    const test::Seeds seeds(150);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        Draw draw(seed);
        std::vector<Described> described(2 + static_cast<size_t>(draw.upTo(5)));
        for (Described& channel : described) {
            channel = formats[draw.upTo(7)];
            channel.type = static_cast<uint8_t>(draw.upTo(4));
        }
        described[0].type = info::starboard, described[1].type = info::port;
        std::swap(described[1], described[static_cast<size_t>(draw.upTo(static_cast<int>(described.size())))]);
        std::vector<RecordedBytes> parts{header(described, static_cast<size_t>(draw.upTo(12)))};
        std::vector<MadePing> made;
        const bool is_even = draw.once(3);
        for (int i = 0; i < 4; ++i) {
            MadePing ping;
            for (size_t c = 0; c < described.size(); ++c) {
                const size_t count = is_even ? 40 : draw.once(6) ? 0 : 30 + static_cast<size_t>(draw.upTo(70));
                const auto range = static_cast<float>(is_even ? 8 : draw.between(6, 12));
                const bool in_bytes = described[c].bytes() == 1;
                ping.push_back({static_cast<uint16_t>(c), counting(in_bytes ? 7 : 1000, count), range});
            }
            while (draw.once(2) && draw.once(2)) parts.push_back(makePacket(RecordedBytes(80), 42));
            parts.push_back(pingBytes(described, ping, i));
            const auto has_side = std::ranges::any_of(ping, [&](const Sampled& side) {
                const uint8_t type = described[side.channel].type;
                return !side.samples.empty() && (type == info::port || type == info::starboard);
            });
            if (has_side) made.push_back(ping);
        }
        const auto pings = read(test::joinedBytes(parts));
        ASSERT_THAT(pings, SizeIs(made.size())) << seed << testing::PrintToString(notices_);
        for (size_t i = 0; i < made.size(); ++i) {
            SCOPED_TRACE(seed);
            expectPing(pings[i].ping, described, made[i]);
            EXPECT_NO_THROW(pings[i].ping.validate());
            uneven += i > 0 && pings[i].ping.bin_count != pings[i - 1].ping.bin_count;
        }
        resampled += isNoticed("pings have samples of two lengths, and get bins of the shorter");
    }
    EXPECT_GT(resampled, seeds.count / 4);
    EXPECT_GT(uneven, seeds.count / 4);
}

TEST_F(XtfDialectTest, TheGivenDialectsAreRead) {
    const std::filesystem::path folder = test::sharedFile("reports/xtf-dialects");
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "SKIPPED: " << folder << " is not there";
    const auto strongest = [](const types::Sonar& ping, size_t beam) {
        const std::vector<float> bins = getBeam(ping, beam);
        return ping.binStart(static_cast<double>(std::ranges::max_element(bins) - bins.begin()) + 0.5);
    };
    for (const char* name : {"few_declared.xtf", "uneven.xtf"}) {
        const auto pings = readFile(folder / name);
        ASSERT_THAT(pings, SizeIs(20)) << name;
        for (const RecordedPing& read : pings) {
            ASSERT_EQ(read.ping.beam_count, 2u) << name;
            EXPECT_NEAR(read.ping.binStart(read.ping.bin_count), 40, 1e-4) << name;
            EXPECT_NEAR(strongest(read.ping, 0), 9.8, 0.15) << "the target to starboard at 10 m in " << name;
        }
    }
}

}  // namespace
}  // namespace insonify::recordings
