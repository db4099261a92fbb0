#include <algorithm>

#include "components/pocolog/Export.hpp"
#include "components/pocolog/NpzFile.hpp"
#include "components/pocolog/SampleTypes.hpp"

namespace insonify::pocolog {
namespace {

using Path = std::filesystem::path;
using types::Pose;
using types::Sonar;

/** Successive pings of one shape. */
struct Run {
    size_t beams = 0, bins = 0;
    std::vector<SampleRef> pings;
};

std::vector<Run> runsOfOneShape(Reader& log, const std::string& stream) {
    std::vector<Run> runs;
    log.forEach<Sonar>(stream, [&](const Sonar& ping, const SampleRef& at) {
        checkShape(log, stream, ping);
        if (runs.empty() || runs.back().beams != ping.beam_count || runs.back().bins != ping.bin_count)
            runs.push_back({ping.beam_count, ping.bin_count, {}});
        runs.back().pings.push_back(at);
    });
    if (runs.empty()) runs.emplace_back();
    return runs;
}

void writeRun(Reader& log, const Run& run, const Path& path) {
    const size_t count = run.pings.size();
    std::vector<double> bearings, time, bin_duration, speed_of_sound;
    NpzFile npz(path);
    npz.begin("bins", numpyType<float>(), {count, run.beams, run.bins});
    Sonar ping;
    for (const SampleRef& at : run.pings) {
        log.read(at, ping);
        npz.append(ping.bins.data(), ping.bins.size() * sizeof(float));
        for (const types::Angle& bearing : ping.bearings) bearings.push_back(bearing.rad);
        time.push_back(ping.time.seconds());
        bin_duration.push_back(ping.bin_duration.seconds());
        speed_of_sound.push_back(static_cast<double>(ping.speed_of_sound));
    }
    npz.end();
    npz.array("bearings", {count, run.beams}, bearings);
    npz.array("time", {count}, time);
    npz.array("bin_duration", {count}, bin_duration);
    npz.array("speed_of_sound", {count}, speed_of_sound);
    npz.close();
}

std::vector<Path> writePings(Reader& log, const std::string& stream, const Path& path) {
    const std::vector<Run> runs = runsOfOneShape(log, stream);
    std::vector<Path> files;
    for (const Run& run : runs) {
        Path file = path;
        if (runs.size() > 1) file.replace_extension("." + std::to_string(files.size()) + path.extension().string());
        writeRun(log, run, file);
        files.push_back(file);
    }
    return files;
}

void writePoses(Reader& log, const std::string& stream, const Path& path) {
    std::vector<double> time, position, orientation;
    log.forEach<Pose>(stream, [&](const Pose& pose, const SampleRef& at) {
        const auto& [p, q] = std::tie(pose.position, pose.orientation);
        time.push_back(sampleTime(pose, at.time).seconds());
        position.insert(position.end(), {p.x, p.y, p.z});
        orientation.insert(orientation.end(), {q.w, q.x, q.y, q.z});
    });
    NpzFile npz(path);
    npz.array("time", {time.size()}, time);
    npz.array("position", {time.size(), 3}, position);
    npz.array("orientation", {time.size(), 4}, orientation);
    npz.close();
}

template <Numeric T>
void writeNumbers(Reader& log, const std::string& stream, const Path& path) {
    using Stored = std::conditional_t<std::is_same_v<T, bool>, uint8_t, T>;
    std::vector<double> time;
    std::vector<Stored> value;
    log.forEach<T>(stream, [&](const T& number, const SampleRef& at) {
        time.push_back(at.time.seconds());
        value.push_back(number);
    });
    NpzFile npz(path);
    npz.array("time", {time.size()}, time);
    npz.array("value", {time.size()}, value);
    npz.close();
}

}  // namespace

std::vector<Path> exportNpz(Reader& log, const std::string& stream, const Path& path) {
    const Stream& declared = log.streams()[log.indexOf(stream)];
    if (declared.holds<Sonar>()) return writePings(log, stream, path);
    bool done = declared.holds<Pose>();
    if (done) writePoses(log, stream, path);
    forEachSampleType([&]<class T>(std::type_identity<T>) {
        if constexpr (Numeric<T>)
            if (declared.holds<T>()) {
                writeNumbers<T>(log, stream, path);
                done = true;
            }
    });
    if (!done) failExport(log, stream);
    return {path};
}

void checkShape(const Reader& log, const std::string& stream, const Sonar& ping) {
    if (ping.bins.size() != size_t{ping.beam_count} * ping.bin_count || ping.bearings.size() != ping.beam_count)
        throw types::ConfigError(log.path(), stream, "a ping has other numbers of bins or bearings than it says");
}

void failExport(const Reader& log, const std::string& stream) {
    throw types::ConfigError(log.path(), stream,
                             "holds " + log.find(stream)->type +
                                 "; what can be exported are pings (/base/samples/Sonar), poses "
                                 "(/base/samples/RigidBodyState) and numbers");
}

}  // namespace insonify::pocolog
