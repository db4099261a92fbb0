#include "components/deployer/log/Import.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <type_traits>

#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/log/Stream.hpp"
#include "components/log/Writer.hpp"
#include "components/logger/PropertyLog.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/recordings/RecordingReader.hpp"
#include "components/sonar/tasks/AltimeterTask.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "components/sonar/tasks/ScanningSonarTask.hpp"
#include "components/sonar/tasks/SideScanTask.hpp"
#include "types/geometry/BeamArc.hpp"
#include "types/samples/Range.hpp"
#include "types/samples/SonarSettings.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::deployer {
namespace {

namespace fs = std::filesystem;
using framework::DeploymentSpec;
using recordings::RecordedPing, recordings::RecordedShape, recordings::RecordingReader;

/** The log made from a recording. With a deployment, properties.0.log is next to it, as the logger of a run writes it.
 *  Without one, only what the recording states is known of the tasks. */
class RecordedLog {
public:
    /** @param text a deployment for the metadata, if `spec` is none */
    RecordedLog(const fs::path& recording, std::optional<DeploymentSpec> spec, const std::string& text, fs::path to)
        : has_deployment_(spec.has_value()),
          spec_(spec ? std::move(*spec) : DeploymentSpec::parse(text, to.string())),
          to_(std::move(to)),
          run_{{"insonify_deployment", spec_.text}, {"insonify_recording", recording.filename().string()}} {}

    /** Sets properties, as `--set` takes them, that apply from the ping at `from` on; before the first sample. Changed
     *  properties are written again. Throws types::ConfigError for properties that the tasks refuse, and where a file
     *  cannot be made. */
    void set(const std::vector<std::string>& properties, types::Time from) {
        if (properties == last_) return;
        if (has_deployment_) record(properties, from);
        if (!log_) {
            log_ = log::createLog(to_);
            first_ = properties;
        } else
            ++changes_;
        last_ = properties;
    }
    /** Adds a sample to "task.port". @param more metadata of the stream */
    template <class T>
    void write(const std::string& stream, const T& sample, const log::Metadata& more = {}) {
        const auto [found, is_new] = streams_.try_emplace(stream);
        if (is_new) {
            log::Metadata metadata = getMetadata(stream, more);
            log::addSampleMetadata(&sample, metadata);
            found->second = log_->addStream<T>(stream, metadata);
        }
        log_->write(found->second, sample.time, sample);
    }
    /** Ends the log, and states its properties and their changes. */
    void close(Imported& imported) {
        log_->close();
        if (properties_) properties_->close();
        imported.properties = first_;
        imported.changes = changes_;
    }

private:
    void record(const std::vector<std::string>& properties, types::Time from) {
        for (const std::string& property : properties) spec_.set(property);
        framework::Deployment deployment(spec_, registry_);
        run_["insonify_seed"] = std::to_string(deployment.environment().seed);
        const fs::path file = to_.parent_path() / "properties.0.log";
        if (!properties_) {
            std::error_code none;
            const bool is_own = fs::exists(to_, none) && log::propertyLog(*log::openLog(to_)) == file;
            if (fs::exists(file, none) && !is_own)
                throw types::ConfigError(file.string(), "--to", "is of another run; give the log a folder of its own");
            properties_.emplace(file);
        }
        properties_->record(deployment.environment().records(), from, run_);
    }
    log::Metadata getMetadata(const std::string& stream, const log::Metadata& more) const {
        log::Metadata all = more;
        all.insert(run_.begin(), run_.end());
        if (const framework::TaskSpec* task = spec_.task(framework::splitPort(stream).first))
            all["rock_task_model"] = task->type;
        return all;
    }

    const bool has_deployment_;
    DeploymentSpec spec_;
    fs::path to_;
    framework::Registry registry_ = coreTasks();
    std::unique_ptr<log::Writer> log_;
    std::optional<logger::PropertyLog> properties_;
    log::Metadata run_;  ///< Shared by all streams.
    std::map<std::string, size_t> streams_;
    std::vector<std::string> first_, last_;  ///< Properties of the first ping, and of the last one.
    size_t changes_ = 0;                     ///< How often they changed after the first ping.
};

/** The tasks of a deployment that correspond to the recorded sonar; without a deployment, default names. */
struct RecordedTasks {
    std::string sonar = "sonar", receiver = "receiver", altitude = "altimeter.range";
    std::string settings = "";    ///< Stream of the requests that drive the sonar of one beam; empty: there is none.
    double max_code = 0;          ///< The receiver's max code.
    bool has_beam_width = false;  ///< Whether the deployment states the width of a beam.
    std::vector<std::pair<std::string, pose::Trajectory>> trajectories{};  ///< By the stream of their poses.
    std::vector<std::string> vehicles{"vehicle.pose"};                     ///< Streams of poses of the sonar's vehicle.
};

/** Returns the first sonar of a type that a receiver hears; null: it hears none. */
template <class Sonar>
const Sonar* getSonar(const receiver::ReceiverTask& receiver, const framework::Deployment& deployment) {
    for (const std::string& name : upstream({receiver.name()}, deployment))
        if (const auto* sonar = dynamic_cast<const Sonar*>(deployment.task(name))) return sonar;
    return nullptr;
}

/** Throws types::ConfigError for a deployment without a receiver that outputs codes of the pings of such a sonar. */
template <class Sonar>
RecordedTasks recordedTasks(const DeploymentSpec& spec, const char* sonar_type) {
    framework::Registry registry = coreTasks();
    const framework::Deployment deployment(spec, registry);
    const receiver::ReceiverTask* receiver = &findCodingReceiver(deployment, spec.file);
    for (const auto& task : deployment.tasks())
        if (const auto* other = dynamic_cast<const receiver::ReceiverTask*>(task.get()))
            if (other->config->output == receiver::Output::Code && !getSonar<Sonar>(*receiver, deployment))
                receiver = other;
    const Sonar* const sonar = getSonar<Sonar>(*receiver, deployment);
    if (!sonar)
        throw types::ConfigError(spec.file, "tasks." + receiver->name(),
                                 std::string("has no input from a ") + sonar_type + ", whose pings are recorded");
    RecordedTasks tasks{.sonar = sonar->name(), .receiver = receiver->name(), .vehicles = {}};
    tasks.max_code = std::exp2(receiver->config->code.value_or(receiver::CodeConfig{}).bits) - 1;
    constexpr bool is_scan = std::is_same_v<Sonar, sonar::ScanningSonarTask>,
                   is_sounder = std::is_same_v<Sonar, sonar::AltimeterTask>,
                   is_line = std::is_same_v<Sonar, sonar::SideScanTask>;
    if constexpr (is_sounder) tasks.altitude = sonar->range.path();
    for (const framework::Connection& connection : deployment.connections())
        if ((is_scan || is_sounder) && connection.to == &sonar->settings) tasks.settings = connection.from->path();
    if (is_scan && tasks.settings.empty())
        throw types::ConfigError(spec.file, "tasks." + sonar->name(),
                                 "has no connection to `settings`, by which each recorded ping gets its bearing; "
                                 "connect the `settings` of a device::Ping360Task, as deploy/hil_ping360.yml does");
    if constexpr (std::is_same_v<Sonar, sonar::SonarTask>)
        tasks.has_beam_width = sonar->sonarConfig().beam_width_deg.has_value();
    const std::set<std::string> sources = upstream({tasks.sonar}, deployment);
    for (const auto& task : deployment.tasks())
        if (const auto* source = dynamic_cast<const pose::TrajectoryTask*>(task.get())) {
            tasks.trajectories.emplace_back(source->name() + ".pose", source->trajectory());
            if (!is_line || sources.contains(source->name())) tasks.vehicles.push_back(source->name() + ".pose");
        }
    if (!is_line && tasks.vehicles.empty()) tasks.vehicles = {"vehicle.pose"};
    return tasks;
}

RecordedTasks recordedTasks(const DeploymentSpec& spec, RecordedShape shape) {
    switch (shape) {
        case RecordedShape::Line: return recordedTasks<sonar::SideScanTask>(spec, "sonar::SideScanTask");
        case RecordedShape::Scan: return recordedTasks<sonar::ScanningSonarTask>(spec, "sonar::ScanningSonarTask");
        case RecordedShape::Sounder: return recordedTasks<sonar::AltimeterTask>(spec, "sonar::AltimeterTask");
        default: return recordedTasks<sonar::SonarTask>(spec, "sonar::SonarTask");
    }
}

/** Returns the bits of the codes of a side-scan, whose samples are not stated to be codes; none if a sample is no whole
 *  number of at most 16 bits. */
std::optional<int> lineCodeBits(const fs::path& recording) {
    float maximum = 0;
    const auto reader = RecordingReader::open(recording);
    for (auto line = reader->next(); line; line = reader->next())
        for (const float bin : line->ping.bins) {
            if (!(bin >= 0 && bin <= 65535 && std::floor(bin) == bin)) return std::nullopt;
            maximum = std::max(maximum, bin);
        }
    return std::max(1, static_cast<int>(std::ceil(std::log2(maximum + 1))));
}

/** Writes the pings of a recording, and the poses and altitudes at which they were made. */
class Import {
public:
    Import(const fs::path& recording, std::optional<DeploymentSpec> spec, const fs::path& to)
        : reader_(RecordingReader::open(recording)),
          shape_(reader_->shape()),
          is_line_(shape_ == RecordedShape::Line),
          line_bits_(is_line_ ? lineCodeBits(recording) : std::nullopt),
          ping_(reader_->next().value()),
          tasks_(spec ? recordedTasks(*spec, shape_) : RecordedTasks{.max_code = std::exp2(ping_.code.bits) - 1}),
          has_poses_(is_line_ || isUsable(ping_.sonar)) {
        if (spec && !has_poses_ && tasks_.trajectories.empty())
            throw types::ConfigError(spec->file, "tasks",
                                     "have no pose::TrajectoryTask, which states where the recording was made");
        log_.emplace(recording, std::move(spec), deploymentText(), to);
    }

    Imported run() {
        Imported imported{.stream = tasks_.receiver + ".ping"};
        for (std::optional<RecordedPing> next = ping_; next; next = reader_->next(), ++imported.pings) {
            ping_ = std::move(*next);
            write();
        }
        log_->close(imported);
        imported.notices = reader_->notices();
        return imported;
    }

private:
    /** Returns what the recording states of its tasks, for the metadata of a log without a deployment. */
    std::string deploymentText() const {
        const receiver::CodeConfig& code = ping_.code;
        const bool is_amplitude = ping_.law_known && code.law == receiver::CodeLaw::Sqrt;
        std::string receiver = "{type: receiver::ReceiverTask, properties: {output: intensity}}";
        if (is_line_ && line_bits_)
            receiver = "{type: receiver::ReceiverTask, properties: {output: code, code: {bits: 16}}}";
        if (!is_line_)
            receiver = fmt::format(
                "{{type: receiver::ReceiverTask, properties: {{output: code, code: {{bits: {}{}}}}}}}", code.bits,
                ping_.law_known ? fmt::format(", law: log, dynamic_range_db: {}", code.dynamic_range_db) : "");
        if (is_amplitude)
            receiver = fmt::format(
                "\n    type: receiver::ReceiverTask\n"
                "    properties: {{output: code, code: {{bits: {}, law: sqrt, gamma: {}}}}}",
                code.bits, code.gamma);
        struct Names {
            const char *words, *type;
        };
        constexpr Names names[] = {{"forward-looking sonar", "SonarTask"},
                                   {"side-scan", "SideScanTask"},
                                   {"scanning sonar", "ScanningSonarTask"},
                                   {"echo sounder", "AltimeterTask"}};  // in the order of RecordedShape
        return fmt::format(
            "# A {} as its recording states it.\n"
            "tasks:\n"
            "  sonar: {{type: sonar::{}}}\n"
            "  receiver:{}{}\n"
            "connections:\n"
            "  - {{from: sonar.ping, to: receiver.intensity}}\n",
            is_amplitude ? "sonar" : names[static_cast<size_t>(shape_)].words, names[static_cast<size_t>(shape_)].type,
            is_amplitude ? "" : " ", receiver);
    }

    /** Returns properties, as `--set` takes them, that give the deployment's pings the shape and the law of this one.
     */
    std::vector<std::string> properties() const {
        const types::Sonar& ping = ping_.ping;
        std::vector<std::string> all;
        const auto set = [&](const std::string& task, const char* property, const auto& value) {
            all.push_back(fmt::format("{}.{}={}", task, property, value));
        };
        const bool is_driven = !tasks_.settings.empty();  // by requests with the rest
        if (!is_driven) set(tasks_.sonar, "range", ping_.range);
        if (!is_driven) set(tasks_.sonar, "bin_count", ping.bin_count);
        set(tasks_.sonar, "range_rounding", "exact");
        if (is_line_)
            set(tasks_.sonar, "speed_of_sound", ping.speed_of_sound);
        else if (ping_.speed_of_sound > 0)
            set(tasks_.sonar, "speed_of_sound", ping_.speed_of_sound);
        if (ping_.frequency_khz > 0 && !is_driven) set(tasks_.sonar, "frequency_khz", ping_.frequency_khz);
        if (is_line_) {
            if (!ping.beam_width.isUnknown()) set(tasks_.sonar, "beam_width_deg", ping.beam_width.deg());
            if (!ping.beam_height.isUnknown()) set(tasks_.sonar, "beam_height_deg", ping.beam_height.deg());
            return all;
        }
        if (shape_ != RecordedShape::Fan) return all;
        std::vector<double> bearings;
        for (const types::Angle bearing : ping.bearings) bearings.push_back(types::degrees(bearing.rad));
        set(tasks_.sonar, "bearings_deg", bearings);
        if (!tasks_.has_beam_width)  // as wide as their spacing
            set(tasks_.sonar, "beam_width_deg", types::degrees(types::BeamArc(ping).width));
        if (ping_.window_start > 0)
            set(tasks_.receiver, "blanking", fmt::format("{{range_min: {}}}", ping_.window_start));
        if (!ping_.law_known) return all;
        const bool is_log = ping_.code.law == receiver::CodeLaw::Log;
        set(tasks_.receiver, "code.law", is_log ? "log" : "sqrt");
        set(tasks_.receiver, is_log ? "code.dynamic_range_db" : "code.gamma",
            is_log ? ping_.code.dynamic_range_db : ping_.code.gamma);
        return all;
    }

    /** Returns the request of a driver for this ping. */
    types::SonarSettings request() const {
        types::SonarSettings settings;
        settings.time = ping_.ping.time;
        settings.range = ping_.range;
        settings.bin_count = ping_.ping.bin_count;
        settings.gain_db = ping_.gain_db;
        if (ping_.frequency_khz > 0) settings.frequency_khz = ping_.frequency_khz;
        if (shape_ == RecordedShape::Scan) settings.bearing = ping_.ping.bearings.front();
        return settings;
    }

    void write() {
        log_->set(properties(), ping_.ping.time);
        if (isUsable(ping_.sonar)) {
            const log::Metadata origin{{"insonify_origin", reader_->origin()}};
            for (const std::string& vehicle : tasks_.vehicles) log_->write(vehicle, ping_.sonar, origin);
            log_->write(tasks_.sonar + ".pose", ping_.sonar, origin);
        }
        if (!has_poses_)
            for (const auto& [stream, trajectory] : tasks_.trajectories) {
                types::Pose pose = trajectory.at(ping_.since_first);
                pose.time = ping_.ping.time;
                log_->write(stream, pose);
            }
        if (!tasks_.settings.empty()) log_->write(tasks_.settings, request());
        if (ping_.altitude > 0) {
            types::Range range;
            range.time = ping_.ping.time;
            range.range = ping_.altitude;
            log_->write(tasks_.altitude, range);
        }
        log::Metadata more{{"insonify_frequency_khz", fmt::format("{}", ping_.frequency_khz)}};
        if (line_bits_) more["insonify_code_bits"] = std::to_string(*line_bits_);
        if (!is_line_)  // from the device's max code to the receiver's
            for (float& bin : ping_.ping.bins)
                bin = static_cast<float>(static_cast<double>(bin) * (tasks_.max_code / ping_.max_code));
        log_->write(tasks_.receiver + ".ping", ping_.ping, more);
    }

    const std::unique_ptr<RecordingReader> reader_;
    const RecordedShape shape_;
    const bool is_line_;
    const std::optional<int> line_bits_;
    RecordedPing ping_;  ///< The ping that is written.
    const RecordedTasks tasks_;
    const bool has_poses_;  ///< Whether the recording has poses; else those of the trajectories are written.
    std::optional<RecordedLog> log_;
};

}  // namespace

Imported importRecording(const fs::path& recording, std::optional<DeploymentSpec> spec, const fs::path& to) {
    if (std::error_code none; fs::equivalent(recording, to, none))
        throw types::ConfigError(to.string(), "--to", "is the recording itself; the log must be another file");
    return Import(recording, std::move(spec), to).run();
}

}  // namespace insonify::deployer
