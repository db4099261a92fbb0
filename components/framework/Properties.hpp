#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/framework/Operation.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/framework/ValueType.hpp"

namespace insonify::framework {

/** The properties of a task, without their type. */
class PropertiesBase {
public:
    explicit PropertiesBase(TaskContext* owner) : owner_(*owner) { owner->enlist(this); }
    virtual ~PropertiesBase() = default;
    PropertiesBase(const PropertiesBase&) = delete;
    PropertiesBase& operator=(const PropertiesBase&) = delete;

    /** Takes the values of a YAML block over the defaults; diagnostics go to the reader. An undefined node is an empty
     *  block. */
    virtual void load(ConfigReader& reader, const YAML::Node& block, const std::string& path) = 0;
    /** Every property with its default; nested names are dotted. */
    virtual std::vector<PropertyInfo> list() const = 0;
    /** The properties that are present, as a log holds them. */
    virtual std::map<std::string, types::PropertyValue> values() const = 0;
    /** Sets one property, of a block only what `yaml` names, in any state of the task; null takes it out, or gives it
     *  its default. For the task's thread. Throws
     *  types::ConfigError when the value does not fit, std::runtime_error when the task does not take it over: then
     *  the old value stays. */
    void set(const std::string& name, const std::string& yaml) { setAll({{name, yaml}}); }
    /** Several at once: all, or none. */
    void setAll(const std::map<std::string, std::string>& values);

protected:
    void addSetters();
    /** Puts the values of now back when called. */
    virtual std::function<void()> keep() = 0;

private:
    TaskContext& owner_;
    std::vector<std::unique_ptr<OperationBase>> setters_;
};

/** Properties as one described struct; each top-level field is a property, with an operation `set<Name>` (setRange,
 *  setMax_size: as oroGen forms it). */
template <types::Described Config>
class Properties final : public PropertiesBase {
public:
    explicit Properties(TaskContext* owner) : PropertiesBase(owner) { addSetters(); }
    const Config& operator*() const { return value_; }
    const Config* operator->() const { return &value_; }
    using PropertiesBase::set;
    /** From code: bounds are the caller's affair. Takes effect at the next configure. */
    void set(Config value) { value_ = std::move(value); }

    void load(ConfigReader& reader, const YAML::Node& block, const std::string& path) override {
        readBlock(reader, block, path, blockOf<Config>(), &value_);
    }
    std::vector<PropertyInfo> list() const override { return listFields(blockOf<Config>(), blockOf<Config>().fresh()); }
    std::map<std::string, types::PropertyValue> values() const override {
        return fieldValues(blockOf<Config>(), &value_);
    }

private:
    std::function<void()> keep() override {
        return [this, kept = value_] { value_ = kept; };
    }

    Config value_;
};

}  // namespace insonify::framework
