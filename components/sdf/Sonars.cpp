#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <sdf/Element.hh>
#include <sdf/Joint.hh>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/Sensor.hh>
#include <sdf/World.hh>
#include <sstream>
#include <string>
#include <vector>

#include "components/meshes/WorldBuilder.hpp"
#include "components/sdf/Sdf.hpp"
#include "components/sdf/SdfFile.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::sdf {
namespace {

using scene::SonarSensor;

constexpr size_t max_settings = 1000;  ///< Of one sensor.
constexpr int max_depth = 16;

/** Returns "insonify" for "gz:insonify"; a name without a prefix unchanged. */
std::string withoutPrefix(const std::string& name) { return name.substr(name.rfind(':') + 1); }

/** Returns the value of the attribute `gz:type` or `ignition:type`; empty: none. */
std::string customType(const ::sdf::Element& sensor) {
    for (const ::sdf::ParamPtr& attribute : sensor.GetAttributes())
        if (const std::string& key = attribute->GetKey(); key.ends_with(":type")) return attribute->GetAsString();
    return "";
}

/** Returns the numbers of a text that has nothing else; none otherwise. */
std::vector<std::string> numbersIn(const std::string& text) {
    std::vector<std::string> numbers;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        double number = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || end != word.data() + word.size()) return {};
        numbers.push_back(word);
    }
    return numbers;
}

/** Returns a text of SDF as a value in YAML: numbers with spaces between them are a list, texts that are not plain are
 *  quoted. Lists and blocks in YAML's short form stay. */
std::string inYaml(const std::string& value) {
    if (const auto numbers = numbersIn(value); numbers.size() > 1) return fmt::format("[{}]", fmt::join(numbers, ", "));
    const bool is_plain = !value.empty() && value.find_first_of(":#'\"\n\\&*!|>%@`,[]{}") == value.npos;
    const bool is_short = value.starts_with('[') || value.starts_with('{');
    if (is_plain || is_short) return value;
    std::string quoted = "'";
    for (const char letter : value) quoted += letter == '\'' ? "''" : std::string(1, letter);
    return quoted + "'";
}

class SonarFinder {
public:
    explicit SonarFinder(const std::filesystem::path& file) : file_(std::filesystem::absolute(file)) {}

    scene::WorldSonars read() {
        CerrCapture console;
        meshes::WorldBuilder builder(file_);
        const ::sdf::Root root = readSdfFile(file_, builder, console);
        const ::sdf::World* const world = root.WorldByIndex(0);
        if (!world) throw types::ConfigError(file_.string(), "", "has no <world>; the sonars of a world are searched");
        found_.world = world->Name();
        for (uint64_t i = 0; i < world->ModelCount(); ++i) {
            const ::sdf::Model& model = *world->ModelByIndex(i);
            if (!model.Static()) addMoving(model);
            addModel(model, "");
        }
        if (!diagnostics_.empty()) throw types::ConfigError(std::move(diagnostics_));
        if (found_.sonars.empty())
            std::ranges::move(types::lines(builder.notices()), std::back_inserter(found_.notices));
        return std::move(found_);
    }

private:
    /** Calls `use` for a model and those within it, with their scope in the outermost. */
    static void forEach(const ::sdf::Model& model, const std::string& scope,
                        const std::function<void(const ::sdf::Model&, const std::string&)>& use) {
        use(model, scope);
        for (uint64_t i = 0; i < model.ModelCount(); ++i) {
            const ::sdf::Model& nested = *model.ModelByIndex(i);
            forEach(nested, scope + nested.Name() + "::", use);
        }
    }

    /** Adds a model and its moving links. Gazebo's pose of a model is that of its canonical link: links that no fixed
     *  joint attaches to that one have their own. */
    void addMoving(const ::sdf::Model& model) {
        found_.moving.push_back(model.Name());
        std::map<std::string, std::string> held;  // links by one that holds them, directly or by others
        const auto findHolder = [&](std::string link) {
            for (auto at = held.find(link); at != held.end(); at = held.find(link)) link = at->second;
            return link;
        };
        forEach(model, "", [&](const ::sdf::Model& each, const std::string& scope) {
            for (uint64_t i = 0; i < each.JointCount(); ++i) {
                const ::sdf::Joint& joint = *each.JointByIndex(i);
                std::string child, parent;
                if (joint.Type() != ::sdf::JointType::FIXED || !joint.ResolveChildLink(child).empty() ||
                    !joint.ResolveParentLink(parent).empty())
                    continue;
                child = findHolder(scope + child), parent = findHolder(scope + parent);
                if (child != parent) held[child] = parent;
            }
        });
        const std::string body = findHolder(model.CanonicalLinkAndRelativeName().second);
        forEach(model, "", [&](const ::sdf::Model& each, const std::string& scope) {
            for (uint64_t i = 0; i < each.LinkCount(); ++i)
                if (const ::sdf::Link& link = *each.LinkByIndex(i);
                    link.VisualCount() > 0 && findHolder(scope + link.Name()) != body)
                    found_.moving.push_back(model.Name() + "::" + scope + link.Name());
        });
    }

    void addModel(const ::sdf::Model& model, const std::string& scope) {
        const std::string inner = scope + model.Name() + "::";
        for (uint64_t i = 0; i < model.LinkCount(); ++i) {
            const ::sdf::Link& link = *model.LinkByIndex(i);
            for (uint64_t k = 0; k < link.SensorCount(); ++k) addSensor(*link.SensorByIndex(k), inner + link.Name());
        }
        for (uint64_t i = 0; i < model.ModelCount(); ++i) addModel(*model.ModelByIndex(i), inner);
    }

    void addSensor(const ::sdf::Sensor& sensor, const std::string& link) {
        const std::string name = link + "::" + sensor.Name();
        if (sensor.Type() != ::sdf::SensorType::CUSTOM || customType(*sensor.Element()) != "insonify") {
            const std::string custom = sensor.Type() == ::sdf::SensorType::CUSTOM ? customType(*sensor.Element()) : "";
            found_.others.push_back(fmt::format("{} ({})", name, custom.empty() ? sensor.TypeStr() : custom));
            return;
        }
        SonarSensor sonar;
        sonar.name = name;
        sonar.link = link;
        sonar.file = file_.string();
        sonar.line = sensor.Element()->LineNumber().value_or(0);
        sonar.topic = sensor.Topic();
        sonar.update_rate = sensor.UpdateRate();
        if (!(sonar.update_rate >= 0 && sonar.update_rate <= 1000))
            fail(*sensor.Element(), name + ".update_rate",
                 fmt::format("is {} Hz; may be 0, for each pose of the world, to 1000", sonar.update_rate));
        readMount(sensor, sonar);
        for (::sdf::ElementPtr child = sensor.Element()->GetFirstElement(); child; child = child->GetNextElement())
            if (child->GetName().find(':') != std::string::npos && withoutPrefix(child->GetName()) == "insonify")
                addSettings(*child, "", name, 0, sonar);
        found_.sonars.push_back(std::move(sonar));
    }

    void readMount(const ::sdf::Sensor& sensor, SonarSensor& sonar) {
        ignition::math::Pose3d pose;
        if (const ::sdf::Errors errors = sensor.SemanticPose().Resolve(pose); !errors.empty()) {
            fail(*sensor.Element(), sonar.name + ".pose", "cannot be resolved: " + errors.front().Message());
            return;
        }
        const auto degrees = [](double radians) { return types::degrees(radians); };
        sonar.mount.position = {pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z()};
        sonar.mount.roll_deg = degrees(pose.Rot().Roll());
        sonar.mount.pitch_deg = degrees(pose.Rot().Pitch());
        sonar.mount.yaw_deg = degrees(pose.Rot().Yaw());
    }

    /** Adds the elements below `block` as settings; `path` is that of the block, with a dot behind it. */
    void addSettings(::sdf::Element& block, const std::string& path, const std::string& sensor, int depth,
                     SonarSensor& sonar) {
        if (depth > max_depth)
            return fail(block, sensor, fmt::format("has blocks within blocks deeper than {}", max_depth));
        for (::sdf::ElementPtr child = block.GetFirstElement(); child; child = child->GetNextElement()) {
            const std::string key = withoutPrefix(child->GetName());
            const std::string whole = path + key;
            if (child->GetFirstElement()) {
                addSettings(*child, whole + ".", sensor, depth + 1, sonar);
                continue;
            }
            const std::string value = child->GetValue() ? child->GetValue()->GetAsString() : "";
            if (whole == "type") {
                sonar.type = value;
                continue;
            }
            if (sonar.settings.size() >= max_settings)
                return fail(*child, sensor, fmt::format("has more than {} settings", max_settings));
            const auto known = std::ranges::find(sonar.settings, whole, &SonarSensor::Setting::path);
            const int line = child->LineNumber().value_or(sonar.line);
            if (known == sonar.settings.end())
                sonar.settings.push_back({whole, inYaml(value), line});
            else if (known->value.starts_with('['))
                known->value.insert(known->value.size() - 1, ", " + inYaml(value));
            else
                known->value = "[" + known->value + ", " + inYaml(value) + "]";
        }
    }

    void fail(const ::sdf::Element& element, const std::string& path, const std::string& message) {
        diagnostics_.push_back({path, message, file_.string(), element.LineNumber().value_or(0)});
    }

    const std::filesystem::path file_;
    scene::WorldSonars found_;
    types::Diagnostics diagnostics_;
};

}  // namespace

scene::WorldSonars readSonars(const std::filesystem::path& file) { return SonarFinder(file).read(); }

}  // namespace insonify::sdf
