#include "components/deployer/log/StreamMeaning.hpp"

#include "components/deployer/log/ReplaySpec.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
#include "components/log/Reader.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::deployer {
namespace {

using framework::child;
using framework::DeploymentSpec;
using framework::TaskSpec;

constexpr const char* quaternion_order = "w, x, y, z";

/** Returns the nearest task whose type starts with `type` upstream of a task, or the task itself; null when there is
 * none. */
const TaskSpec* upstream(const DeploymentSpec& spec, const std::string& from, const std::string& type) {
    std::vector<std::string> waiting{from};
    for (size_t i = 0; i < waiting.size(); ++i) {
        const TaskSpec* task = spec.task(waiting[i]);
        if (task && task->type.starts_with(type)) return task;
        for (const framework::ConnectionSpec& connection : spec.connections) {
            const std::string writer = framework::splitPort(connection.from).first;
            if (framework::splitPort(connection.to).first == waiting[i] && std::ranges::count(waiting, writer) == 0)
                waiting.push_back(writer);
        }
    }
    return nullptr;
}

/** Returns a property as written, by its path. */
Json property(const TaskSpec* task, std::initializer_list<const char*> path) {
    if (!task) return nullptr;
    YAML::Node node = task->properties;
    for (const char* key : path) node.reset(child(node, key));
    return toJson(node);
}

Json orElse(const Json& value, const char* otherwise) { return value.is_null() ? Json(otherwise) : value; }

std::string binsOf(const std::string& model, const std::string& output, bool amplified) {
    const std::string gain = amplified ? ", times the receiver's gain" : "";
    const std::string intensity =
        model == "physical" ? "received intensity of the bin relative to that of the source at 1 m, linear" + gain
                            : "mean of S(n.d) over what the bin shows, 0 to 1" + gain;
    if (output == "intensity") return intensity;
    if (output == "amplitude") return "root of: " + intensity;
    if (output == "level_db") return "10 log10 of: " + intensity;
    if (output == "received_level_db") return "dB re 1 uPa: source level plus 10 log10 of: " + intensity;
    return "whole numbers by `code`, of: " + intensity;
}

/** Returns the sonar's frequency, else that of its absorption [kHz]; null where neither is given. */
Json frequencyOf(const TaskSpec* sonar) {
    const Json frequency = property(sonar, {"frequency_khz"});
    return frequency.is_null() ? property(sonar, {"absorption", "frequency_khz"}) : frequency;
}

Json pingMeaning(const DeploymentSpec& spec, const std::string& task) {
    const TaskSpec* sonar = upstream(spec, task, "sonar::");
    const TaskSpec* receiver = upstream(spec, task, "receiver::ReceiverTask");
    const TaskSpec* noise = upstream(spec, task, "noise::NoiseTask");
    const TaskSpec* scene = upstream(spec, task, "scene::SceneTask");
    const std::string model = orElse(property(sonar, {"model"}), "physical"),
                      output = orElse(property(receiver, {"output"}), "intensity");
    return {{"bins", binsOf(model, output, receiver != nullptr)},
            {"output", output},
            {"model", model},
            {"reference", model == "physical" ? Json("intensity of the source at 1 m") : Json(nullptr)},
            {"tvg", property(receiver, {"tvg"})},
            {"gain_db", property(receiver, {"gain_db"})},
            {"code", property(receiver, {"code"})},
            {"noise", noise ? toJson(noise->properties) : Json(nullptr)},
            {"frequency_khz", frequencyOf(sonar)},
            {"absorption", property(sonar, {"absorption"})},
            {"range_m", "slant range of the middle of each bin, [pings, bins]"},
            {"bin_duration",
             "one-way travel time through one bin [s], as Rock defines it: bin k covers slant ranges "
             "[k, k + 1) * bin_duration * speed_of_sound. In logs it is in whole microseconds; where bins are not, the "
             "samples' speed_of_sound makes up for it, and insonify_speed_of_sound in the stream's metadata is the "
             "water's"},
            {"frame", "sonar: x ahead, y to port, z up; bearings from ahead, positive to port [rad]"},
            {"mount", property(scene, {"mount"})},
            {"quaternion_order", quaternion_order}};
}

/** Adds what the recording states from which a stream was imported, see RecordedLog. */
void addRecorded(const log::Stream& stream, Json& meaning) {
    const auto number = [&](const char* key) { return console::readJson(stream.metadatum(key)); };
    if (const Json frequency = number("insonify_frequency_khz"); frequency.is_number() && frequency > 0)
        meaning["frequency_khz"] = frequency;
    if (const Json bits = number("insonify_code_bits"); bits.is_number() && meaning["code"].is_object())
        meaning["code"]["bits"] = bits;
    const std::string recording = stream.metadatum("insonify_recording");
    if (recording.empty()) return;
    meaning["bins"] = "samples of " + recording + ", as its device output them";
    meaning["model"] = meaning["reference"] = nullptr;
    if (meaning["output"] != "code") meaning["output"] = "samples";
}

Json poseMeaning() {
    return {{"position", "in the world, x north, y west, z up [m]"},
            {"orientation", "world_from_body, unit quaternion; body: x forward, y left, z up"},
            {"quaternion_order", quaternion_order}};
}

/** Returns the meaning of a sample's fields, from the type's description. */
template <class T>
Json fieldsOf() {
    Json fields = Json::object();
    const auto report = [&](const types::Field& field, const auto&) {
        const std::string unit = field.unit;
        fields[field.name] = std::string(field.doc) + (unit.empty() || unit == "1" ? "" : " [" + unit + "]");
    };
    const T sample;
    T::describe(sample, report);
    return fields;
}

Json cloudMeaning(const std::optional<types::Datum>& datum) {
    Json meaning = {{"points", "in the world, x north, y west, z up [m]"},
                    {"intensity", "value of the strongest bin of each return, in the units of the sonar's bins"}};
    if (datum) meaning["datum"] = Json::parse(framework::flowYaml(*datum));
    return meaning;
}

}  // namespace

DeploymentSpec deploymentOf(const log::Reader& log) try {
    return DeploymentSpec::parse(log.metadatum("insonify_deployment"), log.path().string());
} catch (const types::ConfigError&) {
    return {};
}

std::optional<types::Datum> recordedDatum(const log::Reader& log) {
    const DeploymentSpec spec = deploymentOf(log);
    if (spec.datum) return spec.datum;
    for (const framework::TaskSpec& task : spec.tasks) {
        types::Datum own;
        const YAML::Node written = framework::child(task.properties, "datum");
        if (written.IsDefined() && framework::ConfigReader("").read(written, "", own)) return own;
    }
    return {};
}

Json meaningOf(const log::Reader& log, const log::Stream& stream) {
    Json meaning = {{"stream", stream.name}};
    if (log::holdsPings(stream)) {
        const DeploymentSpec spec = deploymentOf(log);
        meaning.update(pingMeaning(spec, writerOf(spec, stream.name)));
        addRecorded(stream, meaning);
    } else if (stream.holds<types::Pose>())
        meaning.update(poseMeaning());
    else if (stream.holds<types::SonarTruth>())
        meaning.update(fieldsOf<types::SonarTruth>());
    else if (stream.holds<types::SonarReturns>())
        meaning.update(fieldsOf<types::SonarReturns>());
    else if (stream.holds<types::SonarDetections>())
        meaning.update(fieldsOf<types::SonarDetections>());
    else if (stream.holds<types::SonarElements>())
        meaning.update(fieldsOf<types::SonarElements>());
    else if (stream.holds<types::PointCloud>())
        meaning.update(cloudMeaning(recordedDatum(log)));
    else
        meaning["type"] = stream.type;
    if (const std::string names = stream.metadatum("insonify_objects"); !names.empty())
        meaning["objects"] = console::readJson(names);
    if (const std::string seed = stream.metadatum("insonify_seed"); !seed.empty()) meaning["seed"] = seed;
    return meaning;
}

const log::Stream& pingsOf(const log::Reader& log, const std::string& stream, const char* wanted) {
    const log::Stream& pings = log.streams()[log.indexOf(stream)];
    if (!holdsPings(pings)) throw types::ConfigError(log.path(), pings.name, "holds " + pings.type + "; " + wanted);
    if (pings.count == 0) throw types::ConfigError(log.path(), pings.name, "holds no ping");
    return pings;
}

double frequencyOf(const Json& meaning) {
    const Json& frequency = meaning["frequency_khz"];
    return frequency.is_number() ? frequency.get<double>() : 0;
}

}  // namespace insonify::deployer
