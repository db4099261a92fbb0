#pragma once
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

}  // namespace insonify::dds
