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
#include "components/framework/TaskContext.hpp"
#include "components/framework/config/StreamNames.hpp"
#include "components/logger/LogThread.hpp"
#include "components/logger/LoggerConfig.hpp"
#include "components/logger/PropertyLog.hpp"

namespace insonify::logger {

/** Writes the samples of its connected ports to a pocolog file for Rock's tools or, when the file's name ends in .mcap,
 *  as ROS 2 messages to an MCAP file with metadata.yaml next to it for `ros2 bag`: see log/mcap/SampleWriter.hpp.
 *
 *  Ports: an input for each connection that names one, of any name and of any type in types/samples/Samples.hpp; give
 * it a buffer. A stream is named after its source, `task.port`, or the source's alias; a replayed stream keeps its
 * recorded name. A sample has the time at which it was true and the time at which it reached this task. Metadata of
 * every stream: the seed of the run, and the plans of the tasks at the stream's first sample, with which it is
 * declared. The first stream of the log also has the deployment. Streams without samples are declared at the end.
 * Streams of truth have the names of the objects (`insonify_objects`, a JSON list). Streams of pings have the mount of
 * their sonar in the body and the stream of the body's poses (`insonify_mount`, a JSON object, `insonify_body`). The
 * properties of all tasks are written to `property_file` at each start; if several loggers name the same file, the
 * first one writes it.
 *
 *  The log of a shard equals that of `log cut` from the whole run. It is not flushed before its end, because only a
 *  complete log is useful, and the places of flushes in an MCAP file depend on the speed of the run.
 *
 *  configure opens the file (and fails if it cannot be written), a separate thread writes it and flushes every
 *  `flush_period`, and cleanup finishes it with its index. The log continues in NAME.1.log after `max_file_size` or
 *  `max_file_duration`. If the file is slower than the samples, this task waits, and its ports' buffers count the lost
 *  samples. In realtime a full or broken disk causes RunTimeError: samples are lost and counted until the log continues
 *  in its next file, which is tried each second. A sample that the format cannot store is skipped. Outside of realtime,
 *  where no other sample may be lost, both cause Exception with the number of lost samples. Flushed samples stay. */
class LoggerTask final : public framework::TaskContext,
                         public framework::Divisible,
                         public framework::Recorder,
                         public framework::Adjustable {
public:
    using TaskContext::TaskContext;

    framework::Properties<LoggerConfig> config{this};

    /** Throws ConfigError for a type that a log cannot store. */
    framework::InputPortBase* makeInput(const std::string& port, framework::OutputPortBase& source) override;
    types::Notices notices() const override;
    std::optional<types::Recording> recording() const override;
    bool adjusts(const std::string& property) const override { return property == "record"; }

private:
    /** The stream of an input. */
    template <class T>
    struct Stream {
        const framework::StreamName name;   ///< Name of the source.
        std::optional<size_t> number = {};  ///< In the log, once declared.
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
    /** Whether this is the first logger of the deployment that writes this property file. */
    bool logsProperties();
    bool heals() const;
    void followHealth();
    void recordProperties();            ///< The properties of all tasks that changed since the last call.
    log::Metadata runMetadata() const;  ///< Common to all streams of the run.
    /** Returns the metadata of the log's next stream, with the current plans. */
    log::Metadata streamMetadata(const framework::StreamName& stream);
    /** Adds what is known of the sonar whose pings an input takes. */
    log::Metadata getMetadata(const auto& input);
    /** Returns the first stream of poses in the log that the pings of a port depend on; empty: none. */
    std::string getBody(const framework::InputPortBase& port) const;
    /** Returns the frames that several sonars claim in an MCAP file. */
    std::vector<std::string> sharedFrames() const;

    framework::DynamicInputs<types::SampleTypes, Stream> inputs_{this};
    std::unique_ptr<log::Writer> log_;
    std::optional<Rotation> rotation_;
    std::optional<PropertyLog> properties_;
    uint64_t recorded_changes_ = 0;  ///< Changes of the tasks' records at the last record of properties.
    RecordingBoard board_;
    std::optional<LogThread> thread_;
    std::vector<std::string> frame_notices_;
    LogHealth health_;                                        ///< As reported.
    std::map<std::string, types::PropertyValue> configured_;  ///< The property values at configure.
    size_t declared_ = 0;                                     ///< Streams in the log.
    bool has_started_ = false;                                ///< Since it was configured.
};

/** Registers the tasks of this folder. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::logger
