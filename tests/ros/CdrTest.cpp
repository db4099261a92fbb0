#include <gmock/gmock.h>

#include "components/ros/Cdr.hpp"
#include "tests/ros/Samples.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::ros {
namespace {

template <class T>
std::vector<char> toBytes(const T& message) {
    std::vector<char> bytes;
    encode(message, bytes);
    return bytes;
}

/** Returns a message such as "Time(1 0)" in hexadecimal, without the header. */
std::string getBody(const auto& message) {
    std::string text;
    const std::vector<char> bytes = toBytes(message);
    for (size_t i = 4; i < bytes.size(); ++i) {
        char digits[4];
        std::snprintf(digits, sizeof digits, "%02x", static_cast<uint8_t>(bytes[i]));
        text += digits;
    }
    return text;
}

template <class T>
std::string findDiagnostic(const std::vector<char>& bytes) {
    T message;
    return test::computeError<CdrError>([&] { decode(bytes, message); });
}

PointCloud2 smallCloud() {
    PointCloud2 cloud;
    cloud.header.frame_id = "a";
    cloud.width = 1;
    cloud.fields = {{"x", 0, PointField::float32, 1}, {"yz", 4, PointField::float32, 2}};
    cloud.point_step = cloud.row_step = 12;
    cloud.data.assign(12, 7);
    return cloud;
}

TEST(CdrTest, AMessageBeginsWithItsEncoding) {
    EXPECT_THAT(toBytes(Time{1, 2}), testing::ElementsAre(0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0));
}

TEST(CdrTest, EncodesATextAsLengthWithFinalNulAndCharacters) {
    EXPECT_EQ(getBody(Header{{-1, 0x11223344}, "ab"}),
              "ffffffff44332211"
              "03000000"
              "616200");
    EXPECT_EQ(getBody(Header{{0, 0}, ""}),
              "0000000000000000"
              "01000000"
              "00");
}

TEST(CdrTest, AlignsNumbersFromTheStartOfTheBody) {
    // header 8 + 4 + 2 bytes, padded by 2 to 16, then the first double
    PoseStamped pose;
    pose.header.frame_id = "w";
    pose.pose.position.x = 1;
    EXPECT_EQ(getBody(pose).substr(0, 48),
              "0000000000000000"
              "02000000"
              "7700"
              "0000"
              "000000000000f03f");
    pose.header.frame_id = "wor";  // 8 + 4 + 4 bytes: no padding
    EXPECT_EQ(getBody(pose).substr(24, 24),
              "776f7200"
              "000000000000f03f");
    EXPECT_EQ(toBytes(pose).size(), 4u + 16 + 7 * 8);
}

TEST(CdrTest, DoesNotPadAnEmptySequenceOfDoubles) {
    ProjectedSonarImage image = smallImage();
    image.beam_directions.clear();
    image.ranges.clear();
    image.image.data = {9};
    const std::string body = getBody(image);
    // rx_beamwidths end at 20 + 8 + 8 + 12 = 48; then two counts, bool, padding, dtype, beams, count, one byte
    EXPECT_EQ(body.substr(2 * 48),
              "00000000"
              "00000000"
              "00000000"
              "00000000"
              "02000000"
              "01000000"
              "09");
}

TEST(CdrTest, AlignsEachElementOfASequence) {
    EXPECT_EQ(getBody(smallCloud()).substr(2 * 24),
              "02000000"  // two fields
              "02000000"
              "7800"
              "0000"
              "00000000"
              "07"
              "000000"
              "01000000"
              "03000000"
              "797a00"
              "00"
              "04000000"
              "07"
              "000000"
              "02000000"
              "00"
              "000000"
              "0c000000"
              "0c000000"
              "0c000000"
              "070707070707070707070707"
              "01");
}

template <class T>
void expectRoundTripAndNoTruncation(const T& message) {
    const std::vector<char> bytes = toBytes(message);
    T again;
    decode(bytes, again);
    EXPECT_EQ(again, message) << T::type_name;
    for (size_t size = 0; size < bytes.size(); ++size) {
        const std::vector<char> cut(bytes.begin(), bytes.begin() + static_cast<int64_t>(size));
        EXPECT_NE(findDiagnostic<T>(cut), "") << T::type_name << " cut to " << size << " of " << bytes.size();
    }
}

TEST(CdrTest, DecodesWhatItEncodesAndRefusesTruncatedMessages) {
    Odometry odometry;
    odometry.header = {{5, 6}, "odom"};
    odometry.child_frame_id = "base_link";
    odometry.pose.covariance[35] = 0.5;
    odometry.twist.twist.angular.z = 3;
    expectRoundTripAndNoTruncation(odometry);
    expectRoundTripAndNoTruncation(smallImage());
    expectRoundTripAndNoTruncation(smallCloud());
    expectRoundTripAndNoTruncation(Clock{{1, 2}});
    PoseStamped pose;
    pose.header.frame_id = "map";
    pose.pose.orientation.w = 0.5;
    expectRoundTripAndNoTruncation(pose);
    Image image;
    image.encoding = "mono8";
    image.data = {1, 2};
    expectRoundTripAndNoTruncation(image);
    LaserScan scan;
    scan.ranges = {1, 2, 3};
    expectRoundTripAndNoTruncation(scan);
    RawSonarImage raw;
    raw.tx_delays = {3};
    raw.image.data = {1, 2, 3};
    expectRoundTripAndNoTruncation(raw);
    SonarRanges ranges;
    ranges.flags = {{0}, {2}};
    ranges.beam_unit_vec = {{1, 0, 0}};
    expectRoundTripAndNoTruncation(ranges);
}

TEST(CdrTest, RandomBytesDoNoHarm) {
    const std::vector<char> bytes = toBytes(smallImage());
    size_t refused = 0;
    for (size_t at = 0; at < bytes.size(); ++at)
        for (const int value : {0, 1, 127, 128, 255}) {
            std::vector<char> wrong = bytes;
            wrong[at] = static_cast<char>(value);
            refused += !findDiagnostic<ProjectedSonarImage>(wrong).empty();
        }
    EXPECT_GT(refused, bytes.size() / 4);
}

TEST(CdrTest, ReportsADiagnosticWithItsPlace) {
    std::vector<char> bytes = toBytes(Header{{0, 0}, "ab"});
    EXPECT_EQ(findDiagnostic<Header>({0, 0, 0, 0}), "byte 0: encoding 0 is not read, only 1: plain CDR, little endian");
    bytes[12] = 100;
    EXPECT_EQ(findDiagnostic<Header>(bytes), "byte 12: 100 elements are announced, more than the message holds");
    bytes[12] = 2;
    EXPECT_EQ(findDiagnostic<Header>(bytes), "byte 17: a text does not end in NUL");
    bytes = toBytes(smallCloud());
    bytes.back() = 3;
    EXPECT_EQ(findDiagnostic<PointCloud2>(bytes),
              "byte " + std::to_string(bytes.size() - 1) + ": a truth value is 3, not 0 or 1");
}

TEST(CdrTest, AcceptsUpToThreeBytesOfPadding) {
    std::vector<char> bytes = toBytes(Time{1, 2});
    bytes.resize(bytes.size() + 3);
    EXPECT_EQ(findDiagnostic<Time>(bytes), "");
    bytes.push_back(0);
    EXPECT_EQ(findDiagnostic<Time>(bytes), "byte 12: the message has 4 bytes too many");
}

}  // namespace
}  // namespace insonify::ros
