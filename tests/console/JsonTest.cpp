#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "components/console/Json.hpp"
#include "tests/support/Folder.hpp"

namespace insonify::console {
namespace {

TEST(JsonTest, KeysKeepTheirOrderAndInvalidValuesAreReplaced) {
    const Json json = {{"b", INFINITY}, {"a", std::string("M\xfcll")}};
    EXPECT_EQ(text(json), "{\n  \"b\": null,\n  \"a\": \"M\xef\xbf\xbdll\"\n}");
}

TEST(JsonTest, WritesTheTextToAFileOrThrows) {
    const Folder folder;
    write({{"range", 5}}, folder / "a.json");
    const std::vector<char> bytes = toBytes(folder / "a.json");
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "{\n  \"range\": 5\n}\n");
    EXPECT_THROW(write({}, folder / "none" / "a.json"), std::runtime_error);
}

}  // namespace
}  // namespace insonify::console
