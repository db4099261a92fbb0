#include <gtest/gtest.h>

#include "components/log/pocolog/Reader.hpp"

namespace insonify::log::pocolog {
namespace {

TEST(MetadataTest, IsAFlatMapOfQuotedScalarsOneALine) {
    EXPECT_EQ(toYaml({{"rock_task_name", "sonar"}, {"text", "a: \"b\"\n\\c\t"}}),
              "rock_task_name: \"sonar\"\ntext: \"a: \\\"b\\\"\\n\\\\c\\x09\"\n");
}

TEST(MetadataTest, ADeploymentOfManyLinesIsReadBack) {
    const Metadata sent{{"insonify_deployment", "# a 'b' \"c\"\ntasks:\n  kai: {mauer: \"h\xc3\xb6he\", x: \\n}\n\x01"},
                        {"insonify_seed", "18446744073709551615"},
                        {"empty", ""}};
    EXPECT_EQ(metadataFromYaml(toYaml(sent)), sent);
}

TEST(MetadataTest, RocksWaysOfWritingScalarsAreRead) {
    const Metadata got = metadataFromYaml("---\nrock_task_name: sonar\nrock_stream_type: 'port'\n\"key\": \"a b\"\r\n");
    EXPECT_EQ(got, (Metadata{{"rock_task_name", "sonar"}, {"rock_stream_type", "port"}, {"key", "a b"}}));
}

TEST(MetadataTest, IgnoresTextsThatAreNotAMap) {
    EXPECT_TRUE(metadataFromYaml("").empty());
    EXPECT_TRUE(metadataFromYaml("--- {}\n").empty());
    EXPECT_TRUE(metadataFromYaml("- a\n- \"\\x\n").empty());
}

TEST(MetadataTest, ValuesAreScalarsNotMapsOrLists) {
    for (const char* flat : {"", "--- {}\n", "---\na: b\n...\n", "a:\nb: c\n", "a: long\n  folded\nb: c",
                             "a: |\n  x: y\n  - z\n", "a: \"long\n  x: folded\"\nb: 'c'\n"})
        EXPECT_EQ(findNotFlat(flat), std::nullopt) << flat;
    EXPECT_EQ(findNotFlat("a: b\n- c\n"), 5u);
    EXPECT_EQ(findNotFlat("a:\n  b: c\n"), 5u);
    EXPECT_EQ(findNotFlat("a:\n- b\n"), 3u);
    EXPECT_EQ(findNotFlat("a: b\n  c: d\n"), 8u);
    EXPECT_EQ(findNotFlat("a: \"b\"\n c: d\n"), 8u);
    EXPECT_EQ(findNotFlat("x: y\na: {b: c}\n"), 8u);
    EXPECT_EQ(findNotFlat("a: [1, 2]\n"), 3u);
    EXPECT_EQ(findNotFlat("nonsense\n"), 0u);
    EXPECT_EQ(findNotFlat("\xc3\xb6: [1]\n"), 4u) << "bytes, not characters";
    EXPECT_EQ(findNotFlat("a: x: y\n"), 4u);
}

}  // namespace
}  // namespace insonify::log::pocolog
