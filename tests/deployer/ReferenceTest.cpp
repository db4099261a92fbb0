// components/PROPERTIES.md is what `insonify describe` says now.
#include <gmock/gmock.h>

#include <map>

#include "tests/deployer/Command.hpp"

using namespace insonify::deployer;

namespace {

const fs::path root = INSONIFY_SOURCE_DIR;

/** The page by its sections: what stands before the first, and each one after its heading. */
std::map<std::string, std::string> sectionsOf(const std::string& page) {
    std::map<std::string, std::string> sections;
    std::istringstream lines(page);
    std::string section;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) section = line;
        sections[section] += line + "\n";
    }
    return sections;
}

/** Tasks that a build may be without. */
bool isOptional(const std::string& section) {
    return section.starts_with("## dds::") || section.starts_with("## viewer::");
}

}  // namespace

TEST(ReferenceTest, ThePageSaysOfEachTaskWhatDescribeSaysNow) {
    const TestFolder folder;
    const Outcome made =
        Process({"/usr/bin/python3", root / "scripts/make_reference", insonifyWords({}).front()}, folder.path()).wait();
    ASSERT_EQ(made.code, 0) << made.err;
    const auto now = sectionsOf(made.out), page = sectionsOf(readFile(root / "components/PROPERTIES.md"));
    const std::string remedy = ": scripts/make_reference > components/PROPERTIES.md";
    for (const auto& [section, text] : now) {
        if (section.empty()) continue;  // a list of the sections, and what is the same in every build
        ASSERT_TRUE(page.contains(section)) << section << remedy;
        EXPECT_EQ(page.at(section), text) << remedy;
    }
    for (const auto& [section, text] : page)
        EXPECT_TRUE(now.contains(section) || isOptional(section)) << section << remedy;
    if (now.size() == page.size()) {
        EXPECT_EQ(page.at(""), now.at("")) << remedy;
    }
}
