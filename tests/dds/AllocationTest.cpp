#include <gmock/gmock.h>

#include "components/dds/Endpoints.hpp"
#include "tests/dds/Ends.hpp"
#include "tests/support/Allocations.hpp"

namespace insonify::dds {
namespace {

class AllocationTest : public Loopback {};

TEST_F(AllocationTest, AllocatesNothingAfterTheFirstPings) {
    Publishing<types::SonarPtr> publishing({topicOut("in", "/image", message_type<ros::ProjectedSonarImage>),
                                            topicOut("in", "/scan", message_type<ros::LaserScan>),
                                            topicOut("in", "/points", message_type<ros::PointCloud2>)});
    Node node(domainId({}), "listener", 16);
    std::vector<std::unique_ptr<Reader>> readers;
    for (const auto& [topic, type] :
         {std::pair{"/image", ros::ProjectedSonarImage::type_name}, std::pair{"/scan", ros::LaserScan::type_name},
          std::pair{"/points", ros::PointCloud2::type_name}})
        readers.push_back(
            std::make_unique<Reader>(node, ddsTopic(topic), type, "", Quality{}, std::function<void()>{}));
    const types::SonarPtr ping = makePing(32, 100);
    Bytes bytes;
    uint64_t sender = 0;
    size_t taken = 0;
    const auto sendAll = [&](int count) {
        for (int i = 0; i < count; ++i) {
            publishing.send(ping);
            for (const auto& reader : readers)
                while (reader->take(bytes, sender)) ++taken;
        }
    };
    ASSERT_TRUE(becomesTrue([&] { return sendAll(1), taken > 12; }));
    EXPECT_THAT(test::allocationsOn(publishing.task, [&] { sendAll(50); }), testing::IsEmpty());
    EXPECT_GE(taken, 150u);
}

}  // namespace
}  // namespace insonify::dds
