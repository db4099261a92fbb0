#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/StreamNames.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/logger/LogThread.hpp"
#include "components/logger/LoggerConfig.hpp"
#include "components/logger/PropertyLog.hpp"
#include "components/logger/Rotation.hpp"

namespace insonify::logger {

/** Writes what it is connected to into a pocolog file that Rock's tools open, or, when its name ends in .mcap, as
 *  ROS 2 messages into an MCAP file, with metadata.yaml beside it for `ros2 bag`: see log/mcap/SampleWriter.hpp.
 *
 *  Ports: an input for each connection that names one, whatever the name, of any type in types/Samples.hpp; give
 *  it a buffer. The stream is named after its source, `task.port`; one with an alias after that, a replayed one as it
 *  was. Samples bear the time at which they were true and
 *  the time at which they reached this task. Every stream carries the seed of the run in its metadata, and the plans
 * that the tasks had at its first sample, with which it is declared, the first one of the log the deployment as well;
 * streams without samples come at the end. One of truth has the names of the objects as well (`insonify_objects`, a
 * JSON list); one of pings the mount of its sonar in the body and the stream of the body's poses (`insonify_mount`, a
 * JSON object, `insonify_body`). The properties of all tasks go into `property_file` at each start; of several loggers
 * that name one, the first does it.
 *
 *  The log of a shard is what `log cut` makes of the whole run's. It is not flushed before its end, for it is of use
 *  whole alone, and where an MCAP file is flushed depends on how fast the run is.
 *
 *  The file is opened by configure (what cannot be written refuses it), written by a thread of its own, flushed every
 *  `flush_period`, continued in NAME.1.log where `max_file_size` or `max_file_duration` says so, and finished with its
 *  index by cleanup. A file slower than the samples makes this task wait, and then its ports' buffers count what they
 *  lose. In realtime a disk that is full or broken is RunTimeError, in which samples are lost and counted, until the
 * log goes on in its next file, which is tried each second; a sample that the format cannot hold is passed over.
 * Outside of realtime, where nothing else may be lost, both end in Exception, which states how many samples are lost.
 * What was flushed stays. */
class LoggerTask final : public framework::TaskContext, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<LoggerConfig> config{this};

    /** Throws ConfigError for a type that a log cannot hold. */
    framework::InputPortBase* makeInput(const std::string& port, framework::OutputPortBase& source) override;
    std::vector<std::string> notices() const override;

private:
    /** The stream of an input. */
    template <class T>
    struct Stream {
        const framework::StreamName name;   ///< Of the source.
        std::optional<size_t> number = {};  ///< In the log, once it is declared.
    };

    bool configureHook() override;
    bool propertiesHook() override;
    bool startHook() override;
    void updateHook() override;
    void errorHook() override { updateHook(); }
    void stopHook() override;
    void cleanupHook() override;
    void checkInputs() const;
    /** The values of all properties but `record`. */
    std::map<std::string, types::PropertyValue> fixedValues() const;
    std::filesystem::path makePath(const std::string& file) const;
    /** Whether no other logger of the deployment writes the same property file and comes first. */
    bool logsProperties();
    bool heals() const;
    void followHealth();
    void recordProperties();            ///< What of all tasks' properties has changed since the last time.
    log::Metadata runMetadata() const;  ///< What all streams of the run carry.
    /** Metadata of the log's next stream, with the current plans. */
    log::Metadata streamMetadata(const framework::StreamName& stream);
    /** With what is known of the sonar whose pings an input takes. */
    template <class Input>
    log::Metadata metadataOf(const Input& input);
    /** The first stream of poses in the log that the pings of a port depend on; empty: none. */
    std::string bodyOf(const framework::InputPortBase& port) const;
    /** Frames to which different sonars lay claim in an MCAP file. */
    std::vector<std::string> sharedFrames() const;

    framework::DynamicInputs<types::SampleTypes, Stream> inputs_{this};
    std::unique_ptr<log::Writer> log_;
    std::optional<Rotation> rotation_;
    std::optional<PropertyLog> properties_;
    uint64_t recorded_changes_ = 0;  ///< Of the tasks' records, with the last record of properties.
    std::optional<LogThread> thread_;
    std::vector<std::string> frame_notices_;
    LogHealth health_;                                        ///< As reported.
    std::map<std::string, types::PropertyValue> configured_;  ///< With these values.
    size_t declared_ = 0;                                     ///< Streams in the log.
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::logger
