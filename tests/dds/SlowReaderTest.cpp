// A peer that hangs blocks neither the simulator nor other peers.
#include <gmock/gmock.h>

#include <future>
#include <thread>

#include "tests/dds/Ends.hpp"

using namespace insonify;
using namespace insonify::dds;

namespace {

class SlowReaderTest : public WithPeer {};

}  // namespace

TEST_F(SlowReaderTest, APeerThatHangsBlocksNothing) {
    TopicOut topic = topicOut("in", "/auv/sonar", message_type<ros::ProjectedSonarImage>);
    topic.sonar.dtype = ros::ImageType::Float32;
    Publishing<types::SonarPtr> publishing({topic}, [](PublisherConfig& config) { config.depth = 200; });
    Peer hanging("listen ProjectedSonarImage /auv/sonar 240"), good("listen ProjectedSonarImage /auv/sonar 240 120");
    for (const Peer* peer : {&hanging, &good}) ASSERT_TRUE(peer->meets([&] { publishing.send(greeting()); }));
    std::atomic<int> sent{0};
    auto all = std::async(std::launch::async, [&] {
        auto ping = std::make_shared<types::Sonar>(*makePing(256, 1000));
        for (; sent < 120; ++sent) {
            if (sent == 20) hanging.signal(SIGSTOP);
            ping->time = framework::wallClock();
            publishing.send(ping);
            std::this_thread::sleep_for(std::chrono::milliseconds(25));
        }
    });
    const bool continues = test::reaches(sent, 120);
    EXPECT_TRUE(continues) << "ping " << sent << " waits for a peer that hangs";
    if (!continues) hanging.signal(SIGKILL);
    all.get();
    EXPECT_EQ(good.result()["count"], 120);
    EXPECT_THAT(publishing.task.notices(), testing::IsEmpty());
}
