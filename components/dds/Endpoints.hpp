#pragma once
// The endpoints of a topic: a writer and a reader.
#include <functional>
#include <memory>
#include <string>

#include "components/dds/Node.hpp"

namespace insonify::dds {

/** Sends the messages of one topic. */
class Writer {
public:
    /** @param ros_type as "sensor_msgs/msg/Image"
     *  @param type_hash as "RIHS01_...", or empty
     *  @param pairs announced with it, as "serviceid=1.2;"
     *  The node must outlive the writer. Throws types::ConfigError. */
    Writer(Node& node, const std::string& dds_topic, const std::string& ros_type, const std::string& type_hash,
           const Quality& quality, const std::string& pairs = "");

    /** Sends without waiting for readers. Returns false if the message could not be sent; `failure` then has the
     *  reason. */
    bool write(const Bytes& message);
    const std::string& failure() const { return failure_; }
    bool hasReaders() const;
    int32_t handle() const { return entity_.handle(); }

private:
    Entity topic_, entity_;
    std::string failure_;
};

/** Receives the messages of one topic. */
class Reader {
public:
    /** @param arrived may be empty; is called on one of Cyclone's threads and must not block it
     *  @param maximum max message [B]; larger messages arrive empty
     *  The node must outlive the reader. Throws types::ConfigError. */
    Reader(Node& node, const std::string& dds_topic, const std::string& ros_type, const std::string& type_hash,
           const Quality& quality, std::function<void()> arrived, size_t maximum = any_size,
           const std::string& pairs = "");
    ~Reader();

    /** Takes the next message into `message`, whose memory is reused. Returns false if there is none. `sender` is a
     *  number that identifies the writer. */
    bool take(Bytes& message, uint64_t& sender);
    /** Returns whether the sender is still present. */
    bool receives(uint64_t sender) const;
    int32_t handle() const { return entity_.handle(); }

private:
    std::unique_ptr<std::function<void()>> arrived_;
    Entity topic_, entity_;
};

}  // namespace insonify::dds
