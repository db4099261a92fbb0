#pragma once
#include <string>
#include <vector>

#include "components/framework/ConfigReader.hpp"
#include "components/framework/PropertyList.hpp"
#include "components/framework/PropertyValues.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** The properties of a task, without their type. */
class PropertiesBase {
public:
    explicit PropertiesBase(TaskContext* owner) { owner->enlist(this); }
    virtual ~PropertiesBase() = default;
    PropertiesBase(const PropertiesBase&) = delete;
    PropertiesBase& operator=(const PropertiesBase&) = delete;

    /** Takes the values of a YAML block over the defaults; faults go to the reader. An undefined node is an empty
     * block. */
    virtual void load(ConfigReader& reader, const YAML::Node& block, const std::string& path) = 0;
    /** Every property with its default; nested names are dotted. */
    virtual std::vector<PropertyInfo> list() const = 0;
    /** The properties that are present, as a log holds them. */
    virtual std::map<std::string, types::PropertyValue> values() const = 0;
};

/** Properties as one described struct; each top-level field is a property. They change only between runs. */
template <types::Described Config>
class Properties final : public PropertiesBase {
public:
    using PropertiesBase::PropertiesBase;
    const Config& operator*() const { return value_; }
    const Config* operator->() const { return &value_; }
    /** From code: bounds are the caller's affair. Takes effect at the next configure. */
    void set(Config value) { value_ = std::move(value); }

    void load(ConfigReader& reader, const YAML::Node& block, const std::string& path) override {
        reader.read(block, path, value_);
    }
    std::vector<PropertyInfo> list() const override { return listProperties(Config{}); }
    std::map<std::string, types::PropertyValue> values() const override { return propertyValues(value_); }

private:
    Config value_;
};

}  // namespace insonify::framework
