#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace insonify::study {

enum class Verdict { Pass, Fail, NotRun };
/** "pass"; "fail"; "not run": this machine lacks what it needs. */
const char* nameOf(Verdict verdict);

/** Condition numbers of a case, by name. */
using Conditions = std::vector<std::pair<std::string, double>>;

/** What came out of a case. */
struct Outcome {
    Conditions conditions;
    std::string got;
    double deviation = 0;  ///< From what is expected, relative unless `got` names a unit [1].
    Verdict verdict = Verdict::NotRun;
};

/** Whether it was run and has a deviation. */
bool isJudged(const Outcome& outcome);

/** A stiff or extreme case of ACOUSTICS.md 11. */
struct StabilityCase {
    int number;
    std::string name, expected;
    std::function<Outcome()> run;
};

/** Every case that has a figure to tell; those that only hold or do not are tests. */
std::vector<StabilityCase> stabilityCases();

/** A case with its outcome. */
struct StabilityRow {
    int number;
    std::string name, expected;
    Outcome outcome;
};

/** Runs a case; one that throws has failed. */
StabilityRow runCase(const StabilityCase& stability_case);
/** Runs all of them in the order of their numbers; `done` hears of each. */
std::vector<StabilityRow> studyStability(std::vector<StabilityCase> cases,
                                         const std::function<void(const StabilityRow&)>& done);

/** "78 pass, 0 fail, 1 not run". */
std::string tally(const std::vector<StabilityRow>& rows);

/** Writes `stability.md`, a sheet to read, and `stability.json`, [{case, conditions: {}, expected, got, deviation,
 *  verdict}], into a folder that exists. Throws std::runtime_error when they cannot be written. */
void writeStability(const std::vector<StabilityRow>& rows, const std::filesystem::path& folder);

}  // namespace insonify::study
