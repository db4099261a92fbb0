// components/PROPERTIES.md is what `insonify describe` says now.
#include <gmock/gmock.h>

#include <map>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::IsEmpty;

namespace {

const fs::path root = insonify::test::source_dir;

using Lines = std::vector<std::string>;

/** The page by its sections: what stands before the first under "", each one under its heading. */
std::map<std::string, Lines> sectionsOf(const std::string& page) {
    std::map<std::string, Lines> sections;
    std::istringstream lines(page);
    std::string section;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) section = line;
        if (!line.empty()) sections[section].push_back(line);
    }
    return sections;
}

/** Tasks that a build may be without. */
bool isOptional(const std::string& section) {
    return section.starts_with("## dds::") || section.starts_with("## gazebo::") || section.starts_with("## viewer::");
}

/** Lines of the first that the second has not. */
Lines missingIn(const Lines& lines, const Lines& others) {
    Lines missing = lines;
    std::erase_if(missing, [&](const std::string& line) { return std::ranges::count(others, line) > 0; });
    return missing;
}

}  // namespace

TEST(ReferenceTest, ThePageSaysOfEachTaskWhatDescribeSaysNow) {
    const TestFolder folder;
    const Outcome made =
        Process({"/usr/bin/python3", root / "scripts/make_reference", insonifyWords({}).front()}, folder.path()).wait();
    ASSERT_EQ(made.code, 0) << made.err;
    const auto now = sectionsOf(made.out), page = sectionsOf(readFile(root / "components/PROPERTIES.md"));
    const std::string remedy = ": scripts/make_reference > components/PROPERTIES.md";
    for (const auto& [section, lines] : now) {
        if (section.empty() && now.size() != page.size()) continue;  // a list of the sections
        ASSERT_TRUE(page.contains(section)) << section << remedy;
        EXPECT_THAT(missingIn(lines, page.at(section)), IsEmpty()) << "not in the page" << remedy;
        EXPECT_THAT(missingIn(page.at(section), lines), IsEmpty()) << "no more" << remedy;
    }
    for (const auto& [section, lines] : page)
        EXPECT_TRUE(now.contains(section) || isOptional(section)) << section << remedy;
}
