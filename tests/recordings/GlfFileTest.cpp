// Reading of .glf files of a Gemini, made here by their layout, intact and damaged.
#include <zlib.h>

#include <cmath>

#include "components/recordings/GlfFile.hpp"
#include "tests/recordings/RecordedFileTest.hpp"
#include "tests/support/GlfRecording.hpp"

namespace insonify::recordings {
namespace {

using test::glfFile, test::GlfImage, test::glfLog, test::glfRecord, test::joinedBytes, test::putAt, test::zipped;
using testing::ElementsAre, testing::HasSubstr, testing::SizeIs;

RecordedBytes packedByZlib(const RecordedBytes& bytes) {
    uLongf size = compressBound(bytes.size());
    RecordedBytes packed(size);
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             bytes.size());
    packed.resize(size);
    return packed;
}

/** Deflates as in archives: without zlib's header. @param level 0: blocks that are not packed, as in the maker's
 *  files */
RecordedBytes deflateBytes(RecordedBytes bytes, int level) {
    z_stream stream{};
    deflateInit2(&stream, level, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    RecordedBytes packed(deflateBound(&stream, bytes.size()) + 64);
    stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

/** Three beams from port, two ranges: 1 2 3, 4 5 6. */
GlfImage smallImage(double after_s = 0) {
    GlfImage image{.end_range = 2};
    image.time_s += after_s;
    image.bearings = {0.5, 0.1, -0.6};
    image.packed = {1, 2, 3, 4, 5, 6};
    return image;
}

struct GlfFileTest : RecordedFileTest {
    GlfFileTest() : RecordedFileTest("dive.glf") {}
};

TEST_F(GlfFileTest, OrdersBeamsFromStarboardWithTheirBearings) {
    const RecordedPing read = this->read(glfFile({glfRecord(smallImage())})).at(0);
    EXPECT_THAT(read.ping.bins, ElementsAre(3, 6, 2, 5, 1, 4));
    EXPECT_DOUBLE_EQ(read.ping.bearings[0].rad, -0.6);
    EXPECT_DOUBLE_EQ(read.ping.bearings[2].rad, 0.5) << "positive to port";
    EXPECT_EQ(read.frequency_khz, 720);
    EXPECT_EQ(read.ping.time.microseconds, (315'532'800 + 1'400'000'000) * int64_t{1'000'000});
    EXPECT_NEAR(read.ping.binStart(1), 0.02, 1e-8) << "1500 m/s / 2 / 37500 Hz";
    EXPECT_FALSE(isUsable(read.sonar));
    EXPECT_THAT(notices_, ElementsAre(HasSubstr("bins are 13.33 us long")));
}

TEST_F(GlfFileTest, SamplesDoNotDependOnThePacking) {
    std::mt19937 random(5);
    for (int round = 0; round < 40; ++round) {
        GlfImage image{.device = 7};
        image.start_range = random() % 2 * (random() % 20);
        image.end_range = image.start_range + 1 + random() % 40;
        const uint32_t beams = 1 + random() % 30, rows = image.end_range - image.start_range;
        for (uint32_t beam = 0; beam < beams; ++beam)
            image.bearings.push_back(1 - 2.0 * beam / beams + 1e-3 * static_cast<double>(random() % 10));
        const RecordedBytes samples = randomSamples(size_t{beams} * rows, random);
        std::vector<RecordedPing> all;
        for (const int way : {0, 1, 2, 3}) {
            image.version = way < 2 ? 3 : 1;
            image.compression = static_cast<uint16_t>(way % 2);
            image.packed = way % 2 == 0 ? packedByZlib(samples) : samples;
            const RecordedBytes log = glfLog({glfRecord(image)});
            const auto size = static_cast<uint32_t>(log.size());
            const uint32_t sum = test::zipChecksum(log);
            all.push_back(read(way == 0 ? zipped("a.dat", log, size, sum)
                                        : zipped("a.dat", deflateBytes(log, way % 2 * 6), size, sum, 8))
                              .at(0));
            EXPECT_FALSE(isNoticed("checksum"));
        }
        for (const RecordedPing& frame : all) {
            EXPECT_EQ(frame.ping.bins, all[0].ping.bins);
            EXPECT_EQ(frame.ping.bin_count, image.end_range);
            EXPECT_NEAR(frame.window_start, image.start_range * 0.02, 1e-6);
            EXPECT_NO_THROW(frame.ping.validate());
        }
        for (uint32_t beam = 0; beam < beams; ++beam) {
            const auto place = std::ranges::find(all[0].ping.bearings, types::Angle::fromRad(image.bearings[beam]).rad,
                                                 &types::Angle::rad);
            const auto row = static_cast<size_t>(place - all[0].ping.bearings.begin());
            for (uint32_t k = 0; k < rows; ++k)
                ASSERT_EQ(all[0].ping.bins[row * image.end_range + image.start_range + k],
                          static_cast<uint8_t>(samples[k * beams + beam]));
        }
    }
}

TEST_F(GlfFileTest, SkipsThousandsOfBytesOfOtherRecords) {
    std::mt19937 random(9);
    std::vector<RecordedBytes> records;
    for (int i = 0; i < 8; ++i) {
        RecordedBytes status = test::glfHeader(i % 2 ? 3 : 99, 1194, 1'400'000'000 + i);
        const RecordedBytes content = randomSamples(218 + random() % 9000, random);
        status.insert(status.end(), content.begin(), content.end());
        records.push_back(status);
        records.push_back(glfRecord(smallImage(i + 0.5)));
    }
    EXPECT_THAT(read(glfFile(records)), SizeIs(8));
    EXPECT_TRUE(isNoticed("4 records of type 3 are omitted"));
    EXPECT_TRUE(isNoticed("4 records of type 99 are omitted"));
}

TEST_F(GlfFileTest, OmitsUnknownRecordsWithANotice) {
    GlfImage other = smallImage(1), video = smallImage(2), zoomed = smallImage(3), inverted = smallImage(4);
    other.device = 8;
    video.compression = 2;
    zoomed.zoom.assign(300, '*');
    inverted.state = 0x2000;
    EXPECT_THAT(read(glfFile({glfRecord(smallImage()), glfRecord(other), glfRecord(video), glfRecord(zoomed),
                              glfRecord(inverted)})),
                SizeIs(3));
    EXPECT_TRUE(isNoticed("1 images of sonar 8 are omitted: only those of the first, 1194, are read"));
    EXPECT_TRUE(isNoticed("1 images are packed as H.264"));
    EXPECT_TRUE(isNoticed("1 acoustic zooms"));
    EXPECT_TRUE(isNoticed("1 images state that the sonar hung upside down"));
}

TEST_F(GlfFileTest, RefusesAWrongFileWithItsByte) {
    const auto with = [&](size_t at, auto value) {
        RecordedBytes record = glfRecord(smallImage());
        putAt(record, at, value);
        return refusal(glfFile({record}));
    };
    const size_t bearings = 51 + 6, tail = bearings + 24;
    EXPECT_THAT(with(0, 'x'), HasSubstr("dive.glf: log.dat, byte 0: is 0x7802; a record begins with 0x2A"));
    EXPECT_THAT(with(25, uint16_t{4}), HasSubstr("log.dat, byte 25: the image is of version 4; only those up to 3"));
    EXPECT_THAT(with(27, uint32_t{2}), HasSubstr("byte 27: the ranges are 2 to 2; they must ascend"));
    EXPECT_THAT(with(31, ~0u), HasSubstr("byte 27: the ranges are 0 to 4294967295"));
    EXPECT_THAT(with(41, ~0u), HasSubstr("byte 37: the bearings are 0 to 4294967295"));
    EXPECT_THAT(with(45, uint16_t{3}), HasSubstr("byte 45: the compression is 3; it may be 0 to 2"));
    EXPECT_THAT(with(45, uint16_t{0}), HasSubstr("byte 51: the samples cannot be unpacked"));
    EXPECT_THAT(with(47, ~0u), HasSubstr("byte 47: the samples take 4294967295 bytes; 3 beams of 2 ranges take fewer"));
    EXPECT_THAT(with(31, uint32_t{3}), HasSubstr("byte 51: the image has 6 samples; 3 beams and 3 ranges have 9"));
    EXPECT_THAT(with(bearings + 8, std::nan("")), HasSubstr("the bearing of beam 1 is nan rad; it must be -pi to pi"));
    EXPECT_THAT(with(tail + 4, uint32_t{0}), HasSubstr("the modulation frequency is 0 Hz"));
    EXPECT_THAT(with(tail + 12, std::nan("")), HasSubstr("the time is nan s since 1970"));
    EXPECT_THAT(with(tail + 22, 9e9f), HasSubstr("the speed of sound is 9e+09 m/s"));
    EXPECT_THAT(with(tail + 32, uint16_t{1}), HasSubstr("is 0x0001; an image ends with 0xDEDE"));
}

TEST_F(GlfFileTest, RefusesAnArchiveWithoutALog) {
    EXPECT_THAT(refusal(zipped("log.cfg", {'a'}, 1, 0)),
                HasSubstr("dive.glf: is an archive without a file whose name ends in .dat"));
    EXPECT_THAT(refusal(zipped("a.dat", {'a'}, 1, 0, 12)), HasSubstr("a.dat: is packed by method 12"));
    RecordedBytes streamed = zipped("a.dat", {'a'}, 1, 0);
    putAt(streamed, 6, uint16_t{8});
    EXPECT_THAT(refusal(streamed), HasSubstr("a.dat: has no size in the archive"));
    EXPECT_THAT(read(glfFile({})), SizeIs(0)) << "no record";
}

TEST_F(GlfFileTest, KeepsThePingsBeforeDamageWithANotice) {
    GlfImage late = smallImage(-3);
    EXPECT_THAT(read(glfFile({glfRecord(smallImage()), glfRecord(late)})), SizeIs(1));
    EXPECT_TRUE(isNoticed("the time is 3 s before that of the previous ping; only the 1 earlier pings are read"));
    RecordedBytes wrong = glfRecord(smallImage(1));
    wrong[0] = '+';
    EXPECT_THAT(read(glfFile({glfRecord(smallImage()), wrong})), SizeIs(1));
    EXPECT_TRUE(isNoticed("is 0x2B02; a record begins with 0x2A"));
}

TEST_F(GlfFileTest, KeepsWholeImagesOfATruncatedFile) {
    const RecordedBytes log = glfLog({glfRecord(smallImage()), glfRecord(smallImage(1))});
    const size_t image = (log.size() - 2) / 2;
    for (const int level : {-1, 0, 6}) {
        const auto size = static_cast<uint32_t>(log.size());
        const RecordedBytes good = level < 0
                                       ? zipped("a.dat", log, size, test::zipChecksum(log))
                                       : zipped("a.dat", deflateBytes(log, level), size, test::zipChecksum(log), 8);
        const auto path = write(good);
        EXPECT_THAT(readFile(path), SizeIs(2));
        for (size_t end = good.size() - 1; end > 35; --end) {
            std::filesystem::resize_file(path, end);
            const auto pings = readFile(path);
            if (level == -1) {
                EXPECT_EQ(pings.size(), (end - 35) / image);
            }
            EXPECT_TRUE(isNoticed("is cut off")) << level << " " << end;
        }
    }
}

TEST_F(GlfFileTest, EveryDamagedByteGivesPingsOrOneError) {
    EXPECT_GT(countRefused(glfFile({glfRecord(smallImage()), glfRecord(smallImage(1))}), 4), 20u);
    const RecordedBytes log = glfLog({glfRecord(smallImage()), glfRecord(smallImage(1))});
    const auto size = static_cast<uint32_t>(log.size());
    countRefused(zipped("a.dat", deflateBytes(log, 6), size, test::zipChecksum(log), 8), 4);
}

TEST_F(GlfFileTest, NoticesAWrongByteOfTheSamplesByTheChecksum) {
    RecordedBytes bytes = glfFile({glfRecord(smallImage())});
    const auto sample = std::ranges::search(bytes, RecordedBytes{1, 2, 3, 4, 5, 6}).begin();
    *sample = 9;
    EXPECT_THAT(read(bytes), SizeIs(1));
    EXPECT_TRUE(isNoticed("log.dat: its checksum is wrong: some of its bytes are"));
}

}  // namespace
}  // namespace insonify::recordings
