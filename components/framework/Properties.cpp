#include "components/framework/Properties.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/execution/Activity.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::framework {
namespace {

/** "max_size" -> "setMax_size" */
std::string setterName(std::string property) {
    property.front() = types::raised(property.front());
    return "set" + property;
}

/** Inserts a value into a block, below the blocks of a dotted name. Returns false where one of these is a value. */
bool insert(YAML::Node block, const std::string& name, const YAML::Node& value) {
    if (block.IsDefined() && !block.IsNull() && !block.IsMap()) return false;
    const size_t dot = name.find('.');
    const std::string key = name.substr(0, dot);
    const YAML::Node known = child(block, key);
    if (dot == std::string::npos) {
        if (known.IsDefined()) block.remove(key);
        block.force_insert(key, value);
        return true;
    }
    if (known.IsDefined()) return insert(known, name.substr(dot + 1), value);
    const YAML::Node inner(YAML::NodeType::Map);
    block.force_insert(key, inner);
    return insert(inner, name.substr(dot + 1), value);
}

class Setter final : public OperationBase {
public:
    Setter(TaskContext& owner, PropertiesBase& properties, const PropertyInfo& property)
        : OperationBase(&owner, setterName(property.name), "sets " + property.name),
          properties_(properties),
          property_(property.name),
          type_(property.type) {}

    std::string signature() const override { return "void(" + type_ + ")"; }
    std::string callText(const std::vector<std::string>& arguments) override {
        requireCount(arguments, 1);
        owner().activity().call([&] { properties_.set(property_, arguments.front()); });
        return "";
    }

private:
    PropertiesBase& properties_;
    std::string property_, type_;
};

}  // namespace

void PropertiesBase::addSetters() {
    for (const PropertyInfo& property : list())
        if (property.name.find_first_of(".[") == std::string::npos)
            setters_.push_back(std::make_unique<Setter>(owner_, *this, property));
}

std::function<void()> PropertiesBase::setAll(const std::map<std::string, std::string>& values) {
    ConfigReader reader("");
    YAML::Node block(YAML::NodeType::Map);
    std::string names;
    for (const auto& [name, yaml] : values) {
        YAML::Node value;
        reader.readText(yaml, name, value);
        if (!insert(block, name, value)) reader.report(value, name, "is given as a block and as a value");
        names += (names.empty() ? "" : ", ") + name;
    }
    return apply(reader, block, names);
}

void PropertiesBase::change(const std::map<std::string, std::optional<double>>& values) {
    std::map<std::string, std::string> texts;
    for (const auto& [name, value] : values) texts[name] = value ? fmt::format("{}", *value) : "null";
    setAll(texts);
}

std::function<void()> PropertiesBase::apply(ConfigReader& reader, const YAML::Node& block, const std::string& names) {
    reader.removeByNull();
    const auto putBack = keep();
    if (reader.diagnostics().empty()) load(reader, block, "");
    if (!reader.diagnostics().empty()) {
        putBack();
        throw types::ConfigError(reader.diagnostics());
    }
    if (const Outcome outcome = owner_.applyProperties(names); !outcome) {
        putBack();
        throw std::runtime_error(outcome.reason);
    }
    owner_.refreshRecord();
    return [this, putBack, names] {
        putBack();
        owner_.applyProperties(names);
        owner_.refreshRecord();
    };
}

PropertiesBase& blockWith(const std::string& property, const std::vector<PropertiesBase*>& blocks) {
    const std::string name = property.substr(0, property.find('.'));
    const auto has = [&](const PropertiesBase* block) {
        return std::ranges::any_of(block->list(), [&](const PropertyInfo& each) { return each.name == name; });
    };
    const auto found = std::ranges::find_if(blocks, has);
    return found == blocks.end() ? *blocks.front() : **found;
}

}  // namespace insonify::framework
