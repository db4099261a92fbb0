#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "components/ros/Clouds.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::ros {
namespace {

std::vector<float> getNumbers(const PointCloud2& message) {
    std::vector<float> numbers(message.data.size() / sizeof(float));
    std::memcpy(numbers.data(), message.data.data(), message.data.size());
    return numbers;
}

types::PointCloud twoPoints() {
    types::PointCloud cloud;
    cloud.time = {2'000'001};
    cloud.add({3, 2, -5}, 0.25);
    cloud.add({-1, 0.5, -6}, 0.125);
    return cloud;
}

types::DepthMap smallMap() {
    types::DepthMap map;
    map.time = {2'000'001};
    map.vertical_size = map.horizontal_size = 2;
    map.vertical_interval = {-0.5, 0.5};
    map.horizontal_interval = {0.25, -0.25};
    map.distances = {2, types::DepthMap::too_far, 4, 8};
    map.remissions = {1, 0, 0.5f, 0.25f};
    return map;
}

TEST(CloudsTest, WritesPointsInTheAxesOfTheWorldFrame) {
    PointCloud2 message;
    convert(twoPoints(), WorldFrame::Enu, message);
    EXPECT_EQ(message.width, 2u);
    EXPECT_EQ(message.height, 1u);
    EXPECT_EQ(message.header.frame_id, "map");
    EXPECT_THAT(getNumbers(message), testing::ElementsAre(-2, 3, -5, 0.25f, -0.5f, -1, -6, 0.125f));
    convert(twoPoints(), WorldFrame::Ned, message);
    EXPECT_THAT(getNumbers(message), testing::ElementsAre(3, -2, 5, 0.25f, -1, -0.5f, 6, 0.125f));
}

TEST(CloudsTest, RestoresPointsFromEveryFrame) {
    for (const WorldFrame frame : {WorldFrame::AsIs, WorldFrame::Enu, WorldFrame::Ned}) {
        PointCloud2 message;
        types::PointCloud back;
        convert(twoPoints(), frame, message);
        convert(message, frame, back);
        EXPECT_EQ(back.time, twoPoints().time);
        EXPECT_EQ(back.points, twoPoints().points);
        EXPECT_EQ(back.colors, twoPoints().colors);
    }
}

TEST(CloudsTest, PointsFarFromTheOriginHave64Bits) {
    const auto datatypes = [](const PointCloud2& message) {
        std::vector<int> all;
        for (const PointField& field : message.fields) all.push_back(field.datatype);
        return all;
    };
    const int single = PointField::float32, twice = PointField::float64;
    types::PointCloud cloud = twoPoints();
    cloud.points[0] = {500'000.123456, -6'500'000.654321, -12.25};
    for (const WorldFrame frame : {WorldFrame::AsIs, WorldFrame::Enu, WorldFrame::Ned}) {
        PointCloud2 message;
        convert(cloud, frame, message);
        EXPECT_THAT(datatypes(message), testing::ElementsAre(twice, twice, twice, single));
        EXPECT_EQ(message.point_step, 28u);
        EXPECT_EQ(message.width, 2u);
        EXPECT_EQ(message.row_step, 56u);
        types::PointCloud back;
        convert(message, frame, back);
        EXPECT_EQ(back.points, cloud.points);
        EXPECT_EQ(back.colors, cloud.colors);
    }
    // up to 8192 m, and for points that are no numbers, 32 bits resolve half a millimetre
    PointCloud2 message;
    cloud.points[0] = {8192, -8191.9, std::nan("")};
    convert(cloud, WorldFrame::AsIs, message);
    EXPECT_THAT(datatypes(message), testing::ElementsAre(single, single, single, single));
    types::PointCloud back;
    convert(message, WorldFrame::AsIs, back);
    EXPECT_NEAR(back.points[0].y, cloud.points[0].y, 5e-4);
    cloud.points[0] = {0, 0, 8192.1};
    convert(cloud, WorldFrame::AsIs, message);
    EXPECT_EQ(message.fields[2].datatype, twice);
}

TEST(CloudsTest, ReadsCloudsWithDoublesAndWithoutIntensity) {
    PointCloud2 message;
    message.fields = {
        {"x", 0, PointField::float64, 1}, {"y", 8, PointField::float64, 1}, {"z", 16, PointField::float64, 1}};
    message.width = 1;
    message.point_step = message.row_step = 24;
    message.data.resize(24);
    const double point[] = {1e7 + 0.125, 2, 3};
    std::memcpy(message.data.data(), point, sizeof point);
    types::PointCloud cloud;
    convert(message, WorldFrame::AsIs, cloud);
    EXPECT_EQ(cloud.points, (std::vector<glm::dvec3>{{1e7 + 0.125, 2, 3}}));
    EXPECT_TRUE(cloud.colors.empty());
}

TEST(CloudsTest, RefusesInvalidCloudsWithAReason) {
    PointCloud2 message;
    types::PointCloud cloud;
    const auto reason = [&](const auto& spoil) -> std::string {
        convert(twoPoints(), WorldFrame::AsIs, message);
        spoil();
        return test::computeError<std::invalid_argument>([&] { convert(message, WorldFrame::AsIs, cloud); });
    };
    EXPECT_EQ(reason([&] {}), "");
    EXPECT_EQ(reason([&] { message.data.pop_back(); }), "the cloud does not hold the points that it announces");
    EXPECT_EQ(reason([&] { message.row_step = 4; }), "the cloud does not hold the points that it announces");
    EXPECT_EQ(reason([&] { message.fields[2].name = "w"; }), "the cloud has no field z");
    EXPECT_EQ(reason([&] { message.fields[0].offset = 14; }), "field x reaches beyond its point");
    EXPECT_EQ(reason([&] { message.fields[0].datatype = 2; }), "field x of the cloud is neither FLOAT32 nor FLOAT64");
    EXPECT_EQ(reason([&] { message.is_bigendian = true; }), "big-endian points are not read");
}

TEST(CloudsTest, WritesAnOrderedCloudOfADistanceMapAndRestoresIt) {
    PointCloud2 message;
    convert(smallMap(), "sonar", message);
    EXPECT_EQ(message.height, 2u);
    EXPECT_EQ(message.width, 2u);
    EXPECT_FALSE(message.is_dense);
    const std::vector<float> numbers = getNumbers(message);
    const double up = 0.5, port = 0.25;
    EXPECT_FLOAT_EQ(numbers[0], static_cast<float>(2 * std::cos(up) * std::cos(port)));
    EXPECT_FLOAT_EQ(numbers[1], static_cast<float>(2 * std::cos(up) * std::sin(port)));
    EXPECT_FLOAT_EQ(numbers[2], static_cast<float>(2 * std::sin(up)));
    EXPECT_TRUE(std::isnan(numbers[7])) << "there is no echo";
    EXPECT_LT(numbers[14 + 2], 0) << "the lower row";
    types::DepthMap back;
    convert(message, back);
    EXPECT_EQ(back.distances, smallMap().distances);
    EXPECT_EQ(back.remissions, smallMap().remissions);
    EXPECT_EQ(back.vertical_interval, smallMap().vertical_interval);
    EXPECT_EQ(back.horizontal_interval, smallMap().horizontal_interval);
}

TEST(CloudsTest, OnlyPolarMapsWithAllTheirAnglesBecomeClouds) {
    PointCloud2 message;
    types::DepthMap planar = smallMap(), few = smallMap(), short_of = smallMap();
    planar.horizontal_projection = types::Projection::Planar;
    few.vertical_size = 4, few.horizontal_size = 1;
    short_of.distances.pop_back();
    for (const types::DepthMap& map : {planar, few, short_of})
        EXPECT_THROW(convert(map, "sonar", message), std::invalid_argument);
}

TEST(CloudsTest, AnUnknownRangeIsInfiniteInRos) {
    types::Range range;
    range.range_max = 30;
    Range message;
    convert(range, "altimeter", message);
    EXPECT_EQ(message.range, std::numeric_limits<float>::infinity());
    EXPECT_EQ(message.max_range, 30);
    EXPECT_EQ(message.header.frame_id, "altimeter");
    convert(message, range);
    EXPECT_FALSE(range.isKnown());
}

}  // namespace
}  // namespace insonify::ros
