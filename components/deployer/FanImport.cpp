#include "components/deployer/FanImport.hpp"

#include <fmt/format.h>

#include <cmath>

#include "components/deployer/FanTasks.hpp"
#include "components/deployer/RecordedLog.hpp"
#include "components/recordings/FanFile.hpp"
#include "types/Range.hpp"

namespace insonify::deployer {
namespace {

namespace fs = std::filesystem;
using framework::DeploymentSpec;
using recordings::FanFile, recordings::FanFrame;

/** Returns what the file states of its tasks, for the metadata of a log without a deployment. */
std::string fanText(const FanFile& file) {
    const std::string law =
        file.dynamicRange() ? fmt::format(", law: log, dynamic_range_db: {}", *file.dynamicRange()) : "";
    return fmt::format(
        "# A forward-looking sonar as its recording states it.\n"
        "tasks:\n"
        "  sonar: {{type: sonar::SonarTask}}\n"
        "  receiver: {{type: receiver::ReceiverTask, properties: {{output: code, code: {{bits: {}{}}}}}}}\n"
        "connections:\n"
        "  - {{from: sonar.ping, to: receiver.intensity}}\n",
        FanFile::code_bits, law);
}

/** Returns properties that give the deployment's pings the shape and the law of this ping. */
std::vector<std::string> fanProperties(const FanTasks& tasks, const FanFile& file, const FanFrame& frame) {
    const types::Sonar& ping = frame.ping;
    std::vector<std::string> all = tasks.propertiesOf(ping, ping.binStart(ping.bin_count),
                                                      static_cast<double>(ping.speed_of_sound), frame.frequency_khz);
    const auto set = [&](const char* property, const std::string& value) {
        all.push_back(tasks.receiver + "." + property + "=" + value);
    };
    if (frame.window_start > 0) set("blanking", fmt::format("{{range_min: {}}}", frame.window_start));
    if (file.dynamicRange()) {
        set("code.law", "log");
        set("code.dynamic_range_db", fmt::format("{}", *file.dynamicRange()));
    }
    return all;
}

/** Writes the pings of a recording and the poses at which they were made. */
class FanLog {
public:
    FanLog(RecordedLog& log, const FanTasks& tasks, FanFile& file, const FanFrame& first)
        : log_(log), tasks_(tasks), file_(file), begin_(first.ping.time), has_poses_(isUsable(first.sonar)) {}

    void write(const FanFrame& frame, double code_factor) {
        log_.set(fanProperties(tasks_, file_, frame), frame.ping.time);
        has_poses_ ? writePose(frame.sonar) : followTrajectories(frame.ping.time);
        if (frame.altitude > 0) {
            types::Range range;
            range.time = frame.ping.time;
            range.range = frame.altitude;
            log_.write("altimeter.range", range);
        }
        log_.write(tasks_.receiver + ".ping", withCodesTimes(code_factor, frame.ping),
                   {{"insonify_frequency_khz", fmt::format("{}", frame.frequency_khz)}});
    }

private:
    void writePose(const types::Pose& pose) {
        if (!isUsable(pose)) return;
        const log::Metadata origin{{"insonify_origin", file_.origin()}};
        for (const auto& [stream, trajectory] : tasks_.trajectories) log_.write(stream, pose, origin);
        if (tasks_.trajectories.empty()) log_.write("vehicle.pose", pose, origin);
        log_.write(tasks_.sonar + ".pose", pose, origin);
    }
    void followTrajectories(types::Time time) {
        for (const auto& [stream, trajectory] : tasks_.trajectories) {
            types::Pose pose = trajectory.at((time - begin_).seconds());
            pose.time = time;
            log_.write(stream, pose);
        }
    }

    RecordedLog& log_;
    const FanTasks& tasks_;
    FanFile& file_;
    const types::Time begin_;
    const bool has_poses_;  ///< The recording has poses.
};

}  // namespace

Imported importFan(const fs::path& recording, std::optional<DeploymentSpec> spec, const fs::path& to) {
    const auto file = recordings::openFan(recording);
    std::optional<FanFrame> frame = file->next();
    if (!frame) {
        std::string why;
        for (const std::string& notice : file->notices()) why += "; " + notice;
        throw types::ConfigError(recording.string(), "", "holds no ping of a sonar" + why);
    }
    const double maximum = std::exp2(FanFile::code_bits) - 1;
    FanTasks tasks{.max_code = maximum};
    if (spec) {
        tasks = FanTasks::of(*spec);
        if (!isUsable(frame->sonar)) refuseWithoutTrajectory(tasks, spec->file);
    }
    RecordedLog log(recording, std::move(spec), fanText(*file), to);
    FanLog written(log, tasks, *file, *frame);
    Imported imported{.stream = tasks.receiver + ".ping"};
    for (; frame; frame = file->next(), ++imported.pings) written.write(*frame, tasks.max_code / maximum);
    log.close();
    imported.properties = log.properties();
    imported.changes = log.changes();
    imported.notices = file->notices();
    return imported;
}

}  // namespace insonify::deployer
