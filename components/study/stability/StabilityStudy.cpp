#include "components/study/stability/StabilityStudy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <stdexcept>

namespace insonify::study {
namespace {

/** Returns a JSON string. */
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            result += fmt::format("\\u{:04x}", static_cast<int>(c));
        else
            result += c;
    }
    return result + '"';
}

/** Returns a JSON number; null if not finite, which JSON cannot represent. */
std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null"; }

/** Returns "33. TVG gain of 1e20". */
std::string title(const StabilityRow& row) { return fmt::format("{}. {}", row.number, row.name); }

std::string json(const StabilityRow& row) {
    std::string conditions;
    for (const auto& [name, value] : row.outcome.conditions)
        conditions += fmt::format("{}{}: {}", conditions.empty() ? "" : ", ", quoted(name), number(value));
    return fmt::format(
        R"({{"case": {}, "conditions": {{{}}}, "expected": {}, "got": {}, "deviation": {}, "verdict": {}}})",
        quoted(title(row)), conditions, quoted(row.expected), quoted(row.outcome.got), number(row.outcome.deviation),
        quoted(getName(row.outcome.verdict)));
}

/** Returns a cell of a markdown table. */
std::string cell(std::string text) {
    for (size_t at = 0; (at = text.find_first_of("|\n", at)) != std::string::npos; at += 2)
        text.replace(at, 1, text[at] == '|' ? "\\|" : "; ");
    return text;
}

std::string markdown(const StabilityRow& row) {
    std::string conditions;
    for (const auto& [name, value] : row.outcome.conditions)
        conditions += fmt::format("{}{} {:.4g}", conditions.empty() ? "" : ", ", name, value);
    return fmt::format("| {} | {} | {} | {} | {} | {} |\n", cell(title(row)), cell(conditions), cell(row.expected),
                       cell(row.outcome.got),
                       isEvaluated(row.outcome) ? fmt::format("{:.2g}", row.outcome.deviation) : "",
                       getName(row.outcome.verdict));
}

size_t count(const std::vector<StabilityRow>& rows, Verdict verdict) {
    return static_cast<size_t>(
        std::ranges::count_if(rows, [=](const StabilityRow& row) { return row.outcome.verdict == verdict; }));
}

void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    if (!stream.flush()) throw std::runtime_error(file.string() + " cannot be written");
}

constexpr const char* legend =
    "Condition numbers: `kappa`, the max number of bins that one pixel covers; `range_ratio`, farthest range over "
    "nearest; "
    "`attenuation_db`, two-way absorption from the nearest to the farthest range; `offset_ratio`, distance from the "
    "world's origin in bins; `strength_db`, loudest material over the mean; `samples_per_bin`, pixels per occupied "
    "bin. "
    "Deviations are relative unless a unit is named; `not run` needs what this machine lacks.\n\n";

}  // namespace

bool isEvaluated(const Outcome& outcome) {
    return outcome.verdict == Verdict::Pass || outcome.verdict == Verdict::Fail;
}

const char* getName(Verdict verdict) {
    switch (verdict) {
        case Verdict::Pass: return "pass";
        case Verdict::Fail: return "fail";
        case Verdict::NotRun: return "not run";
    }
    return "";
}

std::vector<StabilityCase> stabilityCases() {
    std::vector<StabilityCase> all;
    for (const auto& group :
         {precisionCases, geometryCases, sensorCases, levelCases, sumCases, noiseCases, targetCases})
        for (StabilityCase& added : group()) all.push_back(std::move(added));
    return all;
}

StabilityRow runCase(const StabilityCase& c) {
    try {
        return {c.number, c.name, c.expected, c.run()};
    } catch (const std::exception& error) {
        return {c.number, c.name, c.expected, {{}, fmt::format("threw: {}", error.what()), INFINITY, Verdict::Fail}};
    }
}

std::vector<StabilityRow> studyStability(std::vector<StabilityCase> cases,
                                         const std::function<void(const StabilityRow&)>& done) {
    std::ranges::stable_sort(cases, {}, &StabilityCase::number);
    std::vector<StabilityRow> rows;
    for (const StabilityCase& c : cases) done(rows.emplace_back(runCase(c)));
    return rows;
}

std::string tally(const std::vector<StabilityRow>& rows) {
    return fmt::format("{} pass, {} fail, {} not run", count(rows, Verdict::Pass), count(rows, Verdict::Fail),
                       count(rows, Verdict::NotRun));
}

void writeStability(const std::vector<StabilityRow>& rows, const std::filesystem::path& folder) {
    std::string sheet = fmt::format("# Stiff and extreme cases\n\n{}.\n\n", tally(rows));
    sheet += legend;
    sheet += "| case | conditions | expected | got | deviation | verdict |\n|---|---|---|---|---|---|\n";
    std::string items;
    for (const StabilityRow& row : rows) {
        sheet += markdown(row);
        items += (items.empty() ? "\n " : ",\n ") + json(row);
    }
    write(folder / "stability.md", sheet);
    write(folder / "stability.json", "[" + items + "\n]\n");
}

}  // namespace insonify::study
