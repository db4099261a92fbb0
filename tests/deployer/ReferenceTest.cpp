// components/PROPERTIES.md matches the output of `insonify describe`.
#include <gmock/gmock.h>

#include <map>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::IsEmpty;

namespace {

const fs::path root = insonify::test::source_dir;

using Lines = std::vector<std::string>;

/** The page by its sections: the part before the first under "", the others under their headings. */
std::map<std::string, Lines> getSections(const std::string& page) {
    std::map<std::string, Lines> sections;
    std::istringstream lines(page);
    std::string section;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) section = line;
        if (!line.empty()) sections[section].push_back(line);
    }
    return sections;
}

/** Optional tasks of a build. */
bool isOptional(const std::string& section) {
    return section.starts_with("## dds::") || section.starts_with("## gazebo::") || section.starts_with("## viewer::");
}

/** Returns the lines of the first that are missing in the second. */
Lines missingIn(const Lines& lines, const Lines& others) {
    Lines missing = lines;
    std::erase_if(missing, [&](const std::string& line) { return std::ranges::count(others, line) > 0; });
    return missing;
}

}  // namespace

TEST(ReferenceTest, ThePageMatchesDescribe) {
    const TestFolder folder;
    const Outcome made =
        Process({"/usr/bin/python3", root / "scripts/make_reference", insonifyWords({}).front()}, folder.path()).wait();
    ASSERT_EQ(made.code, 0) << made.err;
    const auto now = getSections(made.out), page = getSections(readFile(root / "components/PROPERTIES.md"));
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
