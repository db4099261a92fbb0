// Cutting and repairing of MCAP files.
#include <gmock/gmock.h>

#include "components/log/Files.hpp"
#include "tests/log/mcap/SmallFile.hpp"

namespace insonify::log::mcap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/** A record from a place on: its kind, begin and end [B]. */
struct Place {
    Op op;
    uint64_t from, to;
};
std::vector<Place> recordsIn(const std::vector<char>& bytes) {
    std::vector<Place> places;
    for (uint64_t at = magic.size(); at + magic.size() < bytes.size();) {
        uint64_t length = 0;
        std::memcpy(&length, bytes.data() + at + 1, sizeof length);
        places.push_back({static_cast<Op>(bytes[at]), at, at + record_header_size + length});
        at = places.back().to;
    }
    return places;
}

struct CopyTest : testing::Test {
    CopyTest() {
        SampleWriter log(folder / "whole.0.mcap", {});
        const size_t ping = log.addStream<types::Sonar>("sonar.ping", {{"insonify_seed", "7"}});
        const size_t pose = log.addStream<types::Pose>("vehicle.pose", {{"insonify_seed", "7"}});
        for (int64_t i = 1; i <= 3; ++i) {
            log.write(pose, {i}, smallPose(i));
            log.write(ping, {i}, smallPing(i));
            log.flush();  // one chunk each
        }
        log.close();
        whole = toBytes(folder / "whole.0.mcap");
        for (const Place& place : recordsIn(whole))
            if (place.op == Op::Chunk) chunks.push_back(place);
    }
    /** Copies the intact parts of these bytes to bag/y.0.mcap, which must be valid, with an index. */
    Copied repaired(const std::vector<char>& bytes) const {
        writeBytes(folder / "x.0.mcap", bytes);
        std::filesystem::remove_all(folder / "bag");
        std::filesystem::create_directory(folder / "bag");
        const Copied result = copyLog({folder / "x.0.mcap"}, copy(), {AtDamage::Skip});
        const Verdict verdict = check(copy());
        EXPECT_FALSE(verdict.diagnostic) << verdict.diagnostic->message;
        EXPECT_EQ(verdict.samples, result.samples);
        return result;
    }
    std::filesystem::path copy() const { return folder / "bag/y.0.mcap"; }
    std::vector<int64_t> pings() const {
        std::vector<int64_t> times;
        const auto log = openLog(copy());
        log->forEach<types::Sonar>("sonar.ping", [&](const types::Sonar& ping, const SampleRef& at) {
            EXPECT_EQ(ping.time, at.time);
            times.push_back(at.time.microseconds);
        });
        return times;
    }

    const Folder folder;
    std::vector<char> whole;
    std::vector<Place> chunks;
};

TEST_F(CopyTest, AWholeFileIsCopiedMessageForMessage) {
    ASSERT_EQ(chunks.size(), 3u);
    EXPECT_THAT(repaired(whole).lost, IsEmpty());
    const auto before = openLog(folder / "whole.0.mcap"), after = openLog(copy());
    ASSERT_EQ(after->samples().size(), 6u);
    for (size_t i = 0; i < 6; ++i) {
        const auto a = before->toBytes(before->samples()[i]), b = after->toBytes(after->samples()[i]);
        EXPECT_TRUE(std::ranges::equal(a, b)) << i;
        EXPECT_EQ(before->samples()[i].received, after->samples()[i].received);
    }
    EXPECT_EQ(after->streams()[0].metadatum("insonify_seed"), "7");
    EXPECT_EQ(after->layout(0), before->layout(0));
    EXPECT_TRUE(std::filesystem::exists(folder / "bag/metadata.yaml"));
}

TEST_F(CopyTest, ASpanOfTimeAndSomeStreamsCanBeCutOut) {
    std::filesystem::create_directory(folder / "bag");
    const Selection wanted{.streams = {"sonar.ping"}, .from = {2}, .until = {3}};
    EXPECT_EQ(copyLog({folder / "whole.0.mcap"}, copy(), {.selection = wanted}).samples, 1u);
    EXPECT_THAT(pings(), ElementsAre(2));
    EXPECT_EQ(openLog(copy())->streams().size(), 1u);
    EXPECT_FALSE(check(copy()).diagnostic);
}

TEST_F(CopyTest, TheFilesOfALogBecomeOneAndAnotherFormatToo) {
    std::filesystem::create_directory(folder / "bag");
    std::filesystem::create_directory(folder / "next");
    smallFile(folder / "next/x.0.mcap");
    EXPECT_EQ(copyLog({folder / "whole.0.mcap", folder / "next/x.0.mcap"}, copy()).samples, 11u);
    EXPECT_FALSE(check(copy()).diagnostic);
    EXPECT_EQ(copyLog({copy()}, folder / "z.0.log").samples, 11u);
    EXPECT_FALSE(check(folder / "z.0.log").diagnostic);
}

TEST_F(CopyTest, ATruncatedFileKeepsItsCompleteMessages) {
    EXPECT_EQ(repaired({whole.begin(), whole.begin() + static_cast<ptrdiff_t>(chunks[2].from)}).samples, 4u);
    EXPECT_THAT(pings(), ElementsAre(1, 2));
    const Copied within = repaired({whole.begin(), whole.begin() + static_cast<ptrdiff_t>(chunks[2].to - 1)});
    EXPECT_EQ(within.samples, 5u) << "the pose is complete in the rest of the last chunk";
    EXPECT_THAT(within.lost, testing::Not(IsEmpty()));
    EXPECT_THAT(pings(), ElementsAre(1, 2));
}

TEST_F(CopyTest, AFileTruncatedAnywhereIsRepairedOrRefused) {
    size_t maximum = 0;
    for (size_t size = 0; size < whole.size(); size += 41) try {
            const size_t samples = repaired({whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size)}).samples;
            EXPECT_GE(samples, maximum) << size;
            maximum = samples;
        } catch (const types::ConfigError&) {
            EXPECT_LT(size, chunks[0].to) << "no channel is declared yet";
        }
    EXPECT_EQ(maximum, 6u);
}

TEST_F(CopyTest, AChunkWithAWrongChecksumIsOmittedAndReported) {
    std::vector<char> damaged = whole;
    damaged[chunks[1].to - 3] ^= 0x41;
    const Copied result = repaired(damaged);
    EXPECT_THAT(pings(), ElementsAre(1, 3));
    EXPECT_THAT(result.lost, ElementsAre(testing::AllOf(HasSubstr("the checksum of a chunk is"),
                                                        HasSubstr("bytes " + std::to_string(chunks[1].from) + " to " +
                                                                  std::to_string(chunks[1].to)))));
}

TEST_F(CopyTest, ALostFirstChunkDoesNotLoseTheDeclarations) {
    std::vector<char> damaged = whole;
    damaged[chunks[0].to - 3] ^= 0x41;
    EXPECT_EQ(repaired(damaged).samples, 4u);
    EXPECT_THAT(pings(), ElementsAre(2, 3));
    EXPECT_EQ(openLog(copy())->streams()[0].name, "sonar.ping");
}

TEST_F(CopyTest, AMissingIndexCostsNoMessage) {
    const auto places = recordsIn(whole);
    const auto end = std::ranges::find(places, Op::DataEnd, &Place::op);
    const Copied no_summary = repaired({whole.begin(), whole.begin() + static_cast<ptrdiff_t>(end->from)});
    EXPECT_EQ(no_summary.samples, 6u);
    EXPECT_THAT(no_summary.lost, ElementsAre(HasSubstr("without a footer")));
    std::vector<char> no_index = whole;
    for (auto place = places.rbegin(); place != places.rend(); ++place)
        if (place->op == Op::MessageIndex)
            no_index.erase(no_index.begin() + static_cast<ptrdiff_t>(place->from),
                           no_index.begin() + static_cast<ptrdiff_t>(place->to));
    EXPECT_EQ(repaired(no_index).samples, 6u);
}

TEST_F(CopyTest, SearchesBehindADamagedLengthOrForeignBytes) {
    std::vector<char> damaged = whole;
    damaged[chunks[1].from + 5] = 0x7f;
    EXPECT_EQ(repaired(damaged).samples, 6u) << "its messages are complete behind its header";
    std::vector<char> stray = whole;
    stray.insert(stray.begin() + static_cast<ptrdiff_t>(chunks[1].from), {1, 2, 3, 0, 0});
    EXPECT_EQ(repaired(stray).samples, 6u);
    std::vector<char> unknown = whole;
    unknown[chunks[1].from] = 0x55;
    EXPECT_EQ(repaired(unknown).samples, 6u);
    EXPECT_THAT(repaired(unknown).lost, testing::Contains(HasSubstr("a record of kind 85 is not known")));
    std::vector<char> begins = whole;
    begins[2] = 'x';
    EXPECT_EQ(repaired(begins).samples, 6u);
}

TEST_F(CopyTest, AnyWrongByteCostsAtMostItsChunk) {
    for (size_t byte = 0; byte < whole.size(); byte += 23) {
        std::vector<char> damaged = whole;
        damaged[byte] = static_cast<char>(~damaged[byte]);
        EXPECT_GE(repaired(damaged).samples, 4u) << "byte " << byte;
    }
}

TEST_F(CopyTest, RefusesEmptyFiles) {
    EXPECT_THROW(repaired(std::vector<char>(500, 'x')), types::ConfigError);
    EXPECT_THROW(repaired({}), types::ConfigError);
    EXPECT_THROW(copyLog({folder / "whole.0.mcap"}, folder / "whole.0.mcap"), types::ConfigError);
}

}  // namespace
}  // namespace insonify::log::mcap
