// Truncated, changed and invalid MCAP files.
#include <gmock/gmock.h>

#include <random>

#include "components/log/mcap/Contents.hpp"
#include "tests/log/mcap/SmallFile.hpp"

namespace insonify::log::mcap {
namespace {

struct DamageTest : testing::Test {
    /** Reads all readable samples of a file; returns their number. Only ConfigError may be thrown. */
    size_t readAll(const std::vector<char>& bytes) {
        writeBytes(path_, bytes);
        const auto log = openLog(path_);
        for (const SampleRef& at : log->samples()) log->verify(at);
        return log->samples().size();
    }
    std::string getVerdict(const std::vector<char>& bytes) {
        writeBytes(path_, bytes);
        return verdict();
    }
    std::string verdict() {
        try {
            const Verdict verdict = log::check(path_);
            return verdict.diagnostic
                       ? "byte " + std::to_string(verdict.diagnostic->byte) + ": " + verdict.diagnostic->message
                       : "";
        } catch (const types::ConfigError& error) {
            return error.what();
        }
    }

    /** Changes one byte of the file. */
    void poke(size_t at, char value) {
        std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(at)).put(value);
    }

    const Folder folder_;
    const std::vector<char> whole_ = smallFile(folder_ / "whole.mcap");
    const std::filesystem::path path_ = folder_ / "damaged.mcap";
};

TEST_F(DamageTest, AWholeFileIsValid) {
    EXPECT_EQ(getVerdict(whole_), "");
    EXPECT_EQ(readAll(whole_), 5u);
}

TEST_F(DamageTest, AFileTruncatedAnywhereKeepsItsCompleteChunksAndIsIncomplete) {
    size_t with_samples = 0;
    writeBytes(path_, whole_);
    for (size_t size = whole_.size(); size-- > 0;) {
        std::filesystem::resize_file(path_, size);
        if (size < magic.size()) {
            EXPECT_THROW(openLog(path_), types::ConfigError) << size;
            continue;
        }
        const auto log = openLog(path_);
        EXPECT_FALSE(log->complete()) << size;
        const size_t samples = log->samples().size();
        EXPECT_TRUE(samples == 0 || samples == 5) << size;
        for (const SampleRef& at : log->samples()) log->verify(at);
        with_samples += samples == 5;
    }
    EXPECT_GT(with_samples, whole_.size() / 3);
}

TEST_F(DamageTest, FlushedMessagesSurviveTheWriter) {
    SampleWriter log(folder_ / "whole.mcap", {});
    const size_t stream = log.addStream<double>("a.b", {});
    log.write(stream, {1}, 0.5);
    log.flush();
    log.write(stream, {2}, 0.75);
    const auto seen = openLog(folder_ / "whole.mcap");
    EXPECT_EQ(seen->samples().size(), 1u);
    EXPECT_FALSE(seen->complete());
    EXPECT_THAT(seen->diagnostic(), testing::StartsWith("the file ends here, without a footer at byte "));
}

TEST_F(DamageTest, EveryChangedByteIsFound) {
    writeBytes(path_, whole_);
    for (size_t at = 0; at < whole_.size(); ++at) {
        poke(at, static_cast<char>(whole_[at] ^ 0x41));
        EXPECT_NE(verdict(), "") << at;
        poke(at, whole_[at]);
    }
    EXPECT_EQ(verdict(), "");
}

TEST_F(DamageTest, RandomChangesNeverHarm) {
    std::mt19937 random(1);
    writeBytes(path_, whole_);
    for (int round = 0; round < 2000; ++round) {
        std::vector<size_t> places;
        for (int change = 0; change < 1 + round % 8; ++change) {
            places.push_back(random() % whole_.size());
            poke(places.back(), static_cast<char>(random()));
        }
        try {
            const auto log = openLog(path_);
            for (const SampleRef& at : log->samples()) log->verify(at);
        } catch (const types::ConfigError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr("damaged.mcap"));
        }
        for (const size_t place : places) poke(place, whole_[place]);
    }
}

TEST_F(DamageTest, TheFirstWrongByteIsNamed) {
    std::vector<char> changed = whole_;
    changed.at(changed.size() - 1) = 'x';
    EXPECT_EQ(getVerdict(changed),
              "byte " + std::to_string(whole_.size() - 8) + ": the file does not end as an MCAP file");
    changed = whole_;
    changed.at(8) = 2;
    EXPECT_EQ(getVerdict(changed), "byte 8: the first record is no header");
    changed = whole_;
    changed.resize(changed.size() + 1);
    EXPECT_EQ(getVerdict(changed), "byte " + std::to_string(whole_.size()) + ": the file continues after its end");
}

TEST_F(DamageTest, RefusesOtherFiles) {
    EXPECT_THAT(getVerdict({'x', 'y'}), testing::EndsWith("damaged.mcap: is no MCAP file"));
    EXPECT_THROW(openLog(folder_ / "none.mcap"), types::ConfigError);
}

/** A few bytes may be a gigabyte, which a vehicle does not have. */
TEST_F(DamageTest, AChunkThatWouldGrowBeyondItsLimitIsNotDecompressed) {
    for (const char* compression : {"zstd", "lz4"}) {
        ChunkInfo chunk;
        chunk.start = 7;
        chunk.compression = compression;
        chunk.size = (uint64_t{256} << 20) + 1;
        std::vector<char> room;
        const std::vector<char> stored(64);
        EXPECT_THAT([&] { getRecords(chunk, stored, room); },
                    testing::ThrowsMessage<FormatError>(testing::HasSubstr("more than 256 MiB is not read")));
        EXPECT_EQ(room.capacity(), 0u);
        chunk.size = 1000;
        EXPECT_THAT([&] { getRecords(chunk, stored, room); },
                    testing::ThrowsMessage<FormatError>(testing::HasSubstr("cannot be decompressed")));
    }
}

}  // namespace
}  // namespace insonify::log::mcap
