#include <gmock/gmock.h>

#include "types/text/Notice.hpp"

namespace insonify::types {
namespace {

TEST(NoticeTest, ATextIsANoteAndOnlyItsFormForLogsSaysTheKind) {
    const Notice note = std::string("bins are empty"), other = warning("bins merge");
    EXPECT_EQ(note.kind, Notice::Kind::Note);
    EXPECT_EQ(other.kind, Notice::Kind::Warning);
    EXPECT_EQ(other.text, "bins merge");
    EXPECT_THAT(lines({note, other, "plain"}), testing::ElementsAre("bins are empty", "Warning: bins merge", "plain"));
}

/** A text that begins like a warning is a note nevertheless. */
TEST(NoticeTest, NoTextMakesAWarning) {
    EXPECT_EQ(Notice("Warning: said by another program").kind, Notice::Kind::Note);
    EXPECT_NE(Notice("bins merge"), warning("bins merge"));
    EXPECT_EQ(Notice("bins merge", Notice::Kind::Warning), warning("bins merge"));
}

}  // namespace
}  // namespace insonify::types
