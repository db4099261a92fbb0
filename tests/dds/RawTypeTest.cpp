// Bytes sent through DDS and back, within one process and between two.
#include <gmock/gmock.h>

#include <numeric>

#include "components/dds/Endpoints.hpp"
#include "components/dds/Node.hpp"
#include "components/ros/Cdr.hpp"
#include "tests/dds/Loopback.hpp"

using namespace insonify;
using namespace insonify::dds;

namespace {

struct RawTypeTest : Loopback {
    Node node{domainId({}), "raw", 16};
    Writer writer{node, "rt/bytes", "test_msgs/msg/Bytes", "", {}};
    Reader reader{node, "rt/bytes", "test_msgs/msg/Bytes", "", {}, {}};

    Bytes sent(size_t size) {
        Bytes bytes(size);
        std::iota(bytes.begin(), bytes.end(), char{7});
        EXPECT_TRUE(becomesTrue([&] { return writer.hasReaders(); }));
        EXPECT_TRUE(writer.write(bytes)) << writer.failure();
        return bytes;
    }
};

}  // namespace

TEST_F(RawTypeTest, ReturnsBytesOfAnySizePaddedToWholeWords) {
    for (const size_t size : {4u, 5u, 7u, 8u, 1000u, 100'001u, 3'000'000u}) {
        Bytes bytes = sent(size), received;
        uint64_t sender = 0;
        ASSERT_TRUE(becomesTrue([&] { return reader.take(received, sender); })) << size;
        bytes.resize((size + 3) / 4 * 4);
        EXPECT_EQ(received, bytes);
        EXPECT_TRUE(reader.receives(sender));
    }
}

TEST_F(RawTypeTest, ASlowReaderReceivesOnlyTheNewest) {
    for (size_t size = 4; size < 44; size += 4) sent(size);
    Bytes received;
    uint64_t sender = 0;
    std::vector<size_t> sizes;
    while (reader.take(received, sender)) sizes.push_back(received.size());
    EXPECT_THAT(sizes, testing::ElementsAre(24, 28, 32, 36, 40));
}

TEST_F(RawTypeTest, AReaderOfAnotherTypeReceivesNothing) {
    Reader other(node, "rt/bytes", "test_msgs/msg/Other", "", {}, {});
    sent(8);
    Bytes received;
    uint64_t sender = 0;
    ASSERT_TRUE(becomesTrue([&] { return reader.take(received, sender); }));
    EXPECT_FALSE(other.take(received, sender));
}

TEST_F(RawTypeTest, NotifiesAListenerOfArrivals) {
    std::atomic<int> reported = 0;
    Reader listening(node, "rt/bytes", "test_msgs/msg/Bytes", "", {}, [&] { ++reported; });
    sent(8);
    EXPECT_TRUE(becomesTrue([&] { return reported == 1; }));
}
