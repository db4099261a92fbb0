// The parts of divided work.
#include <gmock/gmock.h>

#include <map>

#include "components/console/Shard.hpp"
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
        EXPECT_THAT(test::computeError<types::ConfigError>([&] { Shard::read(text); }),
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

}  // namespace
}  // namespace insonify::console
