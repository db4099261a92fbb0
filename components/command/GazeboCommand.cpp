// insonify gazebo WORLD: the sonars that the SDF of a world describes, in the world that Gazebo runs.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include "components/command/CommandLine.hpp"
#include "components/command/RunCommand.hpp"
#include "components/console/Console.hpp"
#include "components/framework/config/YamlText.hpp"
#include "components/scene/GazeboWorld.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::command {
namespace {

namespace fs = std::filesystem;
using scene::SonarSensor;

struct Asked : RunOptions {
    scene::GazeboConfig gazebo;
    std::string world;
    bool print = false, ros = false;
};

/** Returns a name for tasks and ports: letters, digits and _. */
std::string wordOf(const std::string& name) {
    std::string word;
    for (const char letter : name) {
        const bool is_kept = std::isalnum(static_cast<unsigned char>(letter)) != 0;
        if (is_kept || (!word.empty() && word.back() != '_')) word += is_kept ? letter : '_';
    }
    return word.empty() ? "sonar" : word;
}

std::string quoted(const std::string& text) {
    std::string all = "'";
    for (const char letter : text) all += letter == '\'' ? "''" : std::string(1, letter);
    return all + "'";
}

std::vector<std::string> partsOf(const std::string& scope) {
    std::vector<std::string> parts;
    for (size_t begin = 0; begin <= scope.size();) {
        const size_t end = std::min(scope.find("::", begin), scope.size());
        parts.push_back(scope.substr(begin, end - begin));
        begin = end + 2;
    }
    return parts;
}

/** Returns the topic that Gazebo gives a sensor without one. */
std::string usualTopic(const std::string& world, const std::string& sensor) {
    const std::vector<std::string> parts = partsOf(sensor);
    std::string topic = "/world/" + world;
    for (size_t i = 0; i + 2 < parts.size(); ++i) topic += "/model/" + parts[i];
    return topic + "/link/" + parts[parts.size() - 2] + "/sensor/" + parts.back() + "/insonify";
}

/** The picture of each kind of sonar. */
std::string pictureFor(const std::string& type) {
    if (type == "sonar::SonarTask") return "output::FanImageTask";
    if (type == "sonar::ScanningSonarTask") return "output::DiscImageTask";
    if (type == "sonar::SideScanTask") return "output::SideScanImageTask";
    return "";
}

/** Writes the deployment of a world's sonars. */
class DeploymentWriter {
public:
    DeploymentWriter(const scene::WorldSonars& sonars, const Asked& asked) : sonars_(sonars), asked_(asked) {}

    /** Sets what is written as the properties of a task, in YAML. */
    void setProperties(const std::string& task, const std::string& yaml) { properties_[task] = yaml; }

    std::string write() {
        names_.clear();
        taken_ = {"world", "to_gazebo", "to_ros"};
        tasks_ = topics_ = ros_topics_ = connections_ = "";
        ports_ = 0;
        for (const SonarSensor& sonar : sonars_.sonars) addSonar(sonar);
        std::string text = fmt::format(
            "# The sonars of world {0}. Made by `insonify gazebo {1} --print`.\nschedule: realtime\ntasks:\n"
            "  world:\n    type: gazebo::PoseTask\n    properties:\n      world: {2}\n{3}      bodies:\n",
            sonars_.world, asked_.world, quoted(sonars_.world), partition("      "));
        for (const SonarSensor& sonar : sonars_.sonars)
            text += fmt::format("        - {{port: {}, entity: {}, period: {}}}\n", names_.at(&sonar),
                                quoted(sonar.link), sonar.update_rate > 0 ? 1 / sonar.update_rate : 0.0);
        for (const std::string& model : sonars_.models)
            text += fmt::format("        - {{port: model_{}, entity: {}}}\n", wordOf(model), quoted(model));
        text += tasks_;
        text += fmt::format(
            "  to_gazebo:\n    type: gazebo::PublisherTask\n    properties:\n      world: {}\n{}      topics:\n{}",
            quoted(sonars_.world), partition("      "), topics_);
        if (asked_.ros)
            text += "  to_ros:\n    type: dds::PublisherTask\n    properties:\n      topics:\n" + ros_topics_;
        return text + "connections:\n" + connections_;
    }

    /** The task of each sonar. */
    const std::map<const SonarSensor*, std::string>& names() const { return names_; }

private:
    std::string partition(const char* indent) const {
        return asked_.gazebo.partition.empty()
                   ? ""
                   : fmt::format("{}partition: {}\n", indent, quoted(asked_.gazebo.partition));
    }

    void connect(const std::string& from, const std::string& to) {
        connections_ += fmt::format("  - {{from: {}, to: {}}}\n", from, to);
    }

    void send(const std::string& from, const std::string& topic, const char* type, const char* ros_type,
              const std::string& frame) {
        const std::string port = fmt::format("out{}", ++ports_);
        topics_ += fmt::format("        - {{port: {}, topic: {}, type: {}, frame_id: {}}}\n", port, quoted(topic), type,
                               quoted(frame));
        connect(from, "to_gazebo." + port);
        if (!asked_.ros) return;
        ros_topics_ += fmt::format("        - {{port: {}, topic: {}, type: {}, frame_id: {}}}\n", port, quoted(topic),
                                   ros_type, quoted(frame));
        connect(from, "to_ros." + port);
    }

    static bool has(const SonarSensor& sonar, const std::string& block) {
        return std::ranges::any_of(sonar.settings,
                                   [&](const auto& each) { return each.path.starts_with(block + "."); });
    }

    void addTask(const std::string& name, const std::string& type, const std::string& properties = "") {
        tasks_ += fmt::format("  {}:\n    type: {}\n", name, type);
        const auto set = properties_.find(name);
        const std::string& text = set == properties_.end() ? properties : set->second;
        if (!text.empty()) tasks_ += "    properties:\n" + text;
    }

    void addSonar(const SonarSensor& sonar) {
        std::string name = wordOf(sonar.name);
        for (int again = 2; !taken_.insert(name).second; ++again)
            name = fmt::format("{}_{}", wordOf(sonar.name), again);
        names_[&sonar] = name;
        const types::Mount& mount = sonar.mount;
        addTask(
            name + "_scene", "scene::SceneTask",
            fmt::format(
                "      gazebo: {{world: {}, timeout: {}{}}}\n      mount: {{position: [{}, {}, {}], roll_deg: {}, "
                "pitch_deg: {}, yaw_deg: {}}}\n",
                quoted(sonars_.world), asked_.gazebo.timeout,
                asked_.gazebo.partition.empty() ? "" : ", partition: " + quoted(asked_.gazebo.partition),
                mount.position.x, mount.position.y, mount.position.z, mount.roll_deg, mount.pitch_deg, mount.yaw_deg));
        connect("world." + name, name + "_scene.pose");
        for (const std::string& model : sonars_.models)
            connect("world.model_" + wordOf(model), fmt::format("{}_scene.{}.pose", name, model));
        addTask(name, sonar.type);
        connect(name + "_scene.snapshot", name + ".snapshot");
        std::string pings = name + ".ping";
        if (has(sonar, "noise")) {
            addTask(name + "_noise", "noise::NoiseTask");
            connect(pings, name + "_noise.clean");
            pings = name + "_noise.noisy";
        }
        addTask(name + "_receiver", "receiver::ReceiverTask",
                has(sonar, "receiver") ? "" : "      tvg: {log_coefficient: 50, db_per_m: 0.2, max_db: 110}\n");
        connect(pings, name + "_receiver.intensity");
        pings = name + "_receiver.ping";
        addTopics(sonar, name, pings);
    }

    void addTopics(const SonarSensor& sonar, const std::string& name, const std::string& pings) {
        const std::string topic = sonar.topic.empty() ? usualTopic(sonars_.world, sonar.name) : sonar.topic;
        send(pings, topic, "Float_V", "marine_acoustic_msgs/ProjectedSonarImage", sonar.name);
        if (sonar.type == "sonar::SonarTask" || sonar.type == "sonar::ProfilerTask") {
            send(pings, topic + "/scan", "LaserScan", "sensor_msgs/LaserScan", sonar.name);
            send(pings, topic + "/points", "PointCloudPacked", "sensor_msgs/PointCloud2", sonar.name);
        }
        if (sonar.type == "sonar::Sonar3dTask")
            send(name + ".range_image", topic + "/points", "PointCloudPacked", "sensor_msgs/PointCloud2", sonar.name);
        if (const std::string picture = pictureFor(sonar.type); !picture.empty()) {
            addTask(name + "_image", picture);
            connect(pings, name + "_image.ping");
            send(name + "_image.image", topic + "/image", "Image", "sensor_msgs/Image", sonar.name);
        }
    }

    const scene::WorldSonars& sonars_;
    const Asked& asked_;
    std::map<const SonarSensor*, std::string> names_;
    std::map<std::string, std::string> properties_;  ///< By task.
    std::set<std::string> taken_;
    std::string tasks_, topics_, ros_topics_, connections_;
    int ports_ = 0;
};

/** Returns "task.property" of a setting: those of `noise` and `receiver` are of these tasks. */
std::string propertyOf(const std::string& task, const std::string& path) {
    for (const char* block : {"noise", "receiver"})
        if (path.starts_with(std::string(block) + "."))
            return fmt::format("{}_{}{}", task, block, path.substr(std::string(block).size()));
    return task + "." + path;
}

std::string indented(const std::string& text, const std::string& by) {
    std::string lines = by;
    for (const char letter : text) lines += letter == '\n' ? "\n" + by : std::string(1, letter);
    return lines + "\n";
}

/** A file that is removed when it is no longer needed. */
struct TemporaryFile {
    explicit TemporaryFile(const std::string& text)
        : path(fs::temp_directory_path() / fmt::format("insonify-world-{}.sdf", getpid())) {
        std::ofstream(path) << text;
    }
    ~TemporaryFile() {
        std::error_code gone;
        fs::remove(path, gone);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    const fs::path path;
};

bool isFile(const std::string& world) {
    std::error_code unreadable;
    const std::string ending = fs::path(world).extension();
    return fs::exists(world, unreadable) || ending == ".sdf" || ending == ".world" || world.find('/') != world.npos;
}

scene::WorldSonars sonarsIn(const Asked& asked) {
    if (isFile(asked.world)) return scene::readWorldSonars(asked.world);
    scene::GazeboConfig config = asked.gazebo;
    config.world = asked.world;
    const TemporaryFile file(scene::requestSdf(config));
    return scene::readWorldSonars(file.path);
}

[[noreturn]] void refuseNone(const Asked& asked, const scene::WorldSonars& found) {
    std::string others;
    for (size_t i = 0; i < std::min<size_t>(found.others.size(), 8); ++i)
        others += (i == 0 ? "; its sensors are " : ", ") + found.others[i];
    throw types::ConfigError(asked.world, "",
                             "has no sonar, <sensor type=\"custom\" gz:type=\"insonify\"> (Fortress: ignition:type)" +
                                 (others.empty() ? ", and no other sensor" : others));
}

int runWorld(const Asked& asked) {
    const scene::WorldSonars found = sonarsIn(asked);
    if (found.sonars.empty()) refuseNone(asked, found);
    DeploymentWriter writer(found, asked);
    const std::string text = writer.write();
    const bool is_file = isFile(asked.world);
    framework::DeploymentSpec spec =
        framework::DeploymentSpec::parse(text, is_file ? asked.world + ".yml" : found.world + ".yml");
    for (const SonarSensor& sonar : found.sonars)
        for (const SonarSensor::Setting& setting : sonar.settings) {
            const std::string property = propertyOf(writer.names().at(&sonar), setting.path);
            YAML::Mark place;
            place.line = setting.line - 1;
            spec.set(
                property, framework::parseValue(setting.value),
                {is_file ? asked.world : asked.world + " (SDF of Gazebo)", sonar.name + "." + setting.path, place});
        }
    for (const std::string& assignment : asked.set) spec.set(assignment);
    applyRosArguments(asked.RunOptions::ros, spec);
    if (asked.print) {
        for (const framework::TaskSpec& task : spec.tasks)
            if (task.properties.IsDefined() && task.type.find("gazebo::") != 0 && task.type.find("dds::") != 0)
                writer.setProperties(task.name, indented(YAML::Dump(task.properties), "      "));
        console::printResult("{}", writer.write());
        return 0;
    }
    if (!asked.quiet)
        for (const SonarSensor& sonar : found.sonars)
            console::printDiagnostic("notice: {}: {}, {}\n", sonar.name, sonar.type,
                                     sonar.topic.empty() ? usualTopic(found.world, sonar.name) : sonar.topic);
    return runDeployment(std::move(spec), asked);
}

}  // namespace

void addGazeboCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<Asked>();
    options->gazebo.timeout = 30;
    CLI::App* command = app.add_subcommand(
        "gazebo", "Renders the sonars that a world's SDF describes, in the world that Gazebo runs, on Gazebo's topics");
    command->add_option("WORLD", options->world, "the SDF file of the world, or the name of a world that runs")
        ->required();
    command->add_flag("--print", options->print, "prints the deployment, to go on from there, and runs nothing");
    command->add_flag("--ros", options->ros, "also sends ROS 2 messages, on topics of the same names");
    command->add_option("--partition", options->gazebo.partition, "of Gazebo's transport (default: GZ_PARTITION)");
    command->add_option("--timeout", options->gazebo.timeout, "how long to wait for Gazebo (default: 30)")
        ->type_name("S")
        ->check(console::refuseUnlessPositive);
    options->addTo(*command);
    command->callback([options, &action] { action = [options] { return runWorld(*options); }; });
}

}  // namespace insonify::command
