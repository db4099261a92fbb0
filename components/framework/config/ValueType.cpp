#include "components/framework/config/ValueType.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/framework/config/ConfigReader.hpp"

namespace insonify::framework {
namespace {

template <Number T>
class NumberType final : public TypeOf<T, ValueType> {
public:
    bool read(ConfigReader& reader, const YAML::Node& node, const std::string& path, const types::Field& field,
              void* value) const override {
        if constexpr (std::integral<T>) {
            bool negative = false;
            uint64_t magnitude = 0;
            if (!reader.whole(node, path, field, static_cast<int64_t>(std::numeric_limits<T>::min()),
                              static_cast<uint64_t>(std::numeric_limits<T>::max()), negative, magnitude))
                return false;
            this->of(value) = static_cast<T>(negative ? ~magnitude + 1 : magnitude);
        } else {
            double wide = 0;
            if (!reader.number(node, path, field, wide)) return false;
            if (std::abs(wide) > static_cast<double>(std::numeric_limits<T>::max()))
                return reader.report(node, path, "is " + node.Scalar() + "; is too large"), false;
            this->of(value) = static_cast<T>(wide);
        }
        return true;
    }
    std::string name() const override {
        return std::floating_point<T> ? "double" : std::is_signed_v<T> ? "integer" : "integer >= 0";
    }
    /** Returns nothing for a number that must be given, which is NaN until then. */
    std::string text(const void* value) const override {
        const T number = this->of(value);
        return number != number ? "" : fmt::format("{}", number);
    }
    /** A number cannot be `null`: "nan" would not be JSON. */
    void emit(YAML::Emitter& out, const void* value) const override {
        if (std::isfinite(static_cast<double>(this->of(value))))
            out << text(value);
        else
            out << YAML::Null;
    }
    types::PropertyValue logged(const void* value) const override {
        if constexpr (std::floating_point<T>)
            return static_cast<double>(this->of(value));
        else
            return static_cast<int64_t>(this->of(value));
    }
};

class BoolType final : public TypeOf<bool, ValueType> {
public:
    bool read(ConfigReader& reader, const YAML::Node& node, const std::string& path, const types::Field&,
              void* value) const override {
        return reader.boolean(node, path, of(value));
    }
    std::string name() const override { return "bool"; }
    std::string text(const void* value) const override { return of(value) ? "true" : "false"; }
    void emit(YAML::Emitter& out, const void* value) const override { out << of(value); }
    types::PropertyValue logged(const void* value) const override { return of(value); }
};

class TextType final : public TypeOf<std::string, ValueType> {
public:
    bool read(ConfigReader& reader, const YAML::Node& node, const std::string& path, const types::Field&,
              void* value) const override {
        return reader.text(node, path, of(value));
    }
    std::string name() const override { return "text"; }
    std::string text(const void* value) const override { return of(value); }
    void emit(YAML::Emitter& out, const void* value) const override { out << YAML::DoubleQuoted << of(value); }
    types::PropertyValue logged(const void* value) const override { return of(value); }
};

class VectorType final : public TypeOf<glm::dvec3, ValueType> {
public:
    bool read(ConfigReader& reader, const YAML::Node& node, const std::string& path, const types::Field& field,
              void* value) const override {
        return reader.vector3(node, path, field, of(value));
    }
    std::string name() const override { return "[x, y, z]"; }
    std::string text(const void* value) const override {
        return fmt::format("[{}, {}, {}]", of(value).x, of(value).y, of(value).z);
    }
    void emit(YAML::Emitter& out, const void* value) const override {
        out << YAML::BeginSeq;
        for (int i = 0; i < 3; ++i) out << fmt::format("{}", of(value)[i]);
        out << YAML::EndSeq;
    }
    types::PropertyValue logged(const void* value) const override { return flowYaml(*this, value); }
};

/** Read later by code that knows its type. */
class NodeType final : public TypeOf<YAML::Node, ValueType> {
public:
    bool read(ConfigReader&, const YAML::Node& node, const std::string&, const types::Field&,
              void* value) const override {
        of(value).reset(node);
        return true;
    }
    std::string name() const override { return "block"; }
    std::string text(const void*) const override { return ""; }
    void emit(YAML::Emitter& out, const void* value) const override { out << of(value); }
    types::PropertyValue logged(const void* value) const override { return flowYaml(*this, value); }
};

template <class Type>
const ValueType& only() {
    static const Type type;
    return type;
}

void* unconst(const void* value) { return const_cast<void*>(value); }

/** Sets a member of a block to its default value. */
void giveDefault(const BlockType& block, const types::Field& field, const ValueType& type, void* member) {
    block.visit(unconst(block.fresh()), [&](const types::Field& other, const ValueType& same, void* value) {
        if (std::string_view(other.name) == field.name && &same == &type) type.assign(member, value);
    });
}

/** Returns the form of a list of two that a field's meaning states, such as "[min, max]"; empty: it states none. */
std::string pairIn(std::string_view doc) {
    for (const std::string_view form : {"[min, max]", "[mean, deviation]"})
        if (doc.find(form) != doc.npos) return std::string(form);
    return "";
}

/** Returns a short value of a type in flow YAML, for errors; empty: it has none. Of a block it has one
 *  field, if possible one with a default. */
std::string makeExample(const ValueType& type, const types::Field& field) {
    const auto enclose = [](const char* begin, const std::string& text, const char* end) {
        return text.empty() ? text : begin + text + end;
    };
    if (const auto* optional = dynamic_cast<const OptionalType*>(&type)) return makeExample(optional->inner(), field);
    if (const auto* list = dynamic_cast<const ListType*>(&type))
        return enclose("[", makeExample(list->inner(), field), "]");
    if (const auto* map = dynamic_cast<const MapType*>(&type))
        return enclose("{NAME: ", makeExample(map->inner(), field), "}");
    const auto* const block = dynamic_cast<const BlockType*>(&type);
    const std::string text = type.text(type.fresh());
    if (!block && text == "0" && (field.min > 0 || field.max < 0)) return "";  // a bound is no example
    if (!block) return text;
    std::string with_default, without;
    block->visit(unconst(block->fresh()), [&](const types::Field& each, const ValueType& member_type, void* member) {
        const std::string given = member_type.text(member);
        const bool is_given = !given.empty() && given != "[]" && given != "NaN";
        std::string& found = is_given ? with_default : without;
        const std::string value = is_given ? given : makeExample(member_type, each);
        if (found.empty()) found = enclose((std::string("{") + each.name + ": ").c_str(), value, "}");
    });
    return with_default.empty() ? without : with_default;
}

}  // namespace

// clang-format off
template <> const ValueType& plainType<bool>() { return only<BoolType>(); }
template <> const ValueType& plainType<int8_t>() { return only<NumberType<int8_t>>(); }
template <> const ValueType& plainType<int16_t>() { return only<NumberType<int16_t>>(); }
template <> const ValueType& plainType<int32_t>() { return only<NumberType<int32_t>>(); }
template <> const ValueType& plainType<int64_t>() { return only<NumberType<int64_t>>(); }
template <> const ValueType& plainType<uint8_t>() { return only<NumberType<uint8_t>>(); }
template <> const ValueType& plainType<uint16_t>() { return only<NumberType<uint16_t>>(); }
template <> const ValueType& plainType<uint32_t>() { return only<NumberType<uint32_t>>(); }
template <> const ValueType& plainType<uint64_t>() { return only<NumberType<uint64_t>>(); }
template <> const ValueType& plainType<float>() { return only<NumberType<float>>(); }
template <> const ValueType& plainType<double>() { return only<NumberType<double>>(); }
template <> const ValueType& plainType<std::string>() { return only<TextType>(); }
template <> const ValueType& plainType<glm::dvec3>() { return only<VectorType>(); }
template <> const ValueType& plainType<YAML::Node>() { return only<NodeType>(); }
// clang-format on

bool OptionalType::read(ConfigReader& reader, const YAML::Node& node, const std::string& path,
                        const types::Field& field, void* value) const {
    return inner().read(reader, node, path, field, getOrMake(value));
}

bool ListType::read(ConfigReader& reader, const YAML::Node& node, const std::string& path, const types::Field& field,
                    void* value) const {
    const bool is_one = node.IsMap() && dynamic_cast<const BlockType*>(&inner());  // a list of one
    const std::string pair = pairIn(field.doc), example = node.IsSequence() ? "" : makeExample(*this, field);
    const std::string form = pair.empty() ? example.empty() ? "" : ", such as " + example : " of two, " + pair;
    if (!is_one && !reader.isSequence(node, path, form)) return false;
    renew(value, is_one ? 1 : node.size());
    if (is_one) return inner().read(reader, node, path, field, unconst(at(value, 0)));
    bool good = true;
    for (size_t i = 0; i < size(value); ++i)
        good &= inner().read(reader, node[i], fmt::format("{}[{}]", path, i), field, unconst(at(value, i)));
    return good;
}

std::string ListType::text(const void* value) const {
    std::vector<std::string> texts;
    for (size_t i = 0; i < size(value); ++i) texts.push_back(inner().text(at(value, i)));
    return fmt::format("[{}]", fmt::join(texts, ", "));
}

void ListType::emit(YAML::Emitter& out, const void* value) const {
    out << YAML::BeginSeq;
    for (size_t i = 0; i < size(value); ++i) inner().emit(out, at(value, i));
    out << YAML::EndSeq;
}

types::PropertyValue ListType::logged(const void* value) const { return flowYaml(*this, value); }

bool MapType::read(ConfigReader& reader, const YAML::Node& node, const std::string& path, const types::Field& field,
                   void* value) const {
    if (!reader.isMap(node, path, node.IsMap() ? "" : makeExample(*this, field))) return false;
    if (!reader.nullTakesOut()) clear(value);
    bool good = true;
    for (const auto& entry : node) {
        const std::string& key = entry.first.Scalar();
        if (reader.nullTakesOut() && entry.second.IsNull())
            erase(value, key);
        else
            good &= inner().read(reader, entry.second, below(path, key), field, getOrMake(value, key));
    }
    return good;
}

void MapType::emit(YAML::Emitter& out, const void* value) const {
    out << YAML::BeginMap;
    visit(value, [&](const std::string& key, const void* element) {
        out << YAML::Key << YAML::DoubleQuoted << key << YAML::Value;
        inner().emit(out, element);
    });
    out << YAML::EndMap;
}

types::PropertyValue MapType::logged(const void* value) const { return flowYaml(*this, value); }

bool BlockType::read(ConfigReader& reader, const YAML::Node& node, const std::string& path, const types::Field&,
                     void* value) const {
    return readBlock(reader, node, path, *this, value);
}

void BlockType::emit(YAML::Emitter& out, const void* value) const {
    out << YAML::BeginMap;
    visit(unconst(value), [&](const types::Field& field, const ValueType& type, void* member) {
        if (type.isAbsent(member)) return;
        out << YAML::Key << YAML::DoubleQuoted << field.name << YAML::Value;
        type.emit(out, member);
    });
    out << YAML::EndMap;
}

types::PropertyValue BlockType::logged(const void* value) const { return flowYaml(*this, value); }

void BlockType::list(const std::string& prefix, const void* value, std::vector<PropertyInfo>& list) const {
    visit(unconst(value), [&](const types::Field& field, const ValueType& type, void* member) {
        const std::string name = below(prefix, field.name);
        list.push_back({name, type.name(), field.unit, type.text(member), field.min, field.max, field.doc});
        type.list(name, member, list);
    });
}

bool EnumType::read(ConfigReader& reader, const YAML::Node& node, const std::string& path, const types::Field&,
                    void* value) const {
    size_t index = 0;
    if (!reader.oneOf(node, path, names_, count_, index)) return false;
    set(value, index);
    return true;
}

std::string EnumType::name() const { return fmt::format("{}", fmt::join(names_, names_ + count_, "|")); }

void EnumType::emit(YAML::Emitter& out, const void* value) const { out << YAML::DoubleQuoted << text(value); }

bool readBlock(ConfigReader& reader, const YAML::Node& node, const std::string& path, const BlockType& type,
               void* value) {
    const size_t before = reader.diagnostics().size();
    if (node.IsDefined() && !reader.isMap(node, path, node.IsMap() ? "" : makeExample(type, {}))) return false;
    std::vector<std::string> known;
    type.visit(value, [&](const types::Field& field, const ValueType& member_type, void* member) {
        const YAML::Node entry = child(node, field.name);
        known.push_back(field.name);
        if (entry.IsDefined() && entry.IsNull() && reader.nullTakesOut())
            giveDefault(type, field, member_type, member);
        else if (entry.IsDefined())
            member_type.read(reader, entry, below(path, field.name), field, member);
    });
    reader.refuseUnknown(node, path, known);
    types::Diagnostics diagnostics;
    if (reader.diagnostics().size() == before) type.check(value, diagnostics);
    reader.report(node, path, diagnostics);
    return reader.diagnostics().size() == before;
}

std::vector<PropertyInfo> listFields(const BlockType& type, const void* defaults) {
    std::vector<PropertyInfo> list;
    type.list("", defaults, list);
    return list;
}

std::map<std::string, types::PropertyValue> fieldValues(const BlockType& type, const void* value) {
    std::map<std::string, types::PropertyValue> values;
    type.visit(unconst(value), [&](const types::Field& field, const ValueType& member_type, void* member) {
        if (!member_type.isAbsent(member)) values.emplace(field.name, member_type.logged(member));
    });
    return values;
}

std::string flowYaml(const ValueType& type, const void* value) {
    YAML::Emitter out;
    out.SetMapFormat(YAML::Flow);
    out.SetSeqFormat(YAML::Flow);
    out.SetNullFormat(YAML::LowerNull);
    type.emit(out, value);
    std::string text = out.c_str();
    std::ranges::replace(text, '\n', ' ');  // flow breaks long lines
    return text;
}

}  // namespace insonify::framework
