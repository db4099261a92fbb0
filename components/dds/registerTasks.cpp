#include "components/dds/registerTasks.hpp"

#include "components/dds/PublisherTask.hpp"
#include "components/dds/SubscriberTask.hpp"

namespace insonify::dds {

void registerTasks(framework::Registry& registry) {
    registry.add<PublisherTask>("dds::PublisherTask", "sends pings, poses and pictures as ROS 2 messages");
    registry.add<SubscriberTask>("dds::SubscriberTask", "reads poses that ROS 2 nodes send");
}

}  // namespace insonify::dds
