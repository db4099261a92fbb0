#include <gmock/gmock.h>
#include <zlib.h>

#include "components/log/Copy.hpp"
#include "components/log/Files.hpp"
#include "components/log/pocolog/Wire.hpp"
#include "tests/log/pocolog/SmallLog.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::log::pocolog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct CopyTest : testing::Test {
    /** Copies x.0.log to y.0.log, which must be a valid log. */
    Copied copied(const Selection& selection = {}, AtDamage at_damage = AtDamage::Stop) const {
        const Copied result = copyLog({folder / "x.0.log"}, folder / "y.0.log", {at_damage, selection});
        const Verdict verdict = check(folder / "y.0.log");
        EXPECT_FALSE(verdict.diagnostic) << verdict.diagnostic->message;
        EXPECT_EQ(verdict.samples, result.samples);
        return result;
    }
    Copied repaired(const std::vector<char>& bytes) const {
        writeBytes(folder / "x.0.log", bytes);
        return copied({}, AtDamage::Skip);
    }
    std::vector<int64_t> getTimes(const std::string& stream) const {
        std::vector<int64_t> times;
        Reader(folder / "y.0.log").forEachRef(stream, [&](const SampleRef& at) {
            times.push_back(at.time.microseconds);
        });
        return times;
    }
    const Folder folder;
    const std::vector<char> whole = smallLog(folder);
    const std::vector<uint64_t> blocks = sampleBlocks(folder / "whole.0.log");
};

TEST_F(CopyTest, AWholeLogIsCopiedBitForBit) {
    EXPECT_THAT(repaired(whole).lost, IsEmpty());
    EXPECT_EQ(toBytes(folder / "y.0.log"), whole);
}

TEST_F(CopyTest, ASpanOfTimeOrNumbersAndSomeStreamsCanBeCutOut) {
    writeBytes(folder / "x.0.log", whole);
    EXPECT_EQ(copied({.from = {2}, .until = {3}}).samples, 2u);
    EXPECT_THAT(getTimes("sonar.ping"), ElementsAre(2));
    EXPECT_THAT(getTimes("vehicle.pose"), ElementsAre(2));
    EXPECT_EQ(copied({.streams = {"sonar.ping"}, .first = 1, .last = 3}).samples, 2u);
    EXPECT_THAT(getTimes("sonar.ping"), ElementsAre(2, 3));
    EXPECT_EQ(Reader(folder / "y.0.log").streams().size(), 1u);
    EXPECT_EQ(copied({.first = 4}).samples, 1u) << "numbers of all streams together";
    EXPECT_EQ(copied({.from = {100}}).samples, 0u);
}

TEST_F(CopyTest, KeepsSamplesBehindADamagedBlock) {
    std::vector<char> damaged = whole;
    std::fill_n(damaged.begin() + static_cast<ptrdiff_t>(blocks[1]), 20, '\x5a');
    const Copied result = repaired(damaged);
    EXPECT_EQ(result.samples, 4u);
    EXPECT_THAT(getTimes("sonar.ping"), ElementsAre(2, 3));
    ASSERT_EQ(result.lost.size(), 1u);
    EXPECT_THAT(result.lost[0], HasSubstr("bytes " + std::to_string(blocks[1]) + " to " + std::to_string(blocks[2])));
    EXPECT_THAT(result.lost[0], HasSubstr("there is no block"));
}

TEST_F(CopyTest, ALogWithForeignBytesOrWithoutItsEndKeepsAllCompleteSamples) {
    std::vector<char> stray = whole;
    stray.insert(stray.begin() + static_cast<ptrdiff_t>(blocks[2]), {1, 2, 3, 0, 0});
    EXPECT_EQ(repaired(stray).samples, 5u);
    EXPECT_EQ(repaired({whole.begin(), whole.end() - 1}).samples, 4u);
    std::vector<char> zeros = whole;
    zeros.resize(zeros.size() + 4096);
    EXPECT_EQ(repaired(zeros).samples, 5u);
    EXPECT_THAT(repaired(zeros).lost, ElementsAre(HasSubstr("4096 in all")));
}

TEST_F(CopyTest, ADamagedPrologueCostsNoSample) {
    std::vector<char> damaged = whole;
    damaged[2] = 'X';
    EXPECT_EQ(repaired(damaged).samples, 5u);
    EXPECT_EQ(toBytes(folder / "y.0.log"), whole);
}

TEST_F(CopyTest, ADamagedSampleIsOmittedAndReported) {
    std::vector<char> damaged = whole;
    std::fill_n(damaged.begin() + static_cast<ptrdiff_t>(blocks[1] + sample_header + 8), 8, '\x7f');
    const Copied result = repaired(damaged);
    EXPECT_EQ(result.samples, 4u);
    EXPECT_THAT(result.lost, ElementsAre(testing::AllOf(HasSubstr("sonar.ping"), HasSubstr("announces"))));
}

TEST_F(CopyTest, AnyWrongByteOfASampleCostsNoOtherSample) {
    for (size_t byte = blocks[0]; byte < whole.size(); byte += 3) {
        std::vector<char> damaged = whole;
        damaged[byte] = static_cast<char>(~damaged[byte]);
        EXPECT_GE(repaired(damaged).samples, 4u) << "byte " << byte;
    }
}

TEST_F(CopyTest, CompressedSamplesAreDecompressed) {
    const types::Pose pose;
    std::vector<char> sample;
    marshal(pose, sample);
    uLongf size = compressBound(sample.size());
    std::vector<char> packed(size);
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<Bytef*>(sample.data()), sample.size());
    packed.resize(size);
    Writer log(folder / "x.0.log");
    log.write(log.addStream<types::Pose>("vehicle.pose"), {1}, {1}, packed);
    log.close();
    std::vector<char> bytes = toBytes(folder / "x.0.log");
    bytes[sampleBlocks(folder / "x.0.log")[0] + 28] = 1;
    EXPECT_EQ(repaired(bytes).samples, 1u);
    EXPECT_EQ(toBytes(folder / "y.0.log")[sampleBlocks(folder / "y.0.log")[0] + 28], 0) << "the flag";
}

TEST_F(CopyTest, TheFilesOfALogBecomeOne) {
    writeBytes(folder / "x.0.log", whole);
    Writer next(folder / "x.1.log");
    next.write(next.addStream<double>("new.stream"), {4}, 1.5);
    next.write(next.addStream<types::Sonar>("sonar.ping"), {5}, smallPing(5));
    next.close();
    EXPECT_EQ(copyLog({folder / "x.0.log", folder / "x.1.log"}, folder / "y.0.log").samples, 7u);
    EXPECT_FALSE(check(folder / "y.0.log").diagnostic);
    EXPECT_THAT(getTimes("sonar.ping"), ElementsAre(1, 2, 3, 5));
    EXPECT_THAT(getTimes("new.stream"), ElementsAre(4));
}

/** Two streams without samples; a.b has that type. */
void writeStream(const std::filesystem::path& path, const std::string& type, const std::string& registry) {
    Writer log(path);
    log.declare("a.b", type, registry, {});
    log.declare("c.d", "/int32_t", "<typelib/>", {});
    log.flush();
}

TEST_F(CopyTest, StreamsOfOneNameAreNotJoinedWhenTheirTypesOrLayoutsDiffer) {
    const auto message = [&](const std::string& type, const std::string& registry, const Selection& selection) {
        writeStream(folder / "x.0.log", "/double", "<typelib/>");
        writeStream(folder / "x.1.log", type, registry);
        return test::computeError<types::ConfigError>([&] {
            copyLog({folder / "x.0.log", folder / "x.1.log"}, folder / "y.0.log", {.selection = selection});
        });
    };
    EXPECT_THAT(message("/float", "<typelib/>", {}),
                testing::AllOf(HasSubstr("x.1.log"), HasSubstr("a.b: is /float; in the previous log it was /double")));
    EXPECT_THAT(message("/double", "<other/>", {}),
                HasSubstr("a.b: is /double of another layout; in the previous log it was /double"));
    EXPECT_FALSE(std::filesystem::exists(folder / "y.0.log")) << "refused before anything is written";
    EXPECT_EQ(message("/float", "<typelib/>", {.streams = {"c.d"}}), "") << "streams that are not copied may differ";
    EXPECT_EQ(message("/double", "<typelib/>", {}), "");
}

TEST_F(CopyTest, ALogIsNotCopiedOntoItself) {
    EXPECT_THROW(copyLog({folder / "whole.0.log"}, folder / "whole.0.log"), types::ConfigError);
    EXPECT_EQ(toBytes(folder / "whole.0.log"), whole);
    EXPECT_THROW(copyLog({folder / "whole.0.log"}, folder / "y.0.log", {.selection = {.streams = {"no.such"}}}),
                 types::ConfigError);
    writeBytes(folder / "noise.0.log", std::vector<char>(100, 'x'));
    EXPECT_THROW(copyLog({folder / "noise.0.log"}, folder / "y.0.log", {AtDamage::Skip}), types::ConfigError);
}

}  // namespace
}  // namespace insonify::log::pocolog
