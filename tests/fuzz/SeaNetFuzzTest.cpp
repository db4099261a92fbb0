// Messages of a driver of a Micron, and the Micron's answers.
#include <gtest/gtest.h>

#include "components/device/micron/MicronEmulator.hpp"
#include "tests/support/Fuzz.hpp"

namespace insonify::fuzz {
namespace {

/** Parses packets, and sends them to a head: it must request possible pings only, and answer with packets only. */
class Head {
public:
    Head() { emulator_.opened(client_); }

    void take(std::span<const uint8_t> bytes) {
        for (size_t at = 0; at < bytes.size(); at += 97) {  // in parts, as from a line, with time passing
            emulator_.received(client_, bytes.subspan(at, std::min<size_t>(97, bytes.size() - at)), now_);
            for (int i = 0; i < 4; ++i) {
                const auto due = emulator_.tick(now_);
                if (due) now_ = std::max(now_, *due);
            }
        }
        expectPackets();
    }

private:
    void ask(const types::SonarSettings& asked) {
        EXPECT_GT(asked.range, 0);
        EXPECT_LT(asked.range, 2000);
        EXPECT_TRUE(asked.bin_count >= 1 && asked.bin_count <= 1500) << asked.bin_count;
        EXPECT_TRUE(asked.frequency_khz >= 100 && asked.frequency_khz <= 2000) << asked.frequency_khz;
        EXPECT_TRUE(asked.gain_db >= -80 && asked.gain_db <= 80) << asked.gain_db;
        EXPECT_FALSE(asked.bearing.isUnknown());
        types::Sonar ping;
        ping.time = asked.time;
        ping.bins.assign(asked.bin_count, 30000);
        pings_.push_back(ping);
    }
    void expectPackets() {
        for (const types::Sonar& ping : pings_) emulator_.setPing(ping);
        emulator_.tick(now_ + types::Time::fromSeconds(10));
        device::SeaNetReader reader;
        reader.add(sent_);
        while (const auto message = reader.next())
            EXPECT_TRUE(message->type != device::SeaNetType::HeadData || device::SeaNetHeadData::in(*message));
        EXPECT_EQ(reader.skipped(), 0u);
    }

    const device::Client client_{0, 1};
    types::Time now_{1'000'000'000};
    std::vector<types::Sonar> pings_;
    device::Bytes sent_;
    device::MicronEmulator emulator_{
        {},
        {[this](const types::SonarSettings& asked) { ask(asked); },
         [this](device::Client, device::Bytes bytes) { sent_.insert(sent_.end(), bytes.begin(), bytes.end()); },
         [](const std::string& text) { expectOurWords(text); }}};
};

void readSeaNet(const Input& input) {
    const auto bytes = input.octets();
    device::SeaNetReader reader;
    reader.add(bytes);
    while (const auto message = reader.next()) {
        device::SeaNetAlive::in(*message);
        device::SeaNetVersion::in(*message);
        device::SeaNetUserData::in(*message);
        const auto line = device::SeaNetHeadData::in(*message);
        EXPECT_LE(line ? line->data.size() : 0, 4096u);
    }
    EXPECT_LE(reader.skipped(), bytes.size());
    Head().take(bytes);
}

TEST(SeaNetFuzzTest, EveryLineIsPacketsOrNoise) {
    push({"seanet",
          "line.raw",
          {std::string("@0008\x08\0\xFF\x02\x03\x10\x80\x02\n", 14),
           std::string("@000C\x0C\0\xFF\x02\x07\x19\x80\x02\0\0\0\0\n", 18), std::string("@004C\x4C\0\xFF\x02", 9),
           std::string("\xFF\xFF", 2)},
          readSeaNet});
}

}  // namespace
}  // namespace insonify::fuzz
