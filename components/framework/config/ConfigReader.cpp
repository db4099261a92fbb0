#include "components/framework/config/ConfigReader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "components/framework/config/Quantity.hpp"
#include "components/framework/config/YamlText.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::framework {
namespace {

/** A scalar without quotes: in strict YAML only this can be a number or a boolean. */
bool isPlain(const YAML::Node& node) { return node.IsScalar() && node.Tag() != "!"; }

bool parseDouble(std::string_view text, double& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

/** Returns a number with a unit, "20.deg", also from one of Rock's blocks: {rad: 0.3}, {rad: 20.deg}, {kelvin: 280}. */
std::optional<Quantity> quantityOf(const YAML::Node& node) {
    if (!node.IsDefined()) return std::nullopt;
    if (node.IsScalar()) return Quantity::parse(node.Scalar());
    static constexpr std::pair<const char*, const char*> blocks[] = {
        {"rad", "rad"}, {"kelvin", "K"}, {"microseconds", "us"}};
    for (const auto& [key, unit] : blocks) {
        if (!node.IsMap() || node.size() != 1) continue;
        const YAML::Node inner = child(node, key);
        double number = 0;
        if (!inner.IsDefined() || !inner.IsScalar()) continue;
        if (parseDouble(inner.Scalar(), number) && std::isfinite(number)) return Quantity{number, *unitOf(unit)};
        return Quantity::parse(inner.Scalar());
    }
    return std::nullopt;
}

/** Returns the node's value, for messages. */
std::string shown(const YAML::Node& node) {
    if (!node.IsDefined() || node.IsNull()) return "empty";
    if (quantityOf(node) && node.IsMap())
        return "{" + node.begin()->first.Scalar() + ": " + node.begin()->second.Scalar() + "}";
    if (node.IsMap()) return "a block";
    if (node.IsSequence()) return "a list";
    std::string text = node.Scalar().substr(0, 60);
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return isPlain(node) ? text : "the text \"" + text + "\"";
}

std::string withUnit(const std::string& number, const types::Field& field) {
    const std::string unit = field.unit;
    return unit.empty() || unit == "1" ? number : number + " " + unit;
}

std::string allowed(const types::Field& field) {
    if (std::isinf(field.max)) return "must be at least " + withUnit(fmt::format("{}", field.min), field);
    if (std::isinf(field.min)) return "must be at most " + withUnit(fmt::format("{}", field.max), field);
    return "may be " + withUnit(fmt::format("{} to {}", field.min, field.max), field);
}

std::string wantedUnit(const types::Field& field) {
    const std::string unit = field.unit;
    return unit.empty() || unit == "1" ? "must be a number without a unit" : "must be in " + unit;
}

/** Returns "write true. " for the booleans of other languages and of YAML 1.1. */
std::string truthHint(const YAML::Node& node) {
    static const std::vector<std::string> yes{"yes", "on", "1", "True", "TRUE", "y"};
    static const std::vector<std::string> no{"no", "off", "0", "False", "FALSE", "n"};
    const auto is = [&](const auto& words) { return node.IsScalar() && std::ranges::count(words, node.Scalar()) > 0; };
    return is(yes) ? "write true; " : is(no) ? "write false; " : "";
}

/** Returns "20.m" for 20 and "m", "3.m.s^-1" for 3 and "m/s"; empty where a quantity cannot be written. */
std::string quantityText(const std::string& number, std::string unit) {
    if (const size_t slash = unit.find('/'); slash != std::string::npos)
        unit = unit.substr(0, slash) + "." + unit.substr(slash + 1) + "^-1";
    return Quantity::parse(number + "." + unit) ? number + "." + unit : "";
}

bool areDigits(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c); });
}

/** Returns "write 20 or 20.m; " for usual forms of a number with a unit or a comma: "20 m", "20m", "20,5". */
std::string unitHint(const YAML::Node& node, const types::Field& field) {
    if (!node.IsDefined() || !node.IsScalar()) return "";
    const std::string& text = node.Scalar();
    double read = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
    if (error != std::errc() || !std::isfinite(read)) return "";
    const std::string number(text.data(), end);
    std::string unit(end, text.data() + text.size());
    if (unit.starts_with(',') && areDigits(unit.substr(1))) return "write " + number + "." + unit.substr(1) + "; ";
    unit.erase(0, unit.find_first_not_of(" \t"));
    if (unit == field.unit && quantityText(number, unit).empty()) return "write " + number + "; ";
    const auto written = unitOf(unit), wanted = unitOf(field.unit);
    const auto converted = written && wanted ? Quantity{read, *written, 0}.in(*wanted) : std::nullopt;
    if (!converted) return "";
    const std::string quantity = quantityText(number, unit);
    return fmt::format("write {:.12g}{}; ", *converted, quantity.empty() ? "" : " or " + quantity);
}

/** Returns the node at a path such as "tvg.max_db" or "waypoints[2].time", or the last existing node on the way. */
YAML::Node nodeAt(const YAML::Node& block, std::string_view path) {
    YAML::Node node = block;
    while (!path.empty() && node.IsDefined()) {
        const size_t end = std::min(path.find_first_of(".["), path.size());
        YAML::Node next(YAML::NodeType::Undefined);
        if (node.IsMap()) next.reset(child(node, path.substr(0, end)));
        if (size_t index = 0;
            node.IsSequence() && std::from_chars(path.data(), path.data() + end, index).ec == std::errc())
            if (index < node.size()) next.reset(node[index]);
        if (!next.IsDefined()) break;
        node.reset(next);
        path.remove_prefix(end);
        path.remove_prefix(std::min(path.find_first_not_of(".[]"), path.size()));
    }
    return node;
}

}  // namespace

std::string suggestion(std::string_view wrong, const std::vector<std::string>& known) {
    if (known.empty()) return "there are none";
    return types::didYouMean(wrong, known) + fmt::format("known: {}", fmt::join(known, ", "));
}

YAML::Node child(const YAML::Node& map, std::string_view key) {
    if (map.IsDefined() && map.IsMap())
        for (const auto& entry : map)
            if (entry.first.IsScalar() && entry.first.Scalar() == key) return entry.second;
    return YAML::Node(YAML::NodeType::Undefined);
}

void ConfigReader::report(const YAML::Node& node, const std::string& path, const std::string& message,
                          types::Diagnostic::Kind kind) {
    Origin origin{file_, path, fallback_};
    size_t longest = 0;
    for (const auto& [covered, from] : origins_) {
        const bool covers = path == covered || path.starts_with(covered + ".") || path.starts_with(covered + "[");
        if (!covers || covered.size() < longest) continue;
        longest = covered.size();
        origin = {from.file, from.path + path.substr(covered.size()), from.mark};
    }
    const bool has_place = node.IsDefined() && !node.Mark().is_null();
    if (longest == 0 && !has_place)  // a block that exists only because a key below it was set
        for (const auto& [covered, from] : origins_)
            if (from.isOption() && covered.starts_with(path + ".")) origin.file = from.file;
    if (has_place) origin.mark = node.Mark();
    if (origin.file.empty() || origin.isOption() || origin.mark.is_null())
        diagnostics_.push_back({origin.path, message, origin.file, 0, 0, kind});
    else
        diagnostics_.push_back({origin.path, message, origin.file, origin.mark.line + 1, origin.mark.column + 1, kind});
}

void ConfigReader::report(const YAML::Node& block, const std::string& path, const types::Diagnostics& diagnostics) {
    for (const types::Diagnostic& each : diagnostics)
        report(nodeAt(block, each.path), each.path.empty() ? path : below(path, each.path), each.message, each.kind);
}

bool ConfigReader::isMap(const YAML::Node& node, const std::string& path) {
    if (node.IsNull()) return true;
    if (!node.IsMap()) return report(node, path, "is " + shown(node) + "; must be a block of keys and values"), false;
    std::set<std::string> seen;
    bool good = true;
    for (const auto& entry : node) {
        if (!entry.first.IsScalar())
            report(entry.first, path, "has a key that is " + shown(entry.first) + "; keys are names"), good = false;
        else if (!seen.insert(entry.first.Scalar()).second)
            report(entry.first, below(path, entry.first.Scalar()), "is given twice; once is allowed"), good = false;
    }
    return good;
}

bool ConfigReader::isSequence(const YAML::Node& node, const std::string& path, const std::string& form) {
    if (node.IsSequence()) return true;
    report(node, path, "is " + shown(node) + "; must be a list" + (form.empty() ? "" : " of two, " + form));
    return false;
}

void ConfigReader::refuseUnknown(const YAML::Node& map, const std::string& path,
                                 const std::vector<std::string>& known) {
    if (!map.IsDefined() || !map.IsMap()) return;
    for (const auto& entry : map) {
        if (!entry.first.IsScalar()) continue;
        const std::string& key = entry.first.Scalar();
        if (std::find(known.begin(), known.end(), key) == known.end())
            report(entry.first, below(path, key), "is not a key here; " + suggestion(key, known),
                   types::Diagnostic::Kind::UnknownKey);
    }
}

bool ConfigReader::readText(const std::string& yaml, const std::string& path, const ValueType& type, void* value) {
    try {
        return type.read(*this, parseValue(yaml), path, types::Field{path.c_str()}, value);
    } catch (const types::ConfigError& error) {
        report(YAML::Node(YAML::NodeType::Undefined), path, error.diagnostics().front().message);
        return false;
    }
}

bool ConfigReader::number(const YAML::Node& node, const std::string& path, const types::Field& field, double& value,
                          const char* wanted) {
    double read = 0;
    if (const auto quantity = quantityOf(node)) {
        const auto unit = unitOf(field.unit);
        const auto converted = unit ? quantity->in(*unit) : std::nullopt;
        if (!converted) return report(node, path, "is " + shown(node) + "; " + wantedUnit(field)), false;
        read = *converted;
    } else if (!isPlain(node) || !parseDouble(node.Scalar(), read) || !std::isfinite(read)) {
        report(node, path, "is " + shown(node) + "; " + unitHint(node, field) + wanted);
        return false;
    }
    if (read < field.min || read > field.max) {
        report(node, path, "is " + withUnit(fmt::format("{}", read), field) + "; " + allowed(field));
        return false;
    }
    value = read;
    return true;
}

bool ConfigReader::whole(const YAML::Node& node, const std::string& path, const types::Field& field, int64_t lowest,
                         uint64_t highest, bool& negative, uint64_t& magnitude) {
    double wide = 0;
    if (!number(node, path, field, wide, "must be a whole number")) return false;
    if (wide != std::floor(wide)) {
        report(node, path, "is " + shown(node) + "; must be a whole number", types::Diagnostic::Kind::NotWhole);
        return false;
    }
    std::string_view digits = quantityOf(node) ? std::string_view("0.") : node.Scalar();
    negative = wide < 0;
    if (digits.starts_with('-') || digits.starts_with('+')) digits.remove_prefix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), magnitude);
    const bool exact = error == std::errc() && end == digits.data() + digits.size();
    // With a decimal point or an exponent: exact as a double, otherwise not a reliable whole number.
    if (!exact && error == std::errc() && std::abs(wide) <= 0x1p53) magnitude = static_cast<uint64_t>(std::abs(wide));
    const uint64_t limit = negative ? ~static_cast<uint64_t>(lowest) + 1 : highest;
    if ((exact || (error == std::errc() && std::abs(wide) <= 0x1p53)) && magnitude <= limit) return true;
    report(node, path, fmt::format("is {}; must be a whole number from {} to {}", shown(node), lowest, highest));
    return false;
}

bool ConfigReader::oneOf(const YAML::Node& node, const std::string& path, const std::string_view* names, size_t count,
                         size_t& index) {
    for (index = 0; index < count; ++index)
        if (node.IsScalar() && node.Scalar() == names[index]) return true;
    const std::string hint = node.IsScalar() ? types::didYouMean(node.Scalar(), {names, names + count}) : "";
    report(node, path,
           "is " + shown(node) + "; " + hint + fmt::format("may be {}", fmt::join(names, names + count, ", ")));
    return false;
}

bool ConfigReader::text(const YAML::Node& node, const std::string& path, std::string& value) {
    if (!node.IsScalar()) return report(node, path, "is " + shown(node) + "; must be a text"), false;
    value = node.Scalar();
    return true;
}

bool ConfigReader::boolean(const YAML::Node& node, const std::string& path, bool& value) {
    const bool good = isPlain(node) && (node.Scalar() == "true" || node.Scalar() == "false");
    if (good)
        value = node.Scalar() == "true";
    else
        report(node, path, "is " + shown(node) + "; " + truthHint(node) + "may be true or false");
    return good;
}

bool ConfigReader::vector3(const YAML::Node& node, const std::string& path, const types::Field& field,
                           glm::dvec3& value) {
    if (!node.IsSequence() || node.size() != 3)
        return report(node, path,
                      "is " + shown(node) + (node.IsSequence() ? fmt::format(" of {}", node.size()) : "") +
                          "; must be a list of three numbers [x, y, z]"),
               false;
    bool good = true;
    for (int i = 0; i < 3; ++i) good &= number(node[i], path + "[" + std::to_string(i) + "]", field, value[i]);
    return good;
}

}  // namespace insonify::framework
