#pragma once
// Types of properties and arguments, independent of C++ types: read from YAML, listed, written. Each type is compiled
// once behind one interface, and functions that know only that interface do all the work.
#include <concepts>
#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "types/samples/TaskRecord.hpp"
#include "types/text/Describe.hpp"

namespace YAML {
class Node;
class Emitter;
}  // namespace YAML

namespace insonify::framework {

using types::PropertyInfo;
class ConfigReader;

/** One C++ type. A `value` points to an object of this type. */
class ValueType {
public:
    /** Reads a node and reports diagnostics to the reader; false when there was any. */
    virtual bool read(ConfigReader& reader, const YAML::Node& node, const std::string& path, const types::Field& field,
                      void* value) const = 0;
    /** "double", "list of text", "block, optional". */
    virtual std::string name() const = 0;
    /** As `describe` shows it; empty for blocks and absent values. */
    virtual std::string text(const void* value) const = 0;
    virtual void emit(YAML::Emitter& out, const void* value) const = 0;
    /** The form in a log: numbers, booleans and texts unchanged, all else in flow YAML. */
    virtual types::PropertyValue logged(const void* value) const = 0;
    virtual void assign(void* to, const void* from) const = 0;
    /** Whether nothing is to be written: an absent optional. */
    virtual bool isAbsent(const void* /*value*/) const { return false; }
    /** Adds the fields of a block, or of the block in an optional, list or map, with the name `prefix`. */
    virtual void list(const std::string& /*prefix*/, const void* /*value*/, std::vector<PropertyInfo>& /*list*/) const {
    }
    /** Returns an object with its defaults. */
    virtual const void* fresh() const = 0;

protected:
    ~ValueType() = default;
};

/** The ValueType of T: a number, boolean, text, vector of three, enum with EnumNames, block, or an optional, a
 *  std::vector or a map by name of these. */
template <class T>
const ValueType& getType();

class OptionalType : public ValueType {
public:
    virtual const ValueType& inner() const = 0;
    virtual const void* get(const void* value) const = 0;  ///< Null when it is absent.
    virtual void* getOrMake(void* value) const = 0;
    bool read(ConfigReader&, const YAML::Node&, const std::string&, const types::Field&, void*) const override;
    std::string name() const override { return inner().name() + ", optional"; }
    std::string text(const void* value) const override { return get(value) ? inner().text(get(value)) : ""; }
    void emit(YAML::Emitter& out, const void* value) const override { inner().emit(out, get(value)); }
    types::PropertyValue logged(const void* value) const override { return inner().logged(get(value)); }
    bool isAbsent(const void* value) const override { return !get(value) || inner().isAbsent(get(value)); }
    void list(const std::string& prefix, const void* value, std::vector<PropertyInfo>& list) const override {
        inner().list(prefix, get(value) ? get(value) : inner().fresh(), list);
    }

protected:
    ~OptionalType() = default;
};

class ListType : public ValueType {
public:
    virtual const ValueType& inner() const = 0;
    virtual size_t size(const void* value) const = 0;
    virtual const void* at(const void* value, size_t i) const = 0;
    virtual void renew(void* value, size_t size) const = 0;  ///< Makes `size` elements with their defaults.
    bool read(ConfigReader&, const YAML::Node&, const std::string&, const types::Field&, void*) const override;
    std::string name() const override { return "list of " + inner().name(); }
    std::string text(const void* value) const override;
    void emit(YAML::Emitter& out, const void* value) const override;
    types::PropertyValue logged(const void* value) const override;
    void list(const std::string& prefix, const void*, std::vector<PropertyInfo>& list) const override {
        inner().list(prefix + "[]", inner().fresh(), list);
    }

protected:
    ~ListType() = default;
};

class MapType : public ValueType {
public:
    virtual const ValueType& inner() const = 0;
    virtual void clear(void* value) const = 0;
    virtual void erase(void* value, const std::string& key) const = 0;
    virtual void* getOrMake(void* value, const std::string& key) const = 0;
    virtual void visit(const void* value, const std::function<void(const std::string&, const void*)>& each) const = 0;
    bool read(ConfigReader&, const YAML::Node&, const std::string&, const types::Field&, void*) const override;
    std::string name() const override { return "map of " + inner().name(); }
    std::string text(const void*) const override { return ""; }
    void emit(YAML::Emitter& out, const void* value) const override;
    types::PropertyValue logged(const void* value) const override;
    void list(const std::string& prefix, const void*, std::vector<PropertyInfo>& list) const override {
        inner().list(prefix + ".<name>", inner().fresh(), list);
    }

protected:
    ~MapType() = default;
};

/** A struct that describes itself. */
class BlockType : public ValueType {
public:
    using Visit = std::function<void(const types::Field&, const ValueType&, void* member)>;
    /** Visits all fields, in order. Members of a const value must not be changed. */
    virtual void visit(void* value, const Visit& each) const = 0;
    virtual void check(const void* value, types::Diagnostics& diagnostics) const = 0;
    bool read(ConfigReader&, const YAML::Node&, const std::string&, const types::Field&, void*) const override;
    std::string name() const override { return "block"; }
    std::string text(const void*) const override { return ""; }
    void emit(YAML::Emitter& out, const void* value) const override;
    types::PropertyValue logged(const void* value) const override;
    void list(const std::string& prefix, const void* value, std::vector<PropertyInfo>& list) const override;

protected:
    ~BlockType() = default;
};

/** An enum whose values are 0, 1, 2... */
class EnumType : public ValueType {
public:
    constexpr EnumType(const std::string_view* names, size_t count) : names_(names), count_(count) {}
    virtual size_t get(const void* value) const = 0;
    virtual void set(void* value, size_t number) const = 0;
    bool read(ConfigReader&, const YAML::Node&, const std::string&, const types::Field&, void*) const override;
    std::string name() const override;
    std::string text(const void* value) const override { return std::string(names_[get(value)]); }
    void emit(YAML::Emitter& out, const void* value) const override;
    types::PropertyValue logged(const void* value) const override { return text(value); }

protected:
    ~EnumType() = default;

private:
    const std::string_view* names_;
    size_t count_;
};

/** Reads a described struct; fields that the block does not name keep their values. An undefined node is an empty
 *  block. False when there was any diagnostic. */
bool readBlock(ConfigReader& reader, const YAML::Node& node, const std::string& path, const BlockType& type,
               void* value);

/** Every field with its default; nested names are dotted. */
std::vector<PropertyInfo> listFields(const BlockType& type, const void* defaults);

/** Returns the fields that are present, by name, in the form of a log. */
std::map<std::string, types::PropertyValue> fieldValues(const BlockType& type, const void* value);

/** Returns a value in flow YAML on one line, which ConfigReader reads back to the same value. */
std::string flowYaml(const ValueType& type, const void* value);

// -- templates --------------------------------------------------------------------------------------------------------

template <class T>
concept Number = std::integral<T> || std::floating_point<T>;

/** Types without inner types; each is defined in ValueType.cpp. */
template <class T>
concept Plain = Number<T> || std::same_as<T, std::string> || std::same_as<T, glm::dvec3> || std::same_as<T, YAML::Node>;
template <Plain T>
const ValueType& plainType();

template <class T, class Base>
class TypeOf : public Base {
public:
    using Base::Base;
    void assign(void* to, const void* from) const override { *static_cast<T*>(to) = *static_cast<const T*>(from); }
    const void* fresh() const override {
        static const T fresh{};
        return &fresh;
    }

protected:
    ~TypeOf() = default;
    static T& of(void* value) { return *static_cast<T*>(value); }
    static const T& of(const void* value) { return *static_cast<const T*>(value); }
};

template <class T>
class TypeOfEnum final : public TypeOf<T, EnumType> {
public:
    constexpr TypeOfEnum()
        : TypeOf<T, EnumType>(std::data(types::EnumNames<T>::names), std::size(types::EnumNames<T>::names)) {}
    size_t get(const void* value) const override { return static_cast<size_t>(this->of(value)); }
    void set(void* value, size_t number) const override { this->of(value) = static_cast<T>(number); }
};

template <types::Described T>
class TypeOfBlock final : public TypeOf<T, BlockType> {
public:
    void visit(void* value, const BlockType::Visit& each) const override {
        Visitor visitor{each};
        T::describe(this->of(value), visitor);
    }
    void check(const void* value, types::Diagnostics& diagnostics) const override {
        if constexpr (types::Checked<T>) this->of(value).check(diagnostics);
    }

private:
    struct Visitor {
        const BlockType::Visit& each;
        template <class Member>
        void operator()(const types::Field& field, Member& member) {
            each(field, getType<Member>(), &member);
        }
    };
};

template <class T>
class TypeOfOptional final : public TypeOf<std::optional<T>, OptionalType> {
public:
    const ValueType& inner() const override { return getType<T>(); }
    const void* get(const void* value) const override { return this->of(value) ? &*this->of(value) : nullptr; }
    void* getOrMake(void* value) const override {
        return this->of(value) ? &*this->of(value) : &this->of(value).emplace();
    }
};

template <class T>
class TypeOfList final : public TypeOf<std::vector<T>, ListType> {
public:
    const ValueType& inner() const override { return getType<T>(); }
    size_t size(const void* value) const override { return this->of(value).size(); }
    const void* at(const void* value, size_t i) const override { return &this->of(value)[i]; }
    void renew(void* value, size_t size) const override { this->of(value).assign(size, T{}); }
};

template <class T>
class TypeOfMap final : public TypeOf<std::map<std::string, T>, MapType> {
public:
    const ValueType& inner() const override { return getType<T>(); }
    void clear(void* value) const override { this->of(value).clear(); }
    void erase(void* value, const std::string& key) const override { this->of(value).erase(key); }
    void* getOrMake(void* value, const std::string& key) const override { return &this->of(value)[key]; }
    void visit(const void* value, const std::function<void(const std::string&, const void*)>& each) const override {
        for (const auto& [key, element] : this->of(value)) each(key, &element);
    }
};

template <class T>
struct TypeFor {
    static_assert(types::Described<T>,
                  "a property is a number, boolean, text, vector, enum with EnumNames, block, or an "
                  "optional, list or map by name of these");
    static constexpr TypeOfBlock<T> type{};
};
template <types::NamedEnum T>
struct TypeFor<T> {
    static constexpr TypeOfEnum<T> type{};
};
template <class T>
struct TypeFor<std::optional<T>> {
    static constexpr TypeOfOptional<T> type{};
};
template <class T>
struct TypeFor<std::vector<T>> {
    static constexpr TypeOfList<T> type{};
};
template <class T>
struct TypeFor<std::map<std::string, T>> {
    static constexpr TypeOfMap<T> type{};
};

template <class T>
const ValueType& getType() {
    if constexpr (Plain<T>)
        return plainType<T>();
    else
        return TypeFor<T>::type;
}

template <types::Described T>
const BlockType& getBlock() {
    return TypeFor<T>::type;
}

template <class T>
std::string flowYaml(const T& value) {
    return flowYaml(getType<T>(), &value);
}

template <types::Described Config>
std::vector<PropertyInfo> listProperties(const Config& defaults) {
    return listFields(getBlock<Config>(), &defaults);
}

}  // namespace insonify::framework
