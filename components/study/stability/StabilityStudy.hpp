#pragma once
// The cases of ACOUSTICS.md 11, one file for each group.
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace insonify::study {

enum class Verdict { Pass, Fail, NotRun };
/** Returns "pass"; "fail"; "not run": this machine lacks a requirement. */
const char* getName(Verdict verdict);

/** Condition numbers of a case, by name. */
using Conditions = std::vector<std::pair<std::string, double>>;

/** The result of a case. */
struct Outcome {
    Conditions conditions;
    std::string got;
    double deviation = 0;  ///< From the expected value, relative unless `got` names a unit [1].
    Verdict verdict = Verdict::NotRun;
};

/** Returns whether the case was run and has a deviation. */
bool isEvaluated(const Outcome& outcome);

/** A stiff or extreme case of ACOUSTICS.md 11. */
struct StabilityCase {
    int number;
    std::string name, expected;
    std::function<Outcome()> run;
};

/** Returns every case that has a measured value; cases that only pass or fail are tests. */
std::vector<StabilityCase> stabilityCases();

// The groups, one file each.
std::vector<StabilityCase> precisionCases();  ///< Ranges, world offsets, grazing: 1 to 4, 7, 13 to 16, 60.
std::vector<StabilityCase> geometryCases();   ///< Odd geometry: 5, 6, 12, 17, 56.
std::vector<StabilityCase> sensorCases();     ///< Fans, bins, beam patterns, pulses: 21, 23 to 25, 27, 30, 31, 59.
std::vector<StabilityCase> levelCases();      ///< Dynamic range: 32, 33, 35, 36, 38 to 40.
std::vector<StabilityCase> sumCases();        ///< Sums, devices, sizes: 41, 44, 55, 58.
std::vector<StabilityCase> targetCases();     ///< Target strengths of smooth bodies: 61.
std::vector<StabilityCase> noiseCases();      ///< Seeds and shapes of speckle: 47, 48.

/** A case with its outcome. */
struct StabilityRow {
    int number;
    std::string name, expected;
    Outcome outcome;
};

/** Runs a case; a case that throws has failed. */
StabilityRow runCase(const StabilityCase& stability_case);
/** Runs all cases in the order of their numbers; calls `done` after each. */
std::vector<StabilityRow> studyStability(std::vector<StabilityCase> cases,
                                         const std::function<void(const StabilityRow&)>& done);

/** Returns "78 pass, 0 fail, 1 not run". */
std::string tally(const std::vector<StabilityRow>& rows);

/** Writes `stability.md`, a readable sheet, and `stability.json`, [{case, conditions: {}, expected, got, deviation,
 *  verdict}], to an existing folder. Throws std::runtime_error if a file cannot be written. */
void writeStability(const std::vector<StabilityRow>& rows, const std::filesystem::path& folder);

}  // namespace insonify::study
