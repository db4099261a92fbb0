// A peer that hangs holds up neither the simulator nor other peers.
#include <gmock/gmock.h>

#include "tests/dds/Ends.hpp"

using namespace insonify;
using namespace insonify::dds;
using nlohmann::json;

namespace {

class SlowReaderTest : public WithPeer {};

}  // namespace

TEST_F(SlowReaderTest, APeerThatHangsStallsNothing) {
    TopicOut topic = topicOut("in", "/auv/sonar", message_type<ros::ProjectedSonarImage>);
    topic.sonar.dtype = ros::ImageType::Float32;
    Publishing<types::SonarPtr> publishing({topic}, [](PublisherConfig& config) { config.depth = 200; });
    Peer hanging("listen ProjectedSonarImage /auv/sonar 120"), good("listen ProjectedSonarImage /auv/sonar 90 120");
    ASSERT_TRUE(hanging.ready() && good.ready());
    std::this_thread::sleep_for(std::chrono::seconds(3));
    auto ping = std::make_shared<types::Sonar>(*pingOf(256, 1000));
    std::vector<double> times;  // [ms]
    for (int i = 0; i < 120; ++i) {
        if (i == 20) hanging.signal(SIGSTOP);
        const auto start = std::chrono::steady_clock::now();
        ping->time = framework::wallClock();
        publishing.send(ping);
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        std::this_thread::sleep_until(start + std::chrono::milliseconds(25));
    }
    const json found = good.result();
    EXPECT_EQ(found["count"], 120);
    std::ranges::sort(times);
    std::cout << "a ping of 1 MB is sent in " << times[60] << " ms, at most " << times.back() << " ms\n";
    EXPECT_LT(times[60], 50);
    EXPECT_THAT(publishing.task.notices(), testing::IsEmpty());
}
