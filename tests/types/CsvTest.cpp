#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "tests/support/Folder.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Csv.hpp"

namespace insonify::types {
namespace {

using ::testing::ElementsAre;

const std::vector<CsvColumn> columns{{"time"}, {"level_db", -10, 0}};

std::vector<std::vector<double>> getRows(const std::string& text, size_t minimum = 1,
                                         const CsvValidator& validate = {}) {
    const Folder folder;
    std::ofstream(folder / "a.csv", std::ios::binary) << text;
    return readCsv(folder / "a.csv", columns, minimum, validate);
}

/** Returns "line:column: path: message" of each diagnostic. */
std::vector<std::string> findDiagnostics(const std::string& text, size_t minimum = 1,
                                         const CsvValidator& validate = {}) {
    std::vector<std::string> diagnostics;
    try {
        getRows(text, minimum, validate);
    } catch (const ConfigError& error) {
        for (Diagnostic diagnostic : error.diagnostics()) {
            diagnostic.file.clear();
            diagnostics.push_back(std::to_string(diagnostic.line) + ":" + std::to_string(diagnostic.column) + ": " +
                                  diagnostic.path + ": " + diagnostic.message);
        }
    }
    return diagnostics;
}

TEST(CsvTest, RowsAreNumbersWithAnySpacing) {
    EXPECT_THAT(getRows("\xEF\xBB\xBFtime,level_db\r\n0,-1\r\n\r\n 1.5 ,-2e0"),
                ElementsAre(ElementsAre(0, -1), ElementsAre(1.5, -2)));
}

TEST(CsvTest, ColumnsMayBeInAnyOrderAmongOthers) {
    EXPECT_THAT(getRows(" level_db , note, \"time\"\n -1, not used, +2\n-3,,4\n"),
                ElementsAre(ElementsAre(2, -1), ElementsAre(4, -3)));
    EXPECT_THAT(
        findDiagnostics("x,level_db,time\n0,0\n0,9,0\n0,0,+-1\n0,0,0,0\n"),
        ElementsAre("2:4: time: is missing; a line has 3 fields",
                    "3:3: level_db: is '9'; it must be a number from -10 to 0",
                    "4:5: time: is '+-1'; it must be a finite number", "5:7: : has too many fields; a line has 3"));
    EXPECT_THAT(findDiagnostics("time,time,level_db\n0,0,0\n"),
                ElementsAre("1:1: : is 'time,time,level_db'; the header must have time,level_db"));
    EXPECT_THAT(findDiagnostics("time [ms],level_db\n0,0\n"),
                ElementsAre("1:1: : is 'time [ms],level_db'; the header must have time,level_db"));
    std::mt19937 engine(1);
    for (int draw = 0; draw < 100; ++draw) {
        std::vector<std::string> names{"time", "level_db", "a", "b", "c"};
        std::ranges::shuffle(names, engine);
        std::string header, row;
        for (const std::string& name : names) {
            header += (header.empty() ? "" : ",") + name;
            row += (row.empty() ? "" : ",") + std::string(name == "time" ? "7" : name == "level_db" ? "-7" : "x");
        }
        EXPECT_THAT(getRows(header + "\n" + row), ElementsAre(ElementsAre(7, -7))) << header;
    }
}

TEST(CsvTest, ReportsErrorsWithTheirPlace) {
    EXPECT_THAT(
        findDiagnostics("time,level_db\n0,-1\n1\n2,-3,4\nnan,5\n"),
        ElementsAre("3:2: level_db: is missing; a line has 2 fields", "4:6: : has too many fields; a line has 2",
                    "5:1: time: is 'nan'; it must be a finite number",
                    "5:5: level_db: is '5'; it must be a number from -10 to 0"));
    EXPECT_THAT(findDiagnostics(""), ElementsAre("0:1: : is empty; it must start with the header time,level_db"));
    EXPECT_THAT(findDiagnostics("t,level\n0,0\n"),
                ElementsAre("1:1: : is 't,level'; the header must have time,level_db"));
    EXPECT_THAT(findDiagnostics("time\n0\n1\n"), ElementsAre("1:1: : is 'time'; the header must have time,level_db"));
    EXPECT_THAT(findDiagnostics("time,level_db\n0,0\n", 2),
                ElementsAre("2:1: : has 1 lines after its header; it needs at least 2"));
    EXPECT_THAT(findDiagnostics(std::string("\xff\xfet\0", 4)),
                ElementsAre("0:0: : is text in UTF-16; save it as UTF-8"));
    EXPECT_THROW(readCsv("nowhere.csv", columns, 1), ConfigError);
    EXPECT_THROW(readCsv(".", columns, 1), ConfigError);
}

TEST(CsvTest, AMissingFileIsReportedWithANearName) {
    const Folder folder;
    std::ofstream(folder / "pass.csv") << "time,level_db\n0,0\n";
    try {
        readCsv(folder / "pas.csv", columns, 1);
        FAIL() << "no error";
    } catch (const ConfigError& error) {
        ASSERT_EQ(error.diagnostics().size(), 1u);
        EXPECT_EQ(error.diagnostics()[0].message,
                  "does not exist; did you mean pass.csv? must be a CSV file with header time,level_db");
    }
}

TEST(CsvTest, TheCheckGetsEachRowAndThePreviousRow) {
    const CsvValidator ascends = [](const std::vector<double>& row, const std::vector<double>* before) {
        return before && row[0] <= before->front() ? std::vector<CsvDiagnostic>{{0, "must increase"}}
                                                   : std::vector<CsvDiagnostic>{};
    };
    EXPECT_THAT(findDiagnostics("time,level_db\n1,0\n2,0\n2,0\nx,0\n 1,0\n", 1, ascends),
                ElementsAre("4:1: time: must increase", "5:1: time: is 'x'; it must be a finite number",
                            "6:1: time: must increase"));
}

}  // namespace
}  // namespace insonify::types
