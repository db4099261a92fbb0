// Schemas and bytes of the messages, compared with the Python package rosbags.
#include <gmock/gmock.h>

#include <fstream>

#include "components/ros/Cdr.hpp"
#include "components/ros/NodeMessages.hpp"
#include "components/ros/Pings.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Samples.hpp"
#include "components/ros/Schema.hpp"
#include "tests/ros/Samples.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

namespace insonify::ros {
namespace {

/** Writes N.msg with the schema, N.cdr with a message, and a line "N type hash" for the list. */
class Corpus {
public:
    explicit Corpus(std::filesystem::path folder) : folder_(std::move(folder)), list_(folder_ / "list") {}

    template <class T>
    void add(const T& message) {
        const std::string number = std::to_string(count_++);
        std::vector<char> bytes;
        encode(message, bytes);
        std::ofstream(folder_ / (number + ".msg")) << describeSchema<T>();
        std::ofstream(folder_ / (number + ".cdr")).write(bytes.data(), static_cast<int64_t>(bytes.size()));
        list_ << number << ' ' << T::type_name << ' ' << typeHash<T>() << std::endl;
    }

private:
    std::filesystem::path folder_;
    std::ofstream list_;
    int count_ = 0;
};

TEST(MessagesTest, ASchemaContainsTheMessageAndAllNestedMessages) {
    const std::string line = "\n" + std::string(80, '=') + "\nMSG: ";
    EXPECT_EQ(describeSchema<PoseStamped>(),
              "std_msgs/Header header\ngeometry_msgs/Pose pose" + line +
                  "std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id" + line +
                  "builtin_interfaces/Time\nint32 sec\nuint32 nanosec" + line +
                  "geometry_msgs/Pose\ngeometry_msgs/Point position\n"
                  "geometry_msgs/Quaternion orientation" +
                  line + "geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z" + line +
                  "geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n");
    EXPECT_EQ(describeSchema<DetectionFlag>(), std::string(DetectionFlag::constants) + "uint8 flag\n");
    EXPECT_THAT(describeSchema<Odometry>(), testing::HasSubstr("float64[36] covariance\n"));
    EXPECT_THAT(describeSchema<SonarRanges>(), testing::HasSubstr("geometry_msgs/Vector3[] beam_unit_vec\n"));
}

TEST(MessagesTest, RosbagsComputesTheSameHashesAndReadsTheSameValues) {
    if (!pythonHas("rosbags"))
        GTEST_SKIP() << "SKIPPED: the Python package rosbags is missing; scripts/setup installs it";
    const Folder folder;
    Corpus corpus(folder.path());
    forEachNodeMessage([&](const auto& message) { corpus.add(message); });
    forEachMessage([&]<class T>(std::type_identity<T>) { corpus.add(T{}); });
    SonarOptions levels;
    levels.dtype = ImageType::Uint8;
    const auto add = [&]<class T>(T message) {
        convert(smallPing(), levels, message);
        corpus.add(message);
    };
    add(ProjectedSonarImage{});
    add(RawSonarImage{});
    add(SonarRanges{});
    add(SonarDetections{});
    add(PointCloud2{});
    add(LaserScan{});
    Odometry odometry;
    convert(smallPose(), WorldFrame::Enu, odometry);
    corpus.add(odometry);
    const std::string answer =
        pythonSays(test::sourceFile("tests/ros/read_messages.py ") + folder.path().string(), folder.path() / "answer");
    EXPECT_THAT(answer, testing::StartsWith("86 messages as announced\n"));
    EXPECT_THAT(answer,
                testing::HasSubstr("ProjectedSonarImage 1700000000.123456000 sonar 1500.0 [0.375, 1.125, 1.875] "
                                   "-0.479426 [128, 55, 168, 0, 213, 255]\n"));
    EXPECT_THAT(answer, testing::HasSubstr("RawSonarImage 1000.0 3 [-0.5, 0.25]\n"));
    EXPECT_THAT(answer, testing::HasSubstr("SonarRanges [1.875, 1.875] [0, 0] [100.0, 1000.0]\n"));
    EXPECT_THAT(answer, testing::HasSubstr("SonarDetections [0.0025, 0.0025] [0, 0] [0.0, 0.0] [-0.5, 0.25]\n"));
    EXPECT_THAT(answer, testing::HasSubstr("PointCloud2 2 16 ['x', 'y', 'z', 'intensity']\n"));
    EXPECT_THAT(answer, testing::HasSubstr("LaserScan -0.25 0.75 [1.875, 1.875]\n"));
    EXPECT_THAT(answer, testing::HasSubstr("Odometry world body [-2.0, 3.0, -5.0] [1.5, -0.5, -0.25] 2.0\n"));
}

TEST(MessagesTest, TheHashIsThatOfTheTypeDescription) {
    EXPECT_EQ(
        TypeDescription::json<Clock>(),
        R"({"type_description": {"type_name": "rosgraph_msgs/msg/Clock", "fields": [{"name": "clock", "type": )"
        R"({"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}]}, )"
        R"("referenced_type_descriptions": [{"type_name": "builtin_interfaces/msg/Time", "fields": [{"name": "sec", )"
        R"("type": {"type_id": 6, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "nanosec", )"
        R"("type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}]})");
    EXPECT_EQ(typeHash<Clock>(), "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564");
    EXPECT_EQ(typeHash<Empty<"std_msgs/msg/Empty">>(),
              "RIHS01_20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312");
}

TEST(MessagesTest, ABoundedSequenceRefusesMore) {
    using Two = OneField<"x/msg/Two", "range", Bounded<double, 2>>;
    using Any = OneField<"x/msg/Two", "range", std::vector<double>>;
    for (const size_t count : {0u, 1u, 2u, 3u}) {
        std::vector<char> bytes;
        encode(Any{std::vector<double>(count, 0.5)}, bytes);
        Two read;
        if (count <= 2) {
            decode(std::span<const char>(bytes), read);
            EXPECT_EQ(read.field.size(), count);
        } else
            EXPECT_THROW(decode(std::span<const char>(bytes), read), CdrError);
    }
}

}  // namespace
}  // namespace insonify::ros
