#include "components/dataset/StatisticsPage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace insonify::dataset {
namespace {

constexpr size_t max_examples = 12;
constexpr size_t max_values = 24;  ///< Max values of a setting with a bar each.
constexpr size_t max_single = 4;   ///< Max numbers with a bar each if no two samples share a number, as when drawn.
constexpr int range_step = 5;      ///< [m]

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text)
        safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
    return safe;
}

/** Returns a distinct hue per class. */
std::string getColour(uint32_t category) { return fmt::format("hsl({},90%,60%)", category * 137 % 360); }

/** Returns the median of numbers by their counts, which are not all 0. */
double median(const std::map<double, uint64_t>& counts) {
    uint64_t total = 0, before = 0;
    for (const auto& [number, count] : counts) total += count;
    std::optional<double> lower;
    for (const auto& [number, count] : counts) {
        before += count;
        if (!lower && 2 * before >= total) lower = number;
        if (2 * before > total) return (*lower + number) / 2;
    }
    return 0;
}

}  // namespace

void StatisticsPage::OfSetting::add(const Json& value) {
    if (value.is_number())
        ++numbers[value];
    else if (others.size() <= max_values)
        ++others[value.is_string() ? value.get<std::string>() : toText(value)];
}

void StatisticsPage::OfSetting::addBars(const std::string& property, Bars& bars) const {
    uint64_t total = 0;
    for (const auto& [number, count] : numbers) total += count;
    if (numbers.size() > (total == numbers.size() ? max_single : max_values)) {
        bars.emplace_back(fmt::format("{}: {:.6g} to {:.6g}, median {:.6g}", property, numbers.begin()->first,
                                      numbers.rbegin()->first, median(numbers)),
                          total);
    } else {
        for (const auto& [number, count] : numbers) bars.emplace_back(fmt::format("{} = {}", property, number), count);
    }
    if (others.size() > max_values) return;
    for (const auto& [value, count] : others) bars.emplace_back(property + " = " + value, count);
}

void StatisticsPage::add(const Json& record, const std::string& picture) {
    ++samples_;
    ++parts_[record["part"]];
    ++scenes_[record["scene"]];
    for (const auto& [property, value] : record["settings"].items()) settings_[property].add(value);
    std::set<uint32_t> seen;
    for (const Json& each : record["annotations"]) {
        const auto category = each["category"].get<uint32_t>();
        const auto area = each["area"].get<uint64_t>();
        const double near = each["range_m"][0], far = each["range_m"][1];
        OfClass& of = of_class_[category];
        of.nearest = of.objects == 0 ? near : std::min(of.nearest, near);
        of.farthest = std::max(of.farthest, far);
        ++of.objects;
        of.pixels += area;
        of.samples += seen.insert(category).second;
        ++areas_[static_cast<int>(std::log2(static_cast<double>(area)))];
        ++ranges_[static_cast<int>((near + far) / 2) / range_step];
    }
    ++objects_in_picture_[record["annotations"].size()];
    if (!picture.empty() && examples_.size() < max_examples) examples_.push_back(example(record, picture));
}

std::string StatisticsPage::example(const Json& record, const std::string& picture) {
    const Json& size = record["picture"];
    const int width = size["width"], height = size["height"];
    std::string text =
        fmt::format("<figure><svg viewBox=\"0 0 {0} {1}\"><image href=\"{2}\" width=\"{0}\" height=\"{1}\"/>\n", width,
                    height, escaped(picture));
    for (const Json& each : record["annotations"]) {
        const Json& box = each["bbox"];
        text +=
            fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" stroke=\"{}\"><title>{}</title></rect>\n",
                        box[0].get<int>(), box[1].get<int>(), box[2].get<int>(), box[3].get<int>(),
                        getColour(each["category"]), escaped(each["name"]));
    }
    return text + fmt::format("</svg><figcaption>{}, {}, {} objects</figcaption></figure>\n",
                              record["index"].get<uint64_t>(), record["part"].get<std::string>(),
                              record["annotations"].size());
}

std::string StatisticsPage::drawn(const std::string& caption, const Bars& bars) {
    uint64_t maximum = 1;
    for (const auto& [name, count] : bars) maximum = std::max(maximum, count);
    std::string text = fmt::format("<h2>{}</h2>\n<table>\n", escaped(caption));
    for (const auto& [name, count] : bars)
        text += fmt::format("<tr><td>{}</td><td><meter max=\"{}\" value=\"{}\"></meter></td><td>{}</td></tr>\n",
                            escaped(name), maximum, count, count);
    return text + "</table>\n";
}

std::string StatisticsPage::tableOfClasses() const {
    std::string text =
        "<h2>Classes</h2>\n<table><tr><th></th><th>class</th><th>objects</th><th>samples with any</th>"
        "<th>pixels in the mean</th><th>from [m]</th><th>to [m]</th></tr>\n";
    for (uint32_t category = 1; category <= classes_.size(); ++category) {
        const auto found = of_class_.find(category);
        const OfClass of = found == of_class_.end() ? OfClass{} : found->second;
        const double mean = of.objects ? static_cast<double>(of.pixels) / static_cast<double>(of.objects) : 0;
        text += fmt::format(
            "<tr><td style=\"background:{}\">&nbsp;</td><td>{}</td><td>{}</td><td>{}</td><td>{:.0f}</td>"
            "<td>{:.2f}</td><td>{:.2f}</td></tr>\n",
            getColour(category), escaped(classes_[category - 1]), of.objects, of.samples, mean, of.nearest,
            of.farthest);
    }
    return text + "</table>\n";
}

std::string StatisticsPage::text() const {
    const auto named = [](const std::map<std::string, uint64_t>& counts) { return Bars(counts.begin(), counts.end()); };
    Bars areas, ranges, objects;
    for (const auto& [power, count] : areas_)
        areas.emplace_back(fmt::format("{} to {} px", 1 << power, (2 << power) - 1), count);
    for (const auto& [step, count] : ranges_)
        ranges.emplace_back(fmt::format("{} to {} m", step * range_step, (step + 1) * range_step), count);
    for (const auto& [number, count] : objects_in_picture_)
        objects.emplace_back(fmt::format("{} objects", number), count);
    std::string page = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + escaped(title_) +
                       "</title>\n" +
                       "<style>body{font:14px sans-serif;max-width:1200px;margin:2em auto;padding:0 "
                       "1em;color:#222}table{border-collapse:collapse}"
                       "td,th{padding:2px 10px;text-align:right;border-bottom:1px solid #ddd}meter{width:320px}"
                       "figure{display:inline-block;margin:6px;width:370px}figure svg{width:100%;background:#000}"
                       "figure rect{fill:none;stroke-width:2}</style></head>\n<body><h1>" +
                       escaped(title_) + fmt::format("</h1>\n<p>{} samples</p>\n", samples_);
    page += drawn("Samples by part", named(parts_)) + drawn("Samples by scene", named(scenes_));
    Bars settings;
    for (const auto& [property, values] : settings_) values.addBars(property, settings);
    if (!settings.empty()) page += drawn("Samples by setting", settings);
    page += tableOfClasses();
    page += drawn("Objects in a sample", objects) + drawn("Objects by size", areas) + drawn("Objects by range", ranges);
    if (!examples_.empty()) page += "<h2>Examples</h2>\n";
    for (const std::string& example : examples_) page += example;
    return page + "</body></html>\n";
}

}  // namespace insonify::dataset
