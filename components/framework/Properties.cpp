#include "components/framework/Properties.hpp"

#include <yaml-cpp/yaml.h>

#include "components/framework/Activity.hpp"
#include "components/framework/ConfigReader.hpp"
#include "types/Ascii.hpp"

namespace insonify::framework {
namespace {

/** "max_size" -> "setMax_size" */
std::string setterName(std::string property) {
    property.front() = types::raised(property.front());
    return "set" + property;
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

void PropertiesBase::setAll(const std::map<std::string, std::string>& values) {
    ConfigReader reader("");
    reader.takeOutByNull();
    YAML::Node block(YAML::NodeType::Map);
    std::string names;
    for (const auto& [name, yaml] : values) {
        YAML::Node value;
        reader.readText(yaml, name, value);
        block.force_insert(name, value);
        names += (names.empty() ? "" : ", ") + name;
    }
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
}

}  // namespace insonify::framework
