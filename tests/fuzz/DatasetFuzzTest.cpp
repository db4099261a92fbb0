#include <gtest/gtest.h>

#include <fstream>

#include "components/dataset/Collection.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

/** Joins a folder whose description has these values, with a right sum where they are JSON. */
void joinParts(const Input& input) try {
    const Folder folder;
    dataset::Json json = console::readJson(input.bytes());
    if (json.is_object()) json.erase("sum");
    std::ofstream(folder / dataset::description_file) << (json.is_object() ? dataset::signedText(json) : input.bytes());
    const bool has_version = json.is_object() && json.contains("version") && json["version"].is_string();
    const dataset::Parts parts({folder.path()}, has_version ? json["version"].get<std::string>() : "1");
    ADD_FAILURE() << "a set without samples";
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

TEST(DatasetFuzzTest, EveryDescriptionOfASetIsRead) {
    push({"dataset",
          "dataset.json",
          {"\"version\":", "\"0.1.0\"", "\"members\":", "\"count\":", "\"total\":", "\"seed\":", "\"format\":",
           "18446744073709551615", "-1", "1e99", "null", "[]", "{}", "[[[[[[[[[[", "\xff", "\\u0000"},
          joinParts});
}

}  // namespace
}  // namespace insonify::fuzz
