#include "components/deployer/FittedDeployment.hpp"

#include <map>
#include <sstream>

#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/framework/config/YamlText.hpp"
#include "components/noise/NoiseTask.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/scene/SceneTask.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "components/sonar/tasks/SideScanTask.hpp"

namespace insonify::deployer {
namespace {

namespace fs = std::filesystem;

/** Returns the task of a type upstream of another; throws types::ConfigError where there is none. */
template <class Task>
const Task& upstreamTask(const framework::Deployment& deployment, const std::string& of, const char* type) {
    for (const std::string& name : upstream({of}, deployment))
        if (const auto* task = dynamic_cast<const Task*>(deployment.task(name))) return *task;
    throw types::ConfigError(deployment.spec().file, "tasks." + of,
                             std::string("has no ") + type + " before it, which a fit needs");
}

/** Writes YAML line by line: blocks down to the properties of tasks, then values in one line with their comments. */
class CommentedYaml {
public:
    CommentedYaml(std::map<std::string, std::string> comments, fs::path from, fs::path to)
        : comments_(std::move(comments)), from_(std::move(from)), to_(std::move(to)) {}

    std::string text(const YAML::Node& document) {
        out_.str("");
        for (const auto& entry : document) writeEntry(entry.first.Scalar(), entry.second, "", 0);
        return out_.str();
    }

private:
    static constexpr int deepest_block = 6;  ///< tasks, the task, properties, and three blocks in a property.

    void writeEntry(const std::string& key, YAML::Node value, const std::string& path, int depth) {
        const std::string here = path.empty() ? key : path + "." + key, indent(static_cast<size_t>(2 * depth), ' ');
        if (const auto comment = comments_.find(here); comment != comments_.end() && !comment->second.empty())
            out_ << indent << "# " << comment->second << "\n";
        out_ << indent << key << ":";
        const bool is_block = value.IsMap() && value.size() > 0 && depth < deepest_block && hasComments(here, depth);
        const bool is_list = value.IsSequence() && value.size() > 0 && value[0].IsMap() && depth < 2;
        if (is_block) {
            out_ << "\n";
            for (const auto& entry : value) writeEntry(entry.first.Scalar(), entry.second, here, depth + 1);
        } else if (is_list) {
            out_ << "\n";
            for (const YAML::Node& item : value) out_ << indent << "  - " << flow(item) << "\n";
        } else {
            out_ << " " << flow(value) << "\n";
        }
    }
    /** Whether to write a block: tasks and their properties, and everything with comments below it. */
    bool hasComments(const std::string& here, int depth) const {
        if (depth < 3) return true;
        const auto below = comments_.lower_bound(here + ".");
        return below != comments_.end() && below->first.starts_with(here + ".");
    }
    std::string flow(const YAML::Node& value) const {
        YAML::Emitter emitter;
        emitter.SetSeqFormat(YAML::Flow);
        emitter.SetMapFormat(YAML::Flow);
        emitter << located(value);
        std::string text = emitter.c_str(), line;
        for (const char c : text)  // the emitter breaks long lines
            if (c == '\n')
                line += ' ';
            else if (c != ' ' || line.empty() || line.back() != ' ')
                line += c;
        return text.find('"') == std::string::npos ? line : text;
    }
    /** Returns the value with the names of existing files relative to the new folder. */
    YAML::Node located(const YAML::Node& value) const {
        if (value.IsMap()) {
            YAML::Node copy(YAML::NodeType::Map);
            for (const auto& entry : value) copy[entry.first.Scalar()] = located(entry.second);
            return copy;
        }
        if (value.IsSequence()) {
            YAML::Node copy(YAML::NodeType::Sequence);
            for (const YAML::Node& item : value) copy.push_back(located(item));
            return copy;
        }
        std::error_code error;
        if (!value.IsScalar() || value.Scalar().find('.') == std::string::npos ||
            fs::path(value.Scalar()).is_absolute() || !fs::is_regular_file(from_ / value.Scalar(), error))
            return value;
        return YAML::Node(fs::proximate(from_ / value.Scalar(), to_).string());
    }

    std::map<std::string, std::string> comments_;
    fs::path from_, to_;
    std::ostringstream out_;
};

/** Sets a value in a block, making the blocks above it. */
void put(YAML::Node block, const std::string& path, const YAML::Node& value) {
    const auto [name, below] = framework::splitPort(path);
    if (!below.empty()) {
        if (!block[name].IsDefined() || !block[name].IsMap()) block[name] = YAML::Node(YAML::NodeType::Map);
        put(block[name], below, value);
    } else if (value.IsNull()) {
        block.remove(name);
    } else {
        block[name] = value;
    }
}

}  // namespace

ChainAt chainAt(const std::string& file, uint64_t ping, const std::vector<std::string>& settings) {
    const std::string located = deploymentIn(file);
    ChainAt chain;
    {
        framework::Registry registry = coreTasks();
        const framework::Deployment deployment(specWith(located, settings), registry);
        const receiver::ReceiverTask& receiver = findCodingReceiver(deployment, located);
        chain.receiver_task = receiver.name();
        chain.receiver = *receiver.config;
        const auto& noise = upstreamTask<noise::NoiseTask>(deployment, chain.receiver_task, "noise::NoiseTask");
        chain.noise_task = noise.name();
        chain.noise = *noise.config;
        const auto& sonar =
            upstreamTask<sonar::PingTask>(deployment, chain.noise_task, "sonar::SonarTask or sonar::SideScanTask");
        chain.looks_abeam = dynamic_cast<const sonar::SideScanTask*>(&sonar) != nullptr;
        if (!chain.looks_abeam && !dynamic_cast<const sonar::SonarTask*>(&sonar))
            throw types::ConfigError(located, "tasks." + sonar.name(),
                                     "is neither a sonar::SonarTask nor a sonar::SideScanTask, which a fit needs");
        chain.sonar_task = sonar.name();
        const auto& scene = upstreamTask<scene::SceneTask>(deployment, chain.sonar_task, "scene::SceneTask");
        chain.scene_task = scene.name();
        chain.mount = scene.config->mount;
        const auto& vehicle = upstreamTask<pose::TrajectoryTask>(deployment, chain.scene_task, "pose::TrajectoryTask");
        chain.vehicle_task = vehicle.name();
        chain.period = deployment.spec().task(chain.vehicle_task)->activity.period;
    }
    SonarAt at = sonarAt(located, ping, settings);
    chain.sonar = std::move(at.config);
    chain.snapshot = std::move(at.snapshot);
    return chain;
}

std::string deploymentWith(const std::string& file, const std::vector<CommentedSetting>& settings,
                           const fs::path& folder, const std::vector<std::string>& head) {
    const std::string located = deploymentIn(file);
    const framework::DeploymentSpec spec = framework::DeploymentSpec::load(located);
    YAML::Node document = YAML::Clone(framework::parseYaml(spec.text, located).front());
    std::map<std::string, std::string> comments;
    for (const CommentedSetting& setting : settings) {
        const auto [task, property] = framework::splitPort(setting.path);
        put(document["tasks"][task], "properties." + property, framework::parseValue(setting.value));
        comments["tasks." + task + ".properties." + property] = setting.comment;
    }
    std::string text;
    for (const std::string& line : head) text += "# " + line + "\n";
    return text +
           CommentedYaml(std::move(comments), fs::absolute(located).parent_path(), fs::absolute(folder)).text(document);
}

}  // namespace insonify::deployer
