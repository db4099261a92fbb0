#pragma once
// The ends of a topic: who sends its messages, and who takes them.
#include <functional>
#include <memory>
#include <string>

#include "components/dds/Node.hpp"
#include "components/dds/RawType.hpp"

namespace insonify::dds {

/** Sends the messages of one topic. */
class Writer {
public:
    /** `ros_type` as "sensor_msgs/msg/Image"; `type_hash` as "RIHS01_...", or empty. The node is to outlive it. Throws
     *  types::ConfigError. */
    Writer(Node& node, const std::string& dds_topic, const std::string& ros_type, const std::string& type_hash,
           const Quality& quality);

    /** Waits for no reader. False where the message could not be sent; `failure` tells why. */
    bool write(const Bytes& message);
    const std::string& failure() const { return failure_; }
    bool hasReaders() const;
    int32_t handle() const { return entity_.handle(); }

private:
    Entity topic_, entity_;
    std::string failure_;
};

/** Takes the messages of one topic. */
class Reader {
public:
    /** `arrived` is called on a thread of Cyclone's, which it must not hold up; it may be empty. Messages of more than
     *  `largest` bytes come empty. The node is to outlive this. Throws types::ConfigError. */
    Reader(Node& node, const std::string& dds_topic, const std::string& ros_type, const std::string& type_hash,
           const Quality& quality, std::function<void()> arrived, size_t largest = any_size);
    ~Reader();

    /** The next message; its memory is used again. False: there is none. `sender` is one number for each writer. */
    bool take(Bytes& message, uint64_t& sender);
    /** Whether a sender is still there. */
    bool hears(uint64_t sender) const;
    int32_t handle() const { return entity_.handle(); }

private:
    std::unique_ptr<std::function<void()>> arrived_;
    Entity topic_, entity_;
};

}  // namespace insonify::dds
