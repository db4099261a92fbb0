#include "components/deployer/Import.hpp"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

#include "components/deployer/FanImport.hpp"
#include "components/deployer/RecordedLog.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/recordings/FanFile.hpp"
#include "components/recordings/SideScanFile.hpp"
#include "components/sonar/tasks/SideScanTask.hpp"
#include "types/Range.hpp"

namespace insonify::deployer {
namespace {

namespace fs = std::filesystem;
using framework::DeploymentSpec;
using recordings::SideScanLine;

/** Facts about a side-scan's recording that are needed before its first ping is written. */
struct SideScanCodes {
    bool whole = true;  ///< All samples are whole numbers of at most 16 bits.
    float maximum = 0;
    size_t pings = 0;
    int bits() const { return std::max(1, static_cast<int>(std::ceil(std::log2(maximum + 1)))); }
};

SideScanCodes codesIn(const fs::path& recording) {
    SideScanCodes codes;
    const auto file = recordings::openSideScan(recording);
    for (auto line = file->next(); line; line = file->next(), ++codes.pings)
        for (const float bin : line->ping.bins) {
            codes.whole &= bin >= 0 && bin <= 65535 && std::floor(bin) == bin;
            codes.maximum = std::max(codes.maximum, bin);
        }
    if (codes.pings == 0) {
        std::string why;
        for (const std::string& notice : file->notices()) why += "; " + notice;
        throw types::ConfigError(recording.string(), "", "holds no ping of a side-scan" + why);
    }
    return codes;
}

/** Returns what the file states of its tasks, for the metadata of a log without a deployment. */
std::string sideScanText(const SideScanCodes& codes) {
    return fmt::format(
        "# A side-scan as its recording states it.\n"
        "tasks:\n"
        "  sonar: {{type: sonar::SideScanTask}}\n"
        "  receiver: {{type: receiver::ReceiverTask, properties: {}}}\n"
        "connections:\n"
        "  - {{from: sonar.ping, to: receiver.intensity}}\n",
        codes.whole ? "{output: code, code: {bits: 16}}" : "{output: intensity}");
}

std::vector<std::string> propertiesOf(const std::string& sonar, const SideScanLine& line) {
    std::vector<std::string> all;
    const auto set = [&](const char* property, const auto& value) {
        all.push_back(fmt::format("{}.{}={}", sonar, property, value));
    };
    const types::Sonar& ping = line.ping;
    set("range", ping.binStart(ping.bin_count));
    set("bin_count", ping.bin_count);
    set("range_rounding", "exact");
    set("speed_of_sound", ping.speed_of_sound);
    if (line.frequency_khz > 0) set("frequency_khz", line.frequency_khz);
    if (!ping.beam_width.isUnknown()) set("beam_width_deg", ping.beam_width.deg());
    if (!ping.beam_height.isUnknown()) set("beam_height_deg", ping.beam_height.deg());
    return all;
}

/** Streams of the poses of the vehicle that carries the sonar. */
std::vector<std::string> vehiclePoses(const framework::Deployment& deployment, const std::string& sonar) {
    std::vector<std::string> streams;
    for (const std::string& task : upstream({sonar}, deployment))
        if (dynamic_cast<const pose::TrajectoryTask*>(deployment.task(task))) streams.push_back(task + ".pose");
    return streams;
}

Imported importSideScan(const fs::path& recording, std::optional<DeploymentSpec> spec, const fs::path& to) {
    const SideScanCodes codes = codesIn(recording);
    std::string sonar = "sonar", receiver = "receiver";
    std::vector<std::string> vehicles{"vehicle.pose"};
    if (spec) {
        framework::Registry registry = coreTasks();
        const framework::Deployment deployment(*spec, registry);
        std::tie(sonar, receiver) = recordedTasks<sonar::SideScanTask>(deployment, "sonar::SideScanTask");
        vehicles = vehiclePoses(deployment, sonar);
    }
    RecordedLog log(recording, std::move(spec), sideScanText(codes), to);
    Imported imported{.stream = receiver + ".ping"};
    const auto file = recordings::openSideScan(recording);
    for (auto line = file->next(); line; line = file->next(), ++imported.pings) {
        log.set(propertiesOf(sonar, *line), line->ping.time);
        if (const types::Pose& pose = line->record.sonar; isUsable(pose)) {
            const log::Metadata origin{{"insonify_origin", file->origin()}};
            for (const std::string& vehicle : vehicles) log.write(vehicle, pose, origin);
            log.write(sonar + ".pose", pose, origin);
        }
        if (const double altitude = line->record.altitude; altitude > 0) {
            types::Range range;
            range.time = line->ping.time;
            range.range = altitude;
            log.write("altimeter.range", range);
        }
        log::Metadata more{{"insonify_frequency_khz", fmt::format("{}", line->frequency_khz)}};
        if (codes.whole) more["insonify_code_bits"] = std::to_string(codes.bits());
        log.write(imported.stream, line->ping, more);
    }
    log.close();
    imported.properties = log.properties();
    imported.changes = log.changes();
    imported.notices = file->notices();
    return imported;
}

Imported importOculus(const fs::path& recording, std::optional<DeploymentSpec> spec, const fs::path& to) {
    using Import = void(const fs::path&, std::optional<DeploymentSpec>, const fs::path&, Imported&);
    Imported imported;
    loader::load("device").entry<Import>("insonify_import_oculus")(recording, std::move(spec), to, imported);
    return imported;
}

}  // namespace

Imported importRecording(const fs::path& recording, std::optional<DeploymentSpec> spec, const fs::path& to) {
    if (!fs::exists(recording))
        throw types::ConfigError(recording.string(), "",
                                 "does not exist; may be a .xtf, .jsf, .aris, .glf or .oculus file");
    if (fs::is_directory(recording))
        throw types::ConfigError(recording.string(), "", "is a folder; give a recording in it");
    if (std::error_code none; fs::equivalent(recording, to, none))
        throw types::ConfigError(to.string(), "--to", "is the recording itself; the log must be another file");
    const auto import = recordings::openSideScan(recording) ? importSideScan
                        : recordings::openFan(recording)    ? importFan
                                                            : importOculus;
    return import(recording, std::move(spec), to);
}

}  // namespace insonify::deployer
