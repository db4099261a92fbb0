#include <gtest/gtest.h>

#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "tests/support/Folder.hpp"

namespace insonify::log::pocolog {
namespace {

/** Big-endian u64 at a position. */
uint64_t number(const std::vector<char>& bytes, size_t position) {
    uint64_t value = 0;
    for (size_t i = 0; i < 8; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(position + i));
    return value;
}

TEST(IndexTest, HasTheBytesOfRocksIndex) {
    const StreamIndex stream{16, {1'000'000}, {3'000'000}, {{300, {1'000'000}}, {400, {2'500'000}}}};
    const StreamIndex empty{200, {}, {}, {}};
    const std::vector<char> bytes = indexBytes({stream, empty}, 500, {7});
    ASSERT_EQ(bytes.size(), 13 + 4 + 3 * 8 + 2 * 64 + 2 * 16u);
    EXPECT_EQ(std::string(bytes.data(), 17), std::string("POCOSIM_INDEX\0\0\0\3", 17));
    std::vector<uint64_t> numbers;
    for (size_t position = 17; position < bytes.size(); position += 8) numbers.push_back(number(bytes, position));
    EXPECT_EQ(numbers, (std::vector<uint64_t>{500, 7,   2,                                                    //
                                              16,  169, 1000000, 2,      1000000, 3000000, 1000000, 2500000,  //
                                              200, 201, 0,       0,      0,       0,       0,       0,        //
                                              300, 0,   400,     1500000}));
}

TEST(IndexTest, HasTheBlocksOfTheLogAndItsSize) {
    Folder folder;
    Writer log(folder / "x.0.log");
    const size_t stream = log.addStream<double>("a.b");
    log.write(stream, {1'000'000}, 0.5);
    log.write(stream, {2'000'000}, 0.75);
    log.close();
    const std::vector<char> bytes = toBytes(folder / "x.0.log");
    const std::vector<char> index = toBytes(folder / "x.0.idx");
    ASSERT_EQ(index.size(), 13 + 4 + 3 * 8 + 64 + 2 * 16u);
    EXPECT_EQ(number(index, 17), bytes.size());
    EXPECT_EQ(number(index, 41), sizeof(Prologue));
    for (size_t sample = 0; sample < 2; ++sample) {
        const uint64_t position = number(index, number(index, 49) + 16 * sample);
        EXPECT_EQ(bytes.at(position), 2);
        double value = 0;
        std::memcpy(&value, &bytes.at(position + 29), sizeof value);
        EXPECT_EQ(value, sample == 0 ? 0.5 : 0.75);
    }
}

TEST(IndexTest, RemovesAnOldIndexWhenItsLogIsWrittenAgain) {
    Folder folder;
    writeBytes(folder / "x.0.idx", {'o', 'l', 'd'});
    Writer log(folder / "x.0.log");
    EXPECT_TRUE(std::filesystem::exists(folder / "x.0.idx")) << "nothing is written yet";
    log.flush();
    EXPECT_FALSE(std::filesystem::exists(folder / "x.0.idx"));
}

}  // namespace
}  // namespace insonify::log::pocolog
