#pragma once
// Running tasks for tests, with their inputs and outputs.

#include "components/dds/PublisherTask.hpp"
#include "components/dds/SubscriberTask.hpp"
#include "components/framework/execution/Activity.hpp"
#include "tests/dds/Loopback.hpp"
#include "tests/support/Ports.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::dds {

inline TopicOut topicOut(const std::string& port, const std::string& topic, MessageType type) {
    TopicOut made;
    made.port = port;
    made.topic = topic;
    made.type = type;
    return made;
}

/** A publisher with one input port that the test writes to. */
template <class Carried>
struct Publishing {
    Publishing(std::vector<TopicOut> topics, const std::function<void(PublisherConfig&)>& change = {},
               const types::RosNames& names = {}) {
        task.environment().names = names;
        PublisherConfig config;
        config.topics = std::move(topics);
        if (change) change(config);
        task.config.set(config);
        writer.port.connectTo(*task.makeInput("in", writer.port), framework::ConnPolicy::buffer(8));
        const framework::Outcome configured = task.configure();
        EXPECT_TRUE(configured) << configured.reason;
        EXPECT_TRUE(task.start());
    }
    void send(const Carried& sample) {
        writer.port.write(sample);
        task.update();
    }

    PublisherTask task{"publisher"};
    test::Writer<Carried> writer;
};

/** A subscriber with one output port that the test reads; runs by itself once released. */
struct Subscribing {
    explicit Subscribing(const std::string& topic, PoseType type = PoseType::Odometry,
                         const std::function<void(SubscriberConfig&)>& change = {}, const types::RosNames& names = {}) {
        task.environment().names = names;
        SubscriberConfig config;
        config.topics.resize(1);
        config.topics[0].topic = topic;
        config.topics[0].type = type;
        if (change) change(config);
        task.config.set(config);
        auto* port = task.makeOutput("pose");
        port->connectTo(reader.port, framework::ConnPolicy::buffer(10'000));
        const framework::Outcome configured = task.configure();
        EXPECT_TRUE(configured) << configured.reason;
        EXPECT_TRUE(task.start());
        task.activity().release();
    }
    ~Subscribing() { task.activity().hold(); }
    /** Waits for the next pose. */
    std::optional<types::Pose> next() {
        types::Pose pose;
        if (!becomesTrue([&] { return reader.port.readNew(pose); })) return std::nullopt;
        return pose;
    }
    /** Returns a peer's first pose after its greetings, which are at the origin. */
    std::optional<types::Pose> findFirst(const Peer& peer) {
        auto pose = next();
        if (pose) peer.begin();
        while (pose && pose->position == glm::dvec3(0)) pose = next();
        return pose;
    }

    test::Reader<types::Pose> reader;
    SubscriberTask task{"subscriber"};
};

/** Returns a fan of noise, stamped now. */
inline types::SonarPtr makePing(uint32_t beams, uint32_t bins) {
    auto ping = std::make_shared<types::Sonar>();
    ping->resize(bins, beams);
    ping->time = framework::wallClock();
    ping->bin_duration = {20};
    ping->speed_of_sound = 1500;
    ping->beam_width = types::Angle{0.01};
    ping->beam_height = types::Angle{0.3};
    ping->setRegularBearings(types::Angle{-0.5}, types::Angle{1.0 / beams});
    for (size_t i = 0; i < ping->bins.size(); ++i) ping->bins[i] = static_cast<float>(1 + i % 97) / 97.0f;
    return ping;
}

/** A ping without a stamp, which a listening peer acknowledges with "met" and does not count. */
inline types::SonarPtr greeting() {
    auto ping = std::make_shared<types::Sonar>(*makePing(4, 4));
    ping->time = {};
    return ping;
}

}  // namespace insonify::dds
