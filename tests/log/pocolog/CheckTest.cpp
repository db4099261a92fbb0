#include <gmock/gmock.h>

#include <cstring>
#include <set>

#include "components/log/Files.hpp"
#include "tests/log/pocolog/SmallLog.hpp"

namespace insonify::log::pocolog {
namespace {

using testing::HasSubstr;

template <class T>
std::vector<char> with(std::vector<char> bytes, uint64_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return bytes;
}

struct CheckTest : testing::Test {
    /** Returns the first wrong byte of a log of these bytes, without an index. */
    Diagnostic wrongIn(const std::vector<char>& bytes) const {
        writeBytes(folder / "x.0.log", bytes);
        const Verdict verdict = check(folder / "x.0.log");
        EXPECT_TRUE(verdict.diagnostic) << "the log was accepted";
        return verdict.diagnostic.value_or(Diagnostic{});
    }
    const Folder folder;
    const std::vector<char> whole = smallLog(folder);
    const std::vector<uint64_t> blocks = sampleBlocks(folder / "whole.0.log");
};

TEST_F(CheckTest, AcceptsTheWritersLogAndIndex) {
    ASSERT_TRUE(std::filesystem::exists(folder / "whole.0.idx"));
    const Verdict verdict = check(folder / "whole.0.log");
    EXPECT_FALSE(verdict.diagnostic) << verdict.diagnostic->message;
    EXPECT_EQ(verdict.streams, 2u);
    EXPECT_EQ(verdict.samples, 5u);
}

TEST_F(CheckTest, NamesTheFirstWrongByteOfThePrologue) {
    for (const uint64_t byte : {0, 3, 7, 8, 11, 12, 15}) {
        const Diagnostic wrong = wrongIn(with(whole, byte, char{'X'}));
        EXPECT_EQ(wrong.byte, byte);
        EXPECT_THAT(wrong.message, HasSubstr("is 0x58 ('X'); in the prologue"));
    }
    EXPECT_THAT(wrongIn(with(whole, 3, char{'X'})).message, HasSubstr("must be 0x4f ('O')"));
    EXPECT_EQ(wrongIn({whole.begin(), whole.begin() + 9}).byte, 9u);
    EXPECT_EQ(wrongIn({}).byte, 0u);
}

TEST_F(CheckTest, NamesTheFirstWrongByteOfABlock) {
    const auto expectWrong = [&](const std::vector<char>& bytes, uint64_t byte, const char* what) {
        const Diagnostic wrong = wrongIn(bytes);
        EXPECT_EQ(wrong.byte, byte) << what;
        EXPECT_THAT(wrong.message, HasSubstr(what));
    };
    const uint64_t block = blocks[3], sample = block + sample_header;
    expectWrong(with(whole, block, char{7}), block, "its type is 7, it may be 1");
    expectWrong(with(whole, block + 2, uint16_t{9}), block + 2, "declared are 2");
    expectWrong(with(whole, block + 4, uint32_t{1} << 30), block + 4, "ends within a block");
    expectWrong(with(whole, block + 8 + 4, 1'000'000u), block + 12, "less than 1000000 us");
    expectWrong(with(whole, block + 8 + 12, 5'000'000u), block + 20, "less than 1000000 us");
    expectWrong(with(whole, block + 8 + 16, 3u), block + 24, "sizes of a sample do not agree");
    expectWrong(with(whole, block + 28, char{2}), block + 28, "the flag may be 0");
    expectWrong(with(whole, sample + 8, uint64_t{1} << 40), sample + 8, "announces 1099511627776 elements");
    expectWrong({whole.begin(), whole.end() - 1}, blocks[4] + 4, "ends within a block");
    expectWrong({whole.begin(), whole.begin() + static_cast<ptrdiff_t>(block) + 5}, block + 5,
                "ends within the header of a block");
}

TEST_F(CheckTest, NamesAPingThatContradictsItself) {
    const uint64_t sample = blocks[1] + sample_header;
    const uint64_t bin_count = sample + 8 + 8 + 3 * 8 + 8 + 2 * 8 + 4;
    EXPECT_THAT(wrongIn(with(whole, bin_count, uint32_t{4})).message, HasSubstr("other numbers of bins"));
}

TEST_F(CheckTest, NamesErrorsInADeclaration) {
    const uint64_t first = sizeof(Prologue);
    EXPECT_EQ(wrongIn(with(whole, first + 2, uint16_t{1})).byte, first + 2);
    EXPECT_THAT(wrongIn(with(whole, first + 2, uint16_t{1})).message, HasSubstr("it must be 0: in order"));
    EXPECT_EQ(wrongIn(with(whole, first + 8, char{2})).byte, first + 8);
    EXPECT_EQ(wrongIn(with(whole, first + 9, uint32_t{1} << 20)).byte, first + 9);
    const auto findByte = [&](const char* text) {
        return static_cast<uint64_t>(std::string_view(whole.data(), whole.size()).find(text));
    };
    EXPECT_THAT(wrongIn(with(whole, findByte("<typelib>"), '[')).message, HasSubstr("must be typelib's XML"));
    const uint64_t metadata = findByte("rock_cxx_type_name");
    EXPECT_EQ(wrongIn(with(whole, metadata, ' ')).byte, findByte("rock_orocos_type_name")) << "where indentation ends";
}

TEST_F(CheckTest, RejectsTimesThatRunBackwards) {
    EXPECT_EQ(wrongIn(with(whole, blocks[3] + 8 + 12, 0u)).byte, blocks[3] + 8 + 8);
    EXPECT_EQ(wrongIn(with(whole, blocks[3] + 8 + 4, 0u)).byte, blocks[3] + 8);
}

TEST_F(CheckTest, RejectsAnIndexOfAnotherLog) {
    std::vector<char> index = toBytes(folder / "whole.0.idx");
    writeBytes(folder / "whole.0.idx", with(index, 25, uint64_t{0}));
    EXPECT_FALSE(check(folder / "whole.0.log").diagnostic) << "copying a log changes its time";
    writeBytes(folder / "whole.0.idx", with(index, index.size() - 1, char{77}));
    const Verdict verdict = check(folder / "whole.0.log");
    ASSERT_TRUE(verdict.diagnostic);
    EXPECT_EQ(verdict.diagnostic->file, folder / "whole.0.idx");
    EXPECT_EQ(verdict.diagnostic->byte, index.size() - 1);
}

TEST_F(CheckTest, RejectsATruncationWithinABlock) {
    const std::set<uint64_t> ends(blocks.begin(), blocks.end());
    for (uint64_t size = blocks[0]; size < whole.size(); ++size) {
        writeBytes(folder / "x.0.log", {whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size)});
        EXPECT_EQ(check(folder / "x.0.log").diagnostic.has_value(), !ends.contains(size)) << size << " bytes";
    }
}

}  // namespace
}  // namespace insonify::log::pocolog
