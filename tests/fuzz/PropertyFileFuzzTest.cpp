#include <gtest/gtest.h>

#include "components/framework/config/PropertySources.hpp"
#include "tests/support/Fuzz.hpp"

namespace insonify::fuzz {
namespace {

void readProperties(const Input& input) {
    framework::PropertySections sections;
    sections.read(input.file(), "properties.yml");
    sections.read(input.file(), "again.yml");
    const std::vector<std::string> names = sections.names();
    for (const framework::PropertySection* section : sections.inOrder(names))
        EXPECT_TRUE(!section->name.empty() || !sections.diagnostics().empty());
    for (const types::Diagnostic& diagnostic : sections.diagnostics()) expectOurWords(diagnostic.message);
}

TEST(PropertyFileFuzzTest, EveryTextIsSectionsOrDiagnostics) {
    push({"property_file",
          "properties.yml",
          {"--- name:", "--- name:default\n", " merge:false", " chain:", "chain:a,b\n", "<%= 1 %>", "\n", ": ", "[",
           "{", "&a ", "*a", "- ", "\t", "# "},
          readProperties});
}

}  // namespace
}  // namespace insonify::fuzz
