#include "components/framework/config/ConfigReader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "components/framework/config/YamlText.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::framework {
namespace {

struct Named {
    std::string_view name;
    Unit unit;
};
constexpr Named units[] = {
    {"m", {1, 0, {1, 0, 0, 0, 0}}},    {"g", {1e-3, 0, {0, 1, 0, 0, 0}}},
    {"s", {1, 0, {0, 0, 1, 0, 0}}},    {"K", {1, 0, {0, 0, 0, 1, 0}}},
    {"rad", {1, 0, {0, 0, 0, 0, 1}}},  {"deg", {std::numbers::pi / 180, 0, {0, 0, 0, 0, 1}}},
    {"Hz", {1, 0, {0, 0, -1, 0, 0}}},  {"N", {1, 0, {1, 1, -2, 0, 0}}},
    {"Pa", {1, 0, {-1, 1, -2, 0, 0}}}, {"bar", {1e5, 0, {-1, 1, -2, 0, 0}}},
};
constexpr std::pair<std::string_view, double> prefixes[] = {{"", 1},     {"M", 1e6},   {"k", 1e3},  {"d", 1e-1},
                                                            {"c", 1e-2}, {"mu", 1e-6}, {"m", 1e-3}, {"u", 1e-6},
                                                            {"n", 1e-9}, {"p", 1e-12}};

std::optional<Unit> prefixed(std::string_view name) {
    for (const auto& [prefix, factor] : prefixes)
        for (const Named& named : units) {
            if (name.size() != prefix.size() + named.name.size()) continue;
            if (!name.starts_with(prefix) || !name.ends_with(named.name)) continue;
            Unit unit = named.unit;
            unit.scale *= factor;
            return unit;
        }
    return std::nullopt;
}

Unit product(const Unit& a, const Unit& b, int power) {
    Unit unit{a.scale * std::pow(b.scale, power), 0, a.dimension};
    for (size_t i = 0; i < unit.dimension.size(); ++i) unit.dimension[i] += power * b.dimension[i];
    return unit;
}

/** "m", "s^-1" */
std::optional<Unit> powered(std::string_view text) {
    const size_t hat = text.find('^');
    const auto unit = prefixed(text.substr(0, hat));
    if (!unit || hat == std::string_view::npos) return unit;
    int power = 0;
    const char *begin = text.data() + hat + 1, *end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(begin, end, power);
    if (error != std::errc() || stop != end || std::abs(power) > 9) return std::nullopt;
    return product(Unit{}, *unit, power);
}

/** Takes "3.5" from the front of "3.5.m"; false when there is no number followed by a point and a name. */
bool consumeNumber(std::string_view& text, double& number) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || !std::isfinite(number)) return false;
    text.remove_prefix(static_cast<size_t>(stop - text.data()));
    if (*(stop - 1) == '.') return !text.empty();  // "20." in "20.deg" is also a number
    if (text.size() < 2 || text.front() != '.') return false;
    text.remove_prefix(1);
    return true;
}

}  // namespace

std::optional<Unit> findUnit(std::string_view name) {
    if (name == "1") return Unit{};
    if (name == "degC") return Unit{1, 273.15, {0, 0, 0, 1, 0}};
    const size_t slash = name.find('/');
    const auto above = powered(name.substr(0, slash));
    if (!above || slash == std::string_view::npos) return above;
    const auto below = powered(name.substr(slash + 1));
    return below ? std::optional(product(*above, *below, -1)) : std::nullopt;
}

std::optional<Quantity> Quantity::parse(std::string_view text) {
    Quantity quantity;
    if (!consumeNumber(text, quantity.number)) return std::nullopt;
    while (!text.empty()) {
        const size_t end = std::min(text.find('.'), text.size());
        const std::string_view word = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (text.empty() && (word == "round" || word == "floor" || word == "ceil")) {
            quantity.rounding = word.front();
            return quantity;
        }
        const auto unit = powered(word);
        if (!unit) return std::nullopt;
        quantity.unit = product(quantity.unit, *unit, 1);
    }
    return quantity;
}

std::optional<double> Quantity::in(const Unit& other) const {
    if (unit.dimension != other.dimension) return std::nullopt;
    const bool same = unit.scale == other.scale && unit.zero == other.zero;  // no digit changes
    const double converted = same ? number : (number * unit.scale + unit.zero - other.zero) / other.scale;
    if (rounding == 'r') return std::round(converted);
    if (rounding == 'f') return std::floor(converted);
    return rounding == 'c' ? std::ceil(converted) : converted;
}

namespace {

/** A scalar without quotes: in strict YAML only this can be a number or a boolean. */
bool isPlain(const YAML::Node& node) { return node.IsScalar() && node.Tag() != "!"; }

bool parseDouble(std::string_view text, double& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

/** Returns a number with a unit, "20.deg", also from one of Rock's blocks: {rad: 0.3}, {rad: 20.deg}, {kelvin: 280}. */
std::optional<Quantity> readQuantity(const YAML::Node& node) {
    if (!node.IsDefined()) return std::nullopt;
    if (node.IsScalar()) return Quantity::parse(node.Scalar());
    static constexpr std::pair<const char*, const char*> blocks[] = {
        {"rad", "rad"}, {"kelvin", "K"}, {"microseconds", "us"}};
    for (const auto& [key, unit] : blocks) {
        if (!node.IsMap() || node.size() != 1) continue;
        const YAML::Node inner = child(node, key);
        double number = 0;
        if (!inner.IsDefined() || !inner.IsScalar()) continue;
        if (parseDouble(inner.Scalar(), number) && std::isfinite(number)) return Quantity{number, *findUnit(unit)};
        return Quantity::parse(inner.Scalar());
    }
    return std::nullopt;
}

/** Returns the node's value, for messages. */
std::string shown(const YAML::Node& node) {
    if (!node.IsDefined() || node.IsNull()) return "empty";
    if (readQuantity(node) && node.IsMap())
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
    const auto written = findUnit(unit), wanted = findUnit(field.unit);
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

bool ConfigReader::isMap(const YAML::Node& node, const std::string& path, const std::string& example) {
    if (node.IsNull()) return true;
    if (!node.IsMap())
        return report(node, path,
                      "is " + shown(node) + "; must be a block of keys and values" +
                          (example.empty() ? "" : ", such as " + example)),
               false;
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
    report(node, path, "is " + shown(node) + "; must be a list" + form);
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
    if (const auto quantity = readQuantity(node)) {
        const auto unit = findUnit(field.unit);
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
    std::string_view digits = readQuantity(node) ? std::string_view("0.") : node.Scalar();
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
