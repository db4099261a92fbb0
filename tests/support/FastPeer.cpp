// A ROS 2 peer by Fast DDS, ROS 2's default, over the loopback interface in the domain of ROS_DOMAIN_ID:
//
//     dds_fast_peer listen TYPE TOPIC SECONDS COUNT         "ready" once it knows a writer, "met" at the first message
//                                                           without a stamp; then the number of messages with a stamp,
//                                                           and their size
//     dds_fast_peer send TYPE TOPIC GREETING FILE COUNT     the bytes of GREETING until SIGUSR1, then those of FILE, 40
//                                                           times a second
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace {

using namespace eprosima::fastdds::dds;
using Clock = std::chrono::steady_clock;
using Bytes = std::vector<char>;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

/** Messages in their encoding on the wire. */
struct Raw : TopicDataType {
    explicit Raw(const std::string& name) {
        setName(name.c_str());
        m_typeSize = 2 << 20;
        auto_fill_type_object(false);
        auto_fill_type_information(false);
    }
    bool serialize(void* data, SerializedPayload_t* payload) override {
        const Bytes& bytes = *static_cast<Bytes*>(data);
        payload->encapsulation = CDR_LE;
        payload->length = static_cast<uint32_t>(bytes.size());
        std::memcpy(payload->data, bytes.data(), bytes.size());
        return true;
    }
    bool deserialize(SerializedPayload_t* payload, void* data) override {
        static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
        return true;
    }
    std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
        return [data] { return static_cast<uint32_t>(static_cast<Bytes*>(data)->size()); };
    }
    void* createData() override { return new Bytes; }
    void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
    bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

volatile std::sig_atomic_t begun = 0;

Bytes toBytes(const char* path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/** Returns whether the header at the beginning, after four bytes on the encoding, has a stamp. */
bool hasStamp(const Bytes& message) {
    return message.size() >= 12 &&
           std::any_of(message.begin() + 4, message.begin() + 12, [](char c) { return c != 0; });
}

DomainParticipant* join() {
    DomainParticipantQos qos;
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.push_back("127.0.0.1");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    eprosima::fastrtps::rtps::Locator_t here;
    eprosima::fastrtps::rtps::IPLocator::setIPv4(here, 127, 0, 0, 1);
    qos.wire_protocol().builtin.initialPeersList.push_back(here);
    const char* domain = std::getenv("ROS_DOMAIN_ID");
    return DomainParticipantFactory::get_instance()->create_participant(
        domain ? static_cast<uint32_t>(std::atoi(domain)) : 0, qos);
}

int listen(DomainParticipant& participant, Topic* topic, double seconds, size_t count) {
    DataReaderQos qos = DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 200;
    DataReader* const reader = participant.create_subscriber(SUBSCRIBER_QOS_DEFAULT)->create_datareader(topic, qos);
    SubscriptionMatchedStatus matched;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    while (Clock::now() < end && matched.current_count == 0) {
        reader->get_subscription_matched_status(matched);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    std::cout << "ready" << std::endl;
    Bytes bytes;
    SampleInfo info;
    size_t received = 0, size = 0;
    bool met = false;
    while (Clock::now() < end && received < count) {
        if (reader->take_next_sample(&bytes, &info) != ReturnCode_t::RETCODE_OK || !info.valid_data) {
            std::this_thread::sleep_for(std::chrono::microseconds(200));
        } else if (hasStamp(bytes)) {
            ++received;
            size = bytes.size();
        } else if (!std::exchange(met, true)) {
            std::cout << "met" << std::endl;
        }
    }
    std::cout << "{\"count\": " << received << ", \"size\": " << size << "}" << std::endl;
    return 0;
}

int send(DomainParticipant& participant, Topic* topic, Bytes greeting, Bytes bytes, int count) {
    DataWriterQos qos = DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 200;
    qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    DataWriter* const writer = participant.create_publisher(PUBLISHER_QOS_DEFAULT)->create_datawriter(topic, qos);
    const auto write = [&](Bytes& message) {
        writer->write(&message);
        std::this_thread::sleep_for(std::chrono::milliseconds(25));
    };
    std::cout << "ready" << std::endl;
    while (!begun) write(greeting);
    for (int i = 0; i < count; ++i) write(bytes);
    writer->wait_for_acknowledgments({60, 0});
    std::cout << "{\"count\": " << count << "}" << std::endl;
    return 0;
}

}  // namespace

int main(int count, char** words) {
    const bool sends = count == 7 && words[1] == std::string("send");
    if (!sends && (count != 6 || words[1] != std::string("listen")))
        return std::cerr << "dds_fast_peer: see the head of tests/support/FastPeer.cpp\n", 2;
    std::signal(SIGUSR1, [](int) { begun = 1; });
    DomainParticipant* const participant = join();
    const TypeSupport type(new Raw(words[2]));
    type.register_type(participant);
    Topic* const topic = participant->create_topic("rt" + std::string(words[3]), words[2], TOPIC_QOS_DEFAULT);
    const int rounds = std::atoi(words[count - 1]);
    if (!sends) return listen(*participant, topic, std::atof(words[4]), size_t(rounds));
    return send(*participant, topic, toBytes(words[4]), toBytes(words[5]), rounds);
}
