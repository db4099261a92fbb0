// Logs that end too early or have invalid contents.
#include <gmock/gmock.h>

#include <random>

#include "tests/log/pocolog/SmallLog.hpp"
#include "types/samples/Samples.hpp"

namespace insonify::log::pocolog {
namespace {

/** Reads all readable samples; returns the number of pings. */
size_t readAll(const std::filesystem::path& path) {
    Reader reader(path);
    size_t pings = 0;
    types::Sonar ping;
    types::Pose pose;
    for (const SampleRef& at : reader.samples()) try {
            if (reader.streams()[at.stream].holds<types::Sonar>()) {
                reader.read(at, ping);
                ++pings;
            } else
                reader.read(at, pose);
        } catch (const types::ConfigError&) {
            continue;
        }
    return pings;
}

TEST(DamageTest, ALogTruncatedInItsLastBlockKeepsAllEarlierBlocks) {
    Folder folder;
    const std::vector<char> whole = smallLog(folder);
    const uint64_t last = sampleBlocks(folder / "whole.0.log").back();
    for (uint64_t size = last + 1; size < whole.size(); ++size) {
        writeBytes(folder / "cut.0.log", {whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size)});
        Reader reader(folder / "cut.0.log");
        EXPECT_FALSE(reader.complete()) << size << " bytes";
        EXPECT_EQ(reader.samples().size(), 4u) << size << " bytes";
        EXPECT_THAT(reader.diagnostic(), testing::EndsWith("at byte " + std::to_string(last)));
        EXPECT_EQ(readAll(folder / "cut.0.log"), 2u);
    }
    writeBytes(folder / "cut.0.log", {whole.begin(), whole.begin() + static_cast<ptrdiff_t>(last)});
    EXPECT_TRUE(Reader(folder / "cut.0.log").complete()) << "cut between two blocks";
}

TEST(DamageTest, ALogTruncatedAnywhereIsReadUpToThere) {
    Folder folder;
    const std::vector<char> whole = smallLog(folder);
    size_t before = 0;
    for (size_t size = magic.size(); size <= whole.size(); size += size < whole.size() - 5 ? 5 : 1) {
        writeBytes(folder / "cut.0.log", {whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size)});
        const size_t now = Reader(folder / "cut.0.log").samples().size();
        EXPECT_GE(now, before);
        before = now;
    }
    EXPECT_EQ(before, 5u);
}

TEST(DamageTest, ATailOfZerosEndsTheLog) {
    Folder folder;
    std::vector<char> bytes = smallLog(folder);
    bytes.resize(bytes.size() + 4096);
    writeBytes(folder / "zeros.0.log", bytes);
    Reader reader(folder / "zeros.0.log");
    EXPECT_FALSE(reader.complete());
    EXPECT_EQ(reader.samples().size(), 5u);
}

TEST(DamageTest, ABlockWithASizeOfFourGigabytesAllocatesNothing) {
    Folder folder;
    std::vector<char> bytes = smallLog(folder);
    const uint64_t last = sampleBlocks(folder / "whole.0.log").back();
    for (const uint64_t size_field : {last + 4, uint64_t{20}, last + 8 + 16}) {
        std::vector<char> damaged = bytes;
        std::fill_n(damaged.begin() + static_cast<ptrdiff_t>(size_field), 4, '\xff');
        writeBytes(folder / "huge.0.log", damaged);
        Reader reader(folder / "huge.0.log");
        EXPECT_FALSE(reader.complete());
        EXPECT_LE(reader.samples().size(), 4u);
    }
}

TEST(DamageTest, ASampleOfAnUndeclaredStreamEndsTheLog) {
    Folder folder;
    std::vector<char> bytes = smallLog(folder);
    const uint64_t last = sampleBlocks(folder / "whole.0.log").back();
    bytes[last + 2] = 9;
    writeBytes(folder / "stray.0.log", bytes);
    Reader reader(folder / "stray.0.log");
    EXPECT_EQ(reader.samples().size(), 4u);
    EXPECT_THAT(reader.diagnostic(), testing::HasSubstr("not declared"));
}

TEST(DamageTest, AnyWrongByteCausesNoCrash) {
    Folder folder;
    const std::vector<char> whole = smallLog(folder);
    std::mt19937 random(1);
    for (int i = 0; i < 3000; ++i) {
        std::vector<char> damaged = whole;
        for (int k = 0; k < 1 + i % 3; ++k) damaged[16 + random() % (whole.size() - 16)] = static_cast<char>(random());
        writeBytes(folder / "damaged.0.log", damaged);
        EXPECT_LE(readAll(folder / "damaged.0.log"), 3u);
    }
}

}  // namespace
}  // namespace insonify::log::pocolog
