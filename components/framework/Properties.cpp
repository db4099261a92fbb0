#include "components/framework/Properties.hpp"

#include <cctype>

namespace insonify::framework {
namespace {

/** "bin_count" -> "setBin_count" */
std::string setterName(std::string property) {
    property.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(property.front())));
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

void PropertiesBase::set(const std::string& name, const std::string& yaml) {
    ConfigReader reader("");
    reader.takeOutByNull();
    YAML::Node value;
    reader.readText(yaml, name, value);
    YAML::Node block(YAML::NodeType::Map);
    block.force_insert(name, value);
    const auto putBack = keep();
    if (reader.diagnostics().empty()) load(reader, block, "");
    if (!reader.diagnostics().empty()) {
        putBack();
        throw types::ConfigError(reader.diagnostics());
    }
    if (const Outcome outcome = owner_.applyProperties(name); !outcome) {
        putBack();
        throw std::runtime_error(outcome.reason);
    }
    owner_.refreshRecord();
}

}  // namespace insonify::framework
