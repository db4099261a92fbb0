#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Operation.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/framework/config/ValueType.hpp"

namespace insonify::framework {

/** The untyped part of a task's properties. */
class PropertiesBase {
public:
    explicit PropertiesBase(TaskContext* owner) : owner_(*owner) { owner->enlist(this); }
    virtual ~PropertiesBase() = default;
    PropertiesBase(const PropertiesBase&) = delete;
    PropertiesBase& operator=(const PropertiesBase&) = delete;

    /** Reads a YAML block over the defaults and reports diagnostics to the reader. An undefined node is an empty
     *  block. */
    virtual void load(ConfigReader& reader, const YAML::Node& block, const std::string& path) = 0;
    /** Every property with its default; nested names are dotted. */
    virtual std::vector<PropertyInfo> list() const = 0;
    /** The properties that are present, in the form of a log. */
    virtual std::map<std::string, types::PropertyValue> values() const = 0;
    const TaskContext& owner() const { return owner_; }
    /** Sets one property in any state of the task; in a block, only the fields that `yaml` names. Null removes a
     *  property or resets it to its default. For the task's thread. Throws types::ConfigError when the value does not
     *  fit. Throws std::runtime_error when the task refuses the value. After a throw the old value stays. */
    void set(const std::string& name, const std::string& yaml) { setAll({{name, yaml}}); }
    /** Sets several properties: all, or none. Dotted names reach into blocks. Returns a function that sets them back.
     */
    std::function<void()> setAll(const std::map<std::string, std::string>& values);
    /** Sets several properties to numbers, as setAll() does; none: removes a property or resets it to its default. */
    void change(const std::map<std::string, std::optional<double>>& values);

protected:
    void addSetters();
    /** Returns a function that restores the current values. */
    virtual std::function<void()> keep() = 0;

private:
    /** Loads a block over the values and applies it; `names` for a refusal. */
    std::function<void()> apply(ConfigReader& reader, const YAML::Node& block, const std::string& names);

    TaskContext& owner_;
    std::vector<std::unique_ptr<OperationBase>> setters_;
};

/** Returns the block of properties, among at least one, that has a property, by its dotted name; the first where none
 *  has, whose error names it. */
PropertiesBase& blockWith(const std::string& property, const std::vector<PropertiesBase*>& blocks);

/** Properties in one described struct. Each top-level field is a property with an operation `set<Name>`, named as
 *  oroGen names it (setRange, setMax_size). */
template <types::Described Config>
class Properties final : public PropertiesBase {
public:
    explicit Properties(TaskContext* owner) : PropertiesBase(owner) { addSetters(); }
    const Config& operator*() const { return value_; }
    const Config* operator->() const { return &value_; }
    using PropertiesBase::set;
    /** Sets the values from code, without checking bounds. Takes effect at the next configure. */
    void set(Config value) { value_ = std::move(value); }

    void load(ConfigReader& reader, const YAML::Node& block, const std::string& path) override {
        readBlock(reader, block, path, getBlock<Config>(), &value_);
    }
    std::vector<PropertyInfo> list() const override {
        return listFields(getBlock<Config>(), getBlock<Config>().fresh());
    }
    std::map<std::string, types::PropertyValue> values() const override {
        return fieldValues(getBlock<Config>(), &value_);
    }

private:
    std::function<void()> keep() override {
        return [this, kept = value_] { value_ = kept; };
    }

    Config value_;
};

}  // namespace insonify::framework
