// SeaNet by bytes: frames as the open drivers write and check them.
#include <gmock/gmock.h>

#include <random>

#include "components/device/micron/SeaNet.hpp"

namespace insonify::device {
namespace {

using ::testing::ElementsAre;

std::vector<SeaNetMessage> seaNetIn(const Bytes& bytes) {
    SeaNetReader reader;
    reader.add(bytes);
    std::vector<SeaNetMessage> messages;
    while (auto message = reader.next()) messages.push_back(*message);
    return messages;
}

SeaNetHeadCommand someCommand() {
    SeaNetHeadCommand command;
    command.control = SeaNetControl::eight_bits | SeaNetControl::continuous | SeaNetControl::second_channel;
    command.transmit[0] = 77846282;
    command.transmit[1] = 162403450;
    command.range_decimetres = 200;
    command.left = 1600;
    command.right = 4800;
    command.ad_span = 81;
    command.ad_low = 8;
    command.gain = 84;
    command.motor_delay = 25;
    command.step = 16;
    command.ad_interval = 83;
    command.bins = 500;
    return command;
}

void expectSame(const SeaNetHeadCommand& got, const SeaNetHeadCommand& sent) {
    EXPECT_EQ(got.control, sent.control);
    EXPECT_EQ(got.transmit[1], sent.transmit[1]);
    EXPECT_EQ(got.range_decimetres, sent.range_decimetres);
    EXPECT_EQ(got.left, sent.left);
    EXPECT_EQ(got.right, sent.right);
    EXPECT_EQ(got.ad_span, sent.ad_span);
    EXPECT_EQ(got.ad_low, sent.ad_low);
    EXPECT_EQ(got.gain, sent.gain);
    EXPECT_EQ(got.step, sent.step);
    EXPECT_EQ(got.ad_interval, sent.ad_interval);
}

TEST(SeaNetTest, ARequestHasTheBytesOfDrivers) {
    EXPECT_THAT(seaNetRequest(SeaNetType::SendVersion).packet(),
                ElementsAre('@', '0', '0', '0', '8', 8, 0, 255, 2, 3, 23, 0x80, 2, 0x0A));
    EXPECT_THAT(seaNetRequest(SeaNetType::SendData).packet(),
                ElementsAre('@', '0', '0', '0', 'C', 12, 0, 255, 2, 7, 25, 0x80, 2, 0, 0, 0, 0, 0x0A));
}

/** Sizes and offsets as in an open driver's parser. */
TEST(SeaNetTest, AnswersHaveTheSizesOfDrivers) {
    const Bytes alive = SeaNetAlive{.centred = true, .unconfigured = false, .configured = true}.message().packet();
    ASSERT_EQ(alive.size(), 22u);
    EXPECT_EQ(alive[20], 2 | 128);
    const Bytes version = SeaNetVersion{.software = 5, .serial = 0x1234}.message().packet();
    ASSERT_EQ(version.size(), 25u);
    EXPECT_EQ(read<uint16_t>(version, 15), 0x1234);
    EXPECT_EQ(version[23], 2);
    const Bytes user = SeaNetUserData{.full_duplex = true}.message().packet();
    ASSERT_EQ(user.size(), 264u);
    EXPECT_EQ(user[146], 0);
    SeaNetHeadData line{.command = someCommand(), .bearing = 3216, .data = Bytes(500, 7)};
    const Bytes data = line.message().packet();
    ASSERT_EQ(data.size(), 545u);
    EXPECT_EQ(data[9], 0);
    EXPECT_EQ(read<uint16_t>(data, 13), data.size() - 14);
    EXPECT_EQ(read<uint16_t>(data, 18), someCommand().control);
    EXPECT_EQ(read<uint32_t>(data, 22), 162403450u);
    EXPECT_EQ(data[29], 81);
    EXPECT_EQ(data[30], 8);
    EXPECT_EQ(read<uint16_t>(data, 33), 83);
    EXPECT_EQ(read<uint16_t>(data, 35), 1600);
    EXPECT_EQ(read<uint16_t>(data, 37), 4800);
    EXPECT_EQ(data[39], 16);
    EXPECT_EQ(read<uint16_t>(data, 40), 3216);
    EXPECT_EQ(read<uint16_t>(data, 42), 500);
    EXPECT_EQ(data[44], 7);
    EXPECT_EQ(data.back(), 0x0A);
}

TEST(SeaNetTest, EveryMessageIsReadBack) {
    const auto there = [](const SeaNetMessage& message) { return seaNetIn(message.packet()).at(0); };
    const auto command = SeaNetHeadCommand::in(there(someCommand().message()));
    ASSERT_TRUE(command);
    expectSame(*command, someCommand());
    EXPECT_EQ(command->bins, 500);
    EXPECT_EQ(command->motor_delay, 25);
    const auto line = SeaNetHeadData::in(
        there(SeaNetHeadData{.sweep = 1, .command = someCommand(), .bearing = 6399, .data = {1, 2, 64}}.message()));
    ASSERT_TRUE(line);
    expectSame(line->command, someCommand());
    EXPECT_EQ(line->bearing, 6399);
    EXPECT_THAT(line->data, ElementsAre(1, 2, 64));
    const auto alive = SeaNetAlive::in(
        there(SeaNetAlive{.motor_on = true, .scanning = true, .milliseconds = 1234, .bearing = 77}.message()));
    ASSERT_TRUE(alive);
    EXPECT_TRUE(alive->motor_on && alive->scanning && alive->unconfigured && !alive->centred && !alive->recentring &&
                !alive->configured);
    EXPECT_EQ(alive->milliseconds, 1234u);
    EXPECT_EQ(alive->bearing, 77);
    const auto version = SeaNetVersion::in(there(SeaNetVersion{1, 2, 3, 4, 5}.message()));
    ASSERT_TRUE(version);
    EXPECT_EQ(version->program_sum, 5);
    for (const bool full : {false, true})
        EXPECT_EQ(SeaNetUserData::in(there(SeaNetUserData{full}.message()))->full_duplex, full);
}

TEST(SeaNetTest, RejectsMessagesOfAnotherTypeOrSize) {
    const SeaNetMessage alive = SeaNetAlive{}.message();
    EXPECT_FALSE(SeaNetHeadCommand::in(alive) || SeaNetHeadData::in(alive) || SeaNetVersion::in(alive) ||
                 SeaNetUserData::in(alive));
    EXPECT_FALSE(SeaNetAlive::in(SeaNetVersion{}.message()));
    SeaNetMessage command = someCommand().message();
    command.payload.resize(41);
    EXPECT_FALSE(SeaNetHeadCommand::in(command)) << "does not reach to the number of bins";
    SeaNetMessage line = SeaNetHeadData{.command = someCommand(), .data = Bytes(9)}.message();
    line.payload.pop_back();
    EXPECT_FALSE(SeaNetHeadData::in(line));
    line.payload.resize(3);
    EXPECT_FALSE(SeaNetHeadData::in(line));
}

TEST(SeaNetTest, PacketsMayArriveByteByByte) {
    Bytes all = seaNetRequest(SeaNetType::Reboot).packet();
    const Bytes command = someCommand().message().packet();
    all.insert(all.end(), command.begin(), command.end());
    SeaNetReader reader;
    std::vector<SeaNetType> types;
    for (const uint8_t byte : all) {
        reader.add({&byte, 1});
        while (auto message = reader.next()) types.push_back(message->type);
    }
    EXPECT_THAT(types, ElementsAre(SeaNetType::Reboot, SeaNetType::HeadCommand));
    EXPECT_EQ(reader.skipped(), 0u);
}

TEST(SeaNetTest, SkipsShortLongAndMisSizedPackets) {
    const Bytes good = seaNetRequest(SeaNetType::SendData).packet();
    const auto followed = [&](Bytes bad) {
        bad.insert(bad.end(), good.begin(), good.end());
        return seaNetIn(bad);
    };
    for (size_t length = 0; length < good.size(); ++length) {
        Bytes all(good.begin(), good.begin() + static_cast<long>(length));
        all.insert(all.end(), good.begin(), good.end());
        EXPECT_EQ(followed(all).size(), 2u) << "cut off after " << length;
    }
    Bytes lengths = good, unended = good, endless = good, digits = good;
    lengths[5] = 13;
    unended.back() = 0;
    endless[1] = endless[2] = endless[3] = endless[4] = 'F';
    endless[5] = endless[6] = 0xFF;
    digits[1] = '-';
    for (const Bytes& bad : {lengths, unended, endless, digits}) EXPECT_EQ(followed(bad).size(), 1u);
    Bytes longer = good;
    longer.insert(longer.end() - 1, 3, 0);
    EXPECT_EQ(followed(longer).size(), 1u);
}

TEST(SeaNetTest, ATruncatedPacketDelaysNoLaterPacket) {
    const Bytes cut = someCommand().message().packet(), good = seaNetRequest(SeaNetType::SendData).packet();
    SeaNetReader reader;
    reader.add(std::span(cut).first(20));
    EXPECT_FALSE(reader.next());
    reader.add(good);
    const auto message = reader.next();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->type, SeaNetType::SendData);
    EXPECT_EQ(message->payload.size(), 4u);
    EXPECT_EQ(reader.skipped(), 20u);
    EXPECT_FALSE(reader.next());
}

TEST(SeaNetTest, KeepsNoMoreThanOnePossiblePacket) {
    constexpr size_t count = 1 << 20;
    SeaNetReader reader;
    reader.add(Bytes(count, '@'));
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.skipped(), count - 6) << "the lengths of the last six are unknown";
    reader.add(seaNetRequest(SeaNetType::SendData).packet());
    EXPECT_TRUE(reader.next());
    EXPECT_EQ(reader.skipped(), count);
}

/** A line that changes bits and inserts bytes between packets loses some packets, but never synchronisation. */
TEST(SeaNetTest, ANoisyLineLosesPacketsButNotSynchronisation) {
    std::mt19937 random(1);
    const Bytes good = someCommand().message().packet();
    SeaNetReader reader;
    int whole = 0;
    for (int i = 0; i < 1000; ++i) {
        Bytes sent = good;
        if (i % 4 == 0) sent[random() % sent.size()] ^= static_cast<uint8_t>(1 << random() % 8);
        const size_t noise = random() % 20;
        for (size_t k = 0; k < noise; ++k) sent.push_back(static_cast<uint8_t>(random()));
        reader.add(sent);
        while (const auto message = reader.next()) whole += SeaNetHeadCommand::in(*message) ? 1 : 0;
    }
    std::cout << whole << " of 1000 packets on a noisy line, " << reader.skipped() << " bytes skipped\n";
    EXPECT_GE(whole, 750);
}

}  // namespace
}  // namespace insonify::device
