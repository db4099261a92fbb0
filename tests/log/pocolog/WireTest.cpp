#include <gmock/gmock.h>

#include <limits>

#include "components/log/pocolog/Wire.hpp"
#include "types/samples/Samples.hpp"

namespace insonify::log::pocolog {
namespace {

std::string hex(const std::vector<char>& bytes) {
    std::string text;
    for (const char byte : bytes) {
        text += "0123456789abcdef"[(byte >> 4) & 15];
        text += "0123456789abcdef"[byte & 15];
    }
    return text;
}

std::vector<char> marshalled(const auto& value) {
    std::vector<char> bytes;
    marshal(value, bytes);
    return bytes;
}

types::Sonar rocksSonar() {
    types::Sonar ping;
    ping.time = {1700000000000000};
    ping.bin_duration = {100};
    ping.beam_width = {0.02};
    ping.beam_height = {0.35};
    ping.speed_of_sound = 1500;
    ping.bin_count = 4;
    ping.beam_count = 3;
    for (int beam = 0; beam < 3; ++beam) {
        ping.bearings.push_back({-0.5 + beam / 3.0});
        for (int bin = 0; bin < 4; ++bin) ping.bins.push_back(static_cast<float>(beam + bin / 100.0));
    }
    return ping;
}

/** A double and a byte: 16 bytes in memory, of which 7 are padding at the end. */
struct Padded {
    [[maybe_unused]] static constexpr const char* type_name = "/test/Padded";
    double value = 0;
    uint8_t flag = 0;
    static void describe(auto& self, auto& visit) {
        visit({"value"}, self.value);
        visit({"flag"}, self.flag);
    }
};

struct PaddedTwice {
    [[maybe_unused]] static constexpr const char* type_name = "/test/PaddedTwice";
    std::vector<Padded> many{2};
    Padded one;
    static void describe(auto& self, auto& visit) {
        visit({"many"}, self.many);
        visit({"one"}, self.one);
    }
};

struct Holder {
    [[maybe_unused]] static constexpr const char* type_name = "/test/Holder";
    std::vector<float> values;
    uint8_t flag = 0;
    static void describe(auto& self, auto& visit) {
        visit({"values"}, self.values);
        visit({"flag"}, self.flag);
    }
};

struct Inner {
    [[maybe_unused]] static constexpr const char* type_name = "/test/Inner";
    Padded first;
    double second = 2;
    static void describe(auto& self, auto& visit) {
        visit({"first"}, self.first);
        visit({"second"}, self.second);
    }
};

TEST(WireTest, ASonarEqualsRocksBytes) {
    EXPECT_EQ(hex(marshalled(rocksSonar())),
              "00401e18240a0600000000000000000064000000000000007b14ae47e17a943f"
              "666666666666d63f0300000000000000000000000000e0bf565555555555c5bf"
              "545555555555c53f0080bb440400000003000000000000000c00000000000000"
              "000000000ad7233c0ad7a33c8fc2f53c0000803fae47813f5c8f823f0ad7833f"
              "00000040d7a30040ae47014085eb0140");
}

TEST(WireTest, RocksSonarIsReadBack) {
    types::Sonar ping;
    unmarshal(marshalled(rocksSonar()), ping);
    EXPECT_EQ(ping.time.microseconds, 1700000000000000);
    EXPECT_EQ(ping.bin_duration.microseconds, 100);
    EXPECT_EQ(ping.bearings.at(2).rad, -0.5 + 2 / 3.0);
    EXPECT_EQ(ping.speed_of_sound, 1500);
    EXPECT_EQ(ping.bins, rocksSonar().bins);
}

TEST(WireTest, PaddingIsWrittenBetweenFieldsAndInVectorsButNotAtTheEnd) {
    EXPECT_EQ(marshalled(Padded{}).size(), 9u);
    EXPECT_EQ(marshalled(std::vector<Padded>(2)).size(), 40u);
    EXPECT_EQ(marshalled(PaddedTwice{}).size(), 49u);
    EXPECT_EQ(marshalled(std::vector<Holder>(2)).size(), 40u);
    EXPECT_EQ(marshalled(Inner{}).size(), 24u);
}

TEST(WireTest, SkipsPaddingOfAnyContent) {
    Inner sent;
    sent.first.flag = 7;
    std::vector<char> bytes = marshalled(sent);
    std::fill(bytes.begin() + 9, bytes.begin() + 16, '\x5a');
    Inner got;
    got.second = 0;
    unmarshal(bytes, got);
    EXPECT_EQ(got.first.flag, 7);
    EXPECT_EQ(got.second, 2);
}

TEST(WireTest, AQuaternionIsItsImaginaryPartsThenTheRealOne) {
    const std::vector<char> bytes = marshalled(glm::dquat(4, 1, 2, 3));  // w, x, y, z
    double values[4];
    ASSERT_EQ(bytes.size(), sizeof values);
    std::memcpy(values, bytes.data(), sizeof values);
    EXPECT_THAT(values, testing::ElementsAre(1, 2, 3, 4));
}

TEST(WireTest, AMatrixIsColumnByColumn) {
    const std::vector<char> bytes = marshalled(glm::dmat3(1, 2, 3, 4, 5, 6, 7, 8, 9));
    double values[9];
    ASSERT_EQ(bytes.size(), sizeof values);
    std::memcpy(values, bytes.data(), sizeof values);
    EXPECT_THAT(values, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
}

TEST(WireTest, APoseHasItsFieldsAndTwoNames) {
    types::Pose pose;
    pose.source_frame = "body";
    EXPECT_EQ(marshalled(pose).size(), 8 + (8 + 4) + 8 + 24 + 72 + 32 + 72 + 24 + 72 + 24 + 72u);
}

TEST(WireTest, ABeamHasScalarsWithPaddingThenBytes) {
    types::SonarBeam beam;
    beam.beam = {1, 2, 3};
    EXPECT_EQ(marshalled(beam).size(), 8 + 8 + 8 + 3 * 4 + 4 + 8 + 3u);
    EXPECT_EQ(hex(marshalled(beam)).substr(2 * 36), "000000000300000000000000010203");
}

TEST(WireTest, AScanDropsThePaddingAfterItsFlags) {
    types::SonarScan scan;
    scan.data = {1, 2};
    scan.time_beams = {{1}};
    EXPECT_EQ(marshalled(scan).size(), 8 + (8 + 2) + (8 + 8) + 2 * 2 + 4 + 3 * 8 + 4 + 4 + 2 * 8 + 2u);
}

TEST(WireTest, AnImageIsReadBackWithItsAttributesAndItsMode) {
    types::Image sent;
    sent.time = {5};
    sent.image = {1, 2, 3};
    sent.attributes = {{"forty-two", "answer"}, {"", "empty"}};
    sent.size = {3, 1};
    sent.frame_mode = types::ImageMode::Bgr;
    sent.frame_status = types::ImageStatus::Valid;
    types::Image got;
    unmarshal(marshalled(sent), got);
    EXPECT_EQ(got.image, sent.image);
    ASSERT_EQ(got.attributes.size(), 2u);
    EXPECT_EQ(got.attributes[0].data, "forty-two");
    EXPECT_EQ(got.attributes[1].name, "empty");
    EXPECT_EQ(got.size.width, 3);
    EXPECT_EQ(got.frame_mode, types::ImageMode::Bgr);
    EXPECT_EQ(got.frame_status, types::ImageStatus::Valid);
}

TEST(WireTest, EveryTypeOfTheListIsReadBackToTheSameBytes) {
    types::forEachSampleType([]<class T>(std::type_identity<T>) {
        const std::vector<char> bytes = marshalled(T{});
        T got{};
        unmarshal(bytes, got);
        EXPECT_EQ(marshalled(got), bytes) << typelibName<T>();
    });
}

TEST(WireTest, EveryShorterPingIsRefused) {
    const std::vector<char> bytes = marshalled(rocksSonar());
    for (size_t size = 0; size < bytes.size(); ++size) {
        types::Sonar ping;
        EXPECT_THROW(unmarshal(std::span(bytes).first(size), ping), std::runtime_error) << size << " bytes";
    }
}

TEST(WireTest, RefusesTooManyBytes) {
    std::vector<char> bytes = marshalled(rocksSonar());
    bytes.push_back(0);
    types::Sonar ping;
    EXPECT_THROW(unmarshal(bytes, ping), std::runtime_error);
}

TEST(WireTest, RefusesAnImpossibleCountBeforeAllocating) {
    for (const uint64_t count : {uint64_t{1} << 32, uint64_t{1} << 61, std::numeric_limits<uint64_t>::max()}) {
        std::vector<char> bytes = marshalled(rocksSonar());
        std::memcpy(bytes.data() + 88, &count, sizeof count);
        types::Sonar ping;
        EXPECT_THROW(unmarshal(bytes, ping), std::runtime_error);
        EXPECT_EQ(ping.bins.capacity(), 0u);
        std::vector<types::ImageAttribute> attributes;
        EXPECT_THROW(unmarshal(std::span(bytes).subspan(88), attributes), std::runtime_error);
        EXPECT_EQ(attributes.capacity(), 0u);
    }
}

}  // namespace
}  // namespace insonify::log::pocolog
