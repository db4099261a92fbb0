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
#include "components/console/Json.hpp"
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

/** Returns a text as a value in YAML. */
std::string quoted(const std::string& text) { return console::Json(text).dump(); }

/** Returns the topic that Gazebo gives a sensor without one. As there, blanks of names become _, and what a topic may
 *  not have is left out. */
std::string usualTopic(const std::string& world, const std::string& sensor) {
    const size_t last = sensor.rfind("::"), link = sensor.rfind("::", last - 1);
    std::string named = fmt::format("/world/{}/model/{}/link/{}/sensor/{}/insonify", world, sensor.substr(0, link),
                                    sensor.substr(link + 2, last - link - 2), sensor.substr(last + 2));
    for (size_t at = 0; (at = named.find("::")) != named.npos;) named.replace(at, 2, "/model/");
    std::string topic;
    for (const char letter : named)
        if (letter != '@' && letter != '~' && letter != ':') topic += letter == ' ' ? '_' : letter;
    return topic;
}

/** Returns a name for ROS 2: letters, digits and single _ between slashes, no part with a digit first. */
std::string rosTopic(const std::string& topic) {
    std::string name = "/";
    for (const char given : topic) {
        const bool is_kept = std::isalnum(static_cast<unsigned char>(given)) != 0 || given == '/';
        const char letter = is_kept ? given : '_';
        if ((letter == '/' || letter == '_') && letter == name.back()) continue;
        if (name.back() == '/' && std::isdigit(static_cast<unsigned char>(letter)) != 0) name += '_';
        name += letter;
    }
    return name;
}

/** Returns a name for tasks and ports: letters, digits and _. */
std::string getWord(std::string name) {
    std::ranges::replace(name, '/', '_');
    const std::string word = rosTopic(name).substr(1);
    return word.empty() ? "sonar" : word;
}

std::string withoutBlanks(std::string text) {
    std::ranges::replace(text, ' ', '_');
    return text;
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
        moving_ports_.clear();
        for (const std::string& entity : sonars_.moving)
            moving_ports_.push_back(unique((entity.find("::") == entity.npos ? "model_" : "link_") + getWord(entity)));
        for (const SonarSensor& sonar : sonars_.sonars) addSonar(sonar);
        std::string text = fmt::format(
            "# The sonars of world {0}. Made by `insonify gazebo {1} --print`.\nschedule: realtime\ntasks:\n"
            "  world:\n    type: gazebo::PoseTask\n    properties:\n      world: {2}\n{3}      bodies:\n",
            quoted(sonars_.world), quoted(asked_.world), quoted(sonars_.world), partition("      "));
        const auto addBody = [&](const std::string& port, const std::string& entity, double rate) {
            text += fmt::format("        - {{port: {}, entity: {}, period: {}}}\n", port, quoted(entity),
                                rate > 0 ? 1 / rate : 0.0);
        };
        const double rate = sonars_.sonars.front().update_rate;
        const bool is_common =
            std::ranges::all_of(sonars_.sonars, [&](auto& each) { return each.update_rate == rate; });
        // What moves comes before the sonars, whose poses cause pings.
        for (size_t i = 0; i < moving_ports_.size(); ++i)
            addBody(moving_ports_[i], sonars_.moving[i], is_common ? rate : 0);
        for (const SonarSensor& sonar : sonars_.sonars) addBody(names_.at(&sonar), sonar.link, sonar.update_rate);
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
        connections_ += fmt::format("  - {{from: {}, to: {}}}\n", from, quoted(to));
    }

    /** Returns a word for a task and its port, with a number behind it if another task has it, or one of its own. */
    std::string unique(const std::string& word) {
        const auto isTaken = [&](const std::string& name) {
            return std::ranges::any_of(own_tasks, [&](const char* own) { return taken_.contains(name + own); });
        };
        std::string name = word;
        for (int again = 2; isTaken(name); ++again) name = fmt::format("{}_{}", word, again);
        for (const char* own : own_tasks) taken_.insert(name + own);
        return name;
    }

    void send(const std::string& from, const std::string& topic, const char* type, const char* ros_type,
              const std::string& frame) {
        const std::string port = fmt::format("out{}", ++ports_);
        topics_ += fmt::format("        - {{port: {}, topic: {}, type: {}, frame_id: {}}}\n", port, quoted(topic), type,
                               quoted(frame));
        connect(from, "to_gazebo." + port);
        if (!asked_.ros) return;
        ros_topics_ += fmt::format("        - {{port: {}, topic: {}, type: {}, frame_id: {}}}\n", port,
                                   quoted(rosTopic(topic)), ros_type, quoted(withoutBlanks(frame)));
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
        const std::string name = unique(getWord(sonar.name));
        names_[&sonar] = name;
        const types::Mount& mount = sonar.mount;
        const bool is_rare = sonar.update_rate > 0 && sonar.update_rate < 2;  // for the usual timeout of a second
        addTask(
            name + "_scene", "scene::SceneTask",
            fmt::format(
                "{}      gazebo: {{world: {}, timeout: {}{}}}\n      mount: {{position: [{}, {}, {}], roll_deg: {}, "
                "pitch_deg: {}, yaw_deg: {}}}\n",
                is_rare ? fmt::format("      pose_timeout: {}\n", 2 / sonar.update_rate) : "", quoted(sonars_.world),
                asked_.gazebo.timeout,
                asked_.gazebo.partition.empty() ? "" : ", partition: " + quoted(asked_.gazebo.partition),
                mount.position.x, mount.position.y, mount.position.z, mount.roll_deg, mount.pitch_deg, mount.yaw_deg));
        for (size_t i = 0; i < moving_ports_.size(); ++i)
            connect("world." + moving_ports_[i], fmt::format("{}_scene.{}.pose", name, sonars_.moving[i]));
        connect("world." + name, name + "_scene.pose");
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

    /** What follows the name of a sonar in those of its tasks. */
    static constexpr const char* own_tasks[] = {"", "_scene", "_noise", "_receiver", "_image"};

    const scene::WorldSonars& sonars_;
    const Asked& asked_;
    std::map<const SonarSensor*, std::string> names_;
    std::map<std::string, std::string> properties_;  ///< By task.
    std::vector<std::string> moving_ports_;          ///< By moving entity.
    std::set<std::string> taken_;
    std::string tasks_, topics_, ros_topics_, connections_;
    int ports_ = 0;
};

/** Returns "task.property" of a setting: those of `noise` and `receiver` are of these tasks. */
std::string findProperty(const std::string& task, const std::string& path) {
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

/** A folder that is removed when it is no longer needed. */
struct TemporaryFolder {
    TemporaryFolder() {
        if (!mkdtemp(path.data())) throw types::ConfigError(path, "", "cannot be made, for the world's SDF");
    }
    ~TemporaryFolder() {
        std::error_code gone;
        fs::remove_all(path, gone);
    }
    std::string path = fs::temp_directory_path() / "insonify_world_XXXXXX";
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
    const std::string text = scene::requestSdf(config);
    const TemporaryFolder folder;
    const fs::path file = fs::path(folder.path) / "world.sdf";
    std::ofstream(file) << text;
    return scene::readWorldSonars(file);
}

[[noreturn]] void refuseNone(const Asked& asked, const scene::WorldSonars& found) {
    std::string others;
    for (size_t i = 0; i < std::min<size_t>(found.others.size(), 8); ++i)
        others += (i == 0 ? "; its sensors are " : ", ") + found.others[i];
    // A world that libsdformat refuses is read without its sensors, and the notice says why.
    const auto why = std::ranges::find_if(
        found.notices, [](const std::string& text) { return text.starts_with("read without what a sonar"); });
    if (why != found.notices.end()) others += "; it is " + *why;
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
            const std::string property = findProperty(writer.names().at(&sonar), setting.path);
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
