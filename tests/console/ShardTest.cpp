// The parts of divided work, and the hashes that identify files.
#include <gmock/gmock.h>

#include <map>

#include "components/console/Sha256.hpp"
#include "components/console/Shard.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::console {
namespace {

using testing::HasSubstr;

TEST(ShardTest, AShardIsReadAndNamed) {
    EXPECT_EQ(Shard::read("3/16"), (Shard{3, 16}));
    EXPECT_EQ(Shard::read("0/1"), Shard());
    EXPECT_EQ((Shard{3, 16}.text()), "3/16");
    EXPECT_EQ((Shard{3, 16}.fileText()), "03_of_16");
    EXPECT_EQ((Shard{3, 10}.fileText()), "3_of_10");
    EXPECT_EQ((Shard{3, 11}.fileText()), "03_of_11");
}

TEST(ShardTest, ReportsAnInvalidShardWithTheAlternatives) {
    const std::map<std::string, std::string> wrong = {
        {"0/0", "is 0/0; N must be from 1 to 1000000000"},
        {"5/4", "is 5/4; of 4 shards i may be from 0 to 3"},
        {"4/4", "is 4/4; of 4 shards i may be from 0 to 3"},
        {"-1/2", "is '-1/2'; it must be i/N, whole numbers, as in 0/16"},
        {"abc", "is 'abc'; it must be i/N"},
        {"", "is ''; it must be i/N"},
        {"1/", "is '1/'; it must be i/N"},
        {"/2", "is '/2'; it must be i/N"},
        {"1/2/3", "is '1/2/3'; it must be i/N"},
        {"1.5/2", "is '1.5/2'; it must be i/N"},
        {" 1/2", "is ' 1/2'; it must be i/N"},
        {"0/1000000001", "N must be from 1 to 1000000000"},
        {"0/99999999999999999999999", "it must be i/N"},
    };
    for (const auto& [text, why] : wrong) {
        EXPECT_THAT(Shard::refuse(text), HasSubstr(why));
        EXPECT_THAT(test::errorOf<types::ConfigError>([&] { Shard::read(text); }),
                    testing::AllOf(HasSubstr("--shard"), HasSubstr(why)));
    }
    EXPECT_EQ(Shard::refuse("3/4"), "");
}

TEST(ShardTest, BlocksAreConsecutiveAndOfEqualLength) {
    for (const uint64_t total : {0ull, 1ull, 10ull, 16ull, 1001ull, 9223372036854775807ull})
        for (const uint64_t count : {1ull, 3ull, 16ull, 1000ull}) {
            uint64_t end = 0;
            for (uint64_t i = 0; i < count; ++i) {
                const Shard::Block block = Shard{i, count}.block(total);
                EXPECT_EQ(block.first, end);
                EXPECT_LE(block.last - block.first, total / count + 1);
                EXPECT_GE(block.last - block.first, total / count);
                end = block.last;
            }
            EXPECT_EQ(end, total);
        }
}

TEST(Sha256Test, MatchesTheVectorsOfTheStandard) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256(std::string(1'000'000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256Test, PiecesOfAnyLengthGiveTheHashOfTheWhole) {
    std::string bytes;
    for (int i = 0; i < 1000; ++i) bytes.push_back(static_cast<char>(i * 7));
    for (const size_t piece : {1u, 3u, 63u, 64u, 65u, 200u}) {
        Sha256 hash;
        for (size_t at = 0; at < bytes.size(); at += piece) hash.add(std::string_view(bytes).substr(at, piece));
        EXPECT_EQ(hash.hex(), sha256(bytes)) << piece;
    }
}

TEST(Sha256Test, AFileHasTheHashOfItsBytes) {
    const Folder folder;
    const std::vector<char> bytes(3'000'001, 'x');
    writeBytes(folder / "file", bytes);
    EXPECT_EQ(sha256OfFile(folder / "file"), sha256({bytes.data(), bytes.size()}));
    EXPECT_THROW(sha256OfFile(folder / "none"), std::runtime_error);
}

}  // namespace
}  // namespace insonify::console
