// insonify schema
#include <fmt/format.h>

#include <cmath>

#include "components/command/CommandLine.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/DeploymentSpec.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

using framework::PropertyInfo;

/** A number, a dot and units, as Quantity reads them: "20.deg", "3.m.s^-1", "-1.5.m.round". */
constexpr const char* quantity_pattern = R"(^[+-]?[0-9]*\.?[0-9]+([eE][+-]?[0-9]+)?\.[A-Za-z].*$)";

/** Returns Rock's key for a number of this unit: {rad: 0.3}; null where there is none. */
const char* rockKey(const std::string& unit) {
    const auto is = framework::findUnit(unit);
    for (const auto& [key, of] : {std::pair("rad", "rad"), std::pair("kelvin", "K"), std::pair("microseconds", "s")})
        if (is && unit != "1" && is->dimension == framework::findUnit(of)->dimension) return key;
    return nullptr;
}

Json numberSchema(const PropertyInfo& info, const char* type) {
    Json schema = {{"type", type}};
    if (std::isfinite(info.min)) schema["minimum"] = info.min;
    if (std::isfinite(info.max)) schema["maximum"] = info.max;
    if (!framework::findUnit(info.unit)) return schema;
    schema["type"] = {type, "string"};
    schema["pattern"] = quantity_pattern;
    if (const char* key = rockKey(info.unit)) {
        schema["type"].push_back("object");
        schema["properties"] = {{key, {{"type", {"number", "string"}}}}};
        schema["required"] = {key};
        schema["additionalProperties"] = false;
    }
    return schema;
}

Json enumSchema(const std::string& names) {
    Json schema = {{"enum", Json::array()}};
    for (size_t start = 0; start <= names.size();) {
        const size_t end = std::min(names.find('|', start), names.size());
        schema["enum"].push_back(names.substr(start, end - start));
        start = end + 1;
    }
    return schema;
}

/** Returns the schema of a type by its name, without the fields of blocks. */
Json describeSchema(const PropertyInfo& info, std::string type) {
    const auto within = [&](const char* of) {
        const std::string prefix = of;
        return type.starts_with(prefix) ? std::optional(describeSchema(info, type.substr(prefix.size())))
                                        : std::nullopt;
    };
    if (type.ends_with(", optional")) type.resize(type.size() - std::string(", optional").size());
    if (const auto element = within("list of ")) return {{"type", "array"}, {"items", *element}};
    if (const auto element = within("map of "))
        return {{"type", {"object", "null"}}, {"additionalProperties", *element}};
    if (type == "double") return numberSchema(info, "number");
    if (type.starts_with("integer")) return numberSchema(info, "integer");
    if (type == "bool") return {{"type", "boolean"}};
    if (type == "text") return {{"type", {"string", "number", "boolean"}}};  // YAML may read it as a number or boolean
    if (type == "[x, y, z]")
        return {{"type", "array"}, {"items", numberSchema(info, "number")}, {"minItems", 3}, {"maxItems", 3}};
    if (type == "block") return {{"type", {"object", "null"}}};
    return enumSchema(type);
}

/** Adds documentation and default, for editors. */
Json documented(const PropertyInfo& info) {
    Json schema = describeSchema(info, info.type);
    const bool has_unit = !info.unit.empty() && info.unit != "1";
    schema["description"] = has_unit ? fmt::format("{} [{}]", info.doc, info.unit) : info.doc;
    if (info.default_value.empty()) return schema;
    const Json value = Json::parse(info.default_value, nullptr, false);
    const bool is_text = info.type == "text" || value.is_discarded();
    schema["default"] = is_text ? Json(info.default_value) : value;
    return schema;
}

/** Returns the schema of the block at a dotted path: "layers[].mean" is below items, "materials.<name>.mean" below
 *  additionalProperties. */
Json& blockAt(Json& root, const std::string& path) {
    Json* block = &root;
    for (size_t start = 0; start < path.size();) {
        size_t end = std::min(path.find('.', start), path.size());
        std::string key = path.substr(start, end - start);
        const bool is_list = key.ends_with("[]");
        if (is_list) key.resize(key.size() - 2);
        block = key == "<name>" ? &(*block)["additionalProperties"] : &(*block)["properties"][key];
        if (is_list) block = &(*block)["items"];
        start = end + 1;
    }
    return *block;
}

/** Allows a single block for a list of one, in all lists of blocks within a schema. */
void allowOneForAList(Json& schema) {
    for (auto& [name, property] : schema["properties"].items()) {
        if (property.contains("properties")) allowOneForAList(property);
        if (!property.contains("items") || !property["items"].contains("properties")) continue;
        allowOneForAList(property["items"]);
        property["type"] = {"array", "object"};
        for (const char* key : {"properties", "additionalProperties"}) property[key] = property["items"][key];
    }
}

/** Returns the schema of a block that refuses all other fields. */
Json blockSchema(const std::vector<PropertyInfo>& fields) {
    Json root = {{"type", {"object", "null"}}, {"additionalProperties", false}, {"properties", Json::object()}};
    for (const PropertyInfo& field : fields) {
        const size_t dot = field.name.rfind('.');
        Json& block = dot == std::string::npos ? root : blockAt(root, field.name.substr(0, dot));
        if (!block.contains("additionalProperties")) block["additionalProperties"] = false;
        block["properties"][dot == std::string::npos ? field.name : field.name.substr(dot + 1)] = documented(field);
    }
    allowOneForAList(root);
    return root;
}

std::vector<PropertyInfo> getProperties(const framework::Registry::Entry& entry) {
    std::vector<PropertyInfo> all;
    const auto task = framework::Registry::example(entry);
    if (!task) return all;
    for (const auto* properties : task->properties())
        for (PropertyInfo& info : properties->list()) all.push_back(std::move(info));
    return all;
}

/** Returns the rule for a task of that type whose properties have no other names. */
Json propertiesRule(const std::string& type) {
    Json renamed = Json::array();
    for (const char* key : {"aliases", "copies", "switches"}) renamed.push_back({{"required", {key}}});
    return {
        {"if", {{"properties", {{"type", {{"const", type}}}}}, {"required", {"type"}}, {"not", {{"anyOf", renamed}}}}},
        {"then", {{"properties", {{"properties", {{"$ref", "#/$defs/" + type}}}}}}}};
}

Json taskSchema(const framework::Registry& registry, const std::vector<PropertyInfo>& keys) {
    Json task = blockSchema(keys);
    task["type"] = "object";
    task["required"] = {"type"};
    task["allOf"] = Json::array();
    for (const auto& entry : registry.list()) task["allOf"].push_back(propertiesRule(entry.type));
    return task;
}

Json typeNames(const framework::Registry& registry) {
    Json named = Json::array();
    for (const auto& entry : registry.list()) named.push_back({{"const", entry.type}, {"description", entry.doc}});
    return {{"properties", {{"type", {{"oneOf", named}}}}}};
}

/** Returns the JSON schema (draft 2020-12) of deployments with these tasks, from the tasks' descriptions: keys, types,
 *  bounds, defaults, names of enums and documentation, which ends in the unit. Numbers may be texts with a unit,
 *  "20.deg". With aliases, copies or switches a task's properties may have other names; with libraries a deployment may
 *  have other types. Only `insonify check` reports errors that depend on several keys. */
Json deploymentSchema(const framework::Registry& registry) {
    const framework::DeploymentKeys keys = framework::deploymentKeys();
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", "A deployment of Insonify " INSONIFY_VERSION}};
    schema.update(blockSchema(keys.document));
    schema["type"] = "object";
    schema["required"] = {"tasks"};
    Json& tasks = schema["properties"]["tasks"];
    tasks["type"] = "object";
    tasks["minProperties"] = 1;
    tasks["propertyNames"] = {{"pattern", "^[^.]+$"}};
    tasks["additionalProperties"] = {{"$ref", "#/$defs/task"}};
    Json& connections = schema["properties"]["connections"];
    connections["type"] = {"array", "null"};
    connections["items"] = blockSchema(keys.connection);
    for (const char* end : {"from", "to"})
        connections["items"]["properties"][end].update({{"type", "string"}, {"pattern", R"(^[^.]+\..+$)"}});
    connections["items"]["required"] = {"from", "to"};
    // Libraries may add types.
    schema["if"] = {{"not", {{"required", {"libraries"}}}}};
    schema["then"] = {{"properties", {{"tasks", {{"additionalProperties", typeNames(registry)}}}}}};
    schema["$defs"]["task"] = taskSchema(registry, keys.task);
    for (const auto& entry : registry.list()) schema["$defs"][entry.type] = blockSchema(getProperties(entry));
    return schema;
}

}  // namespace

void addSchemaCommand(CLI::App& app, Action& action) {
    CLI::App* command = app.add_subcommand(
        "schema", "Prints the JSON schema of deployments, with which editors complete and check them");
    command->callback([&action] {
        action = [] {
            print(deploymentSchema(allTasks()));
            return 0;
        };
    });
}

}  // namespace insonify::command
