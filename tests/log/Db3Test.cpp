// Databases of rosbag2: whole, damaged, locked, of other programs.
#include <gmock/gmock.h>
#include <zstd.h>

#include <random>

#include "components/log/Copy.hpp"
#include "components/log/Files.hpp"
#include "components/log/PoseSources.hpp"
#include "tests/support/Bag.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::log {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Db3Test : testing::Test {
    void SetUp() override {
        for (int i = 0; i < 50; ++i) {
            ros::Odometry odometry;
            odometry.header = {{1'700'000'000 + i, 0}, "odom"};
            odometry.child_frame_id = "base_link";
            odometry.pose.pose.position = {1.0 * i, 2, 3};
            bag.add("/odom", {(1'700'000'000 + i) * int64_t{1'000'000} + 500}, odometry);
            bag.add("/other", {(1'700'000'000 + i) * int64_t{1'000'000} + 600}, ros::Header{{1, 2}, "x"});
        }
        ASSERT_EQ(bag.writeDb3(path), "");
        try {
            openLog(path);
        } catch (const types::ConfigError& error) {
            if (std::string(error.what()).find("has no SQLite") == std::string::npos) throw;
            GTEST_SKIP() << "this build has no SQLite";
        }
    }
    /** Returns the message of the only error. */
    static std::string getRefusal(const std::filesystem::path& file) {
        try {
            const auto log = openLog(file);
            for (const SampleRef& at : log->samples()) log->verify(at);
        } catch (const types::ConfigError& error) {
            EXPECT_EQ(error.diagnostics().size(), 1u);
            return error.what();
        }
        return "";
    }
    void execute(const std::string& statements) const {
        std::ofstream(folder / "execute.py")
            << "import sqlite3, sys\nsqlite3.connect(sys.argv[1]).executescript(\"\"\"" << statements << "\"\"\")\n";
        ASSERT_EQ(pythonSays((folder / "execute.py").string() + " '" + path.string() + "'", folder / "answer"), "");
    }

    const Folder folder;
    const std::filesystem::path path = folder / "bag with % and #.db3";
    test::Bag bag;
};

TEST_F(Db3Test, StreamsTypesTimesAndMessagesAreThoseOfTheTables) {
    const auto log = openLog(path);
    ASSERT_EQ(log->streams().size(), 2u);
    EXPECT_TRUE(log->complete());
    EXPECT_EQ(log->streams()[0].name, "odom");
    EXPECT_EQ(log->streams()[0].topic, "/odom");
    EXPECT_TRUE(log->streams()[0].holds<types::Pose>());
    EXPECT_EQ(log->streams()[1].type, "std_msgs/msg/Header");
    ASSERT_EQ(log->samples().size(), 100u);
    EXPECT_EQ(log->samples()[2].time, (types::Time{1'700'000'001'000'500}));
    types::Pose pose;
    log->read(log->samples()[2], pose);
    EXPECT_EQ(pose.position, glm::dvec3(2, -1, 3));
    EXPECT_EQ(pose.time, (types::Time{1'700'000'001'000'000}));
    EXPECT_EQ(check(path).samples, 100u);
    EXPECT_FALSE(check(path).diagnostic);
}

TEST_F(Db3Test, ABagIsConvertedToLogsOfEitherFormat) {
    for (const char* name : {"copy.0.log", "copy.mcap"}) {
        const Folder to;
        const Copied copied = copyLog({path}, to / name, {});
        const auto log = openLog(to / name);
        EXPECT_EQ(copied.samples, isMcap(name) ? 100u : 50u) << "pocolog cannot hold other messages";
        EXPECT_EQ(copied.lost.size(), isMcap(name) ? 0u : 1u);
        std::vector<types::Pose> poses;
        log->forEach<types::Pose>("odom", [&](const types::Pose& pose, const SampleRef&) { poses.push_back(pose); });
        ASSERT_EQ(poses.size(), 50u);
        EXPECT_LT(glm::distance(poses.back().position, {2, -49, 3}), 1e-12);
        EXPECT_FALSE(check(to / name).diagnostic);
        if (!isMcap(name)) continue;
        const size_t other = log->findIndex("other");
        EXPECT_EQ(log->layout(other), ros::describeSchema<ros::Header>()) << "Humble's databases have no definitions";
        const auto first = std::ranges::find(log->samples(), other, &SampleRef::stream);
        ros::Header header;
        ros::decode(log->toBytes(*first), header);
        EXPECT_EQ(header.frame_id, "x");
        EXPECT_EQ(first->time, (types::Time{1'700'000'000'000'600}));
    }
}

TEST_F(Db3Test, TheFolderOfABagIsAcceptedInPlaceOfItsFile) {
    std::filesystem::create_directory(folder / "bag");
    std::filesystem::copy(path, folder / "bag/bag_0.db3");
    EXPECT_EQ(openLog(folder / "bag")->samples().size(), 100u);
    EXPECT_EQ(check(folder / "bag").samples, 100u);
    std::filesystem::copy(path, folder / "bag/bag_1.db3");
    EXPECT_THAT(getRefusal(folder / "bag"), HasSubstr("is a folder without metadata.yaml; give one of its files: "));
    const auto describe = [&](const std::string& files) {
        std::ofstream(folder / "bag/metadata.yaml")
            << "rosbag2_bagfile_information: {relative_file_paths: [" << files << "]}\n";
    };
    describe("bag_1.db3");
    EXPECT_EQ(openLog(folder / "bag")->samples().size(), 100u);
    describe("bag_1.db3, bag_7.db3");
    EXPECT_THAT(getRefusal(folder / "bag"), HasSubstr("bag_7.db3: cannot be read"));
    for (const std::string& foreign :
         {std::string("../bag_0.db3"), (folder / "x.db3").string(), std::string("x/../../bag_0.db3")}) {
        describe(foreign);
        EXPECT_THAT(getRefusal(folder / "bag"), HasSubstr("which is outside of the bag, and is not read")) << foreign;
    }
    describe("bag_0.db3.zstd");
    EXPECT_THAT(getRefusal(folder / "bag"), AllOf(HasSubstr("unpack it: zstd -d "), HasSubstr("bag_0.db3.zstd")));
    std::filesystem::create_directory(folder / "none");
    EXPECT_THAT(getRefusal(folder / "none"), HasSubstr("is a folder; give a log in it: a .log, .mcap or .db3 file"));
}

TEST_F(Db3Test, TheFilesOfASplitBagAreOneLogWhateverTheirOrderAndStorage) {
    std::mt19937 random(3);
    for (int round = 0; round < 6; ++round) {
        const Folder split;
        std::vector<std::string> names;
        int next = 0;
        for (int file = 0; next < 60; ++file) {
            test::Bag part;
            for (const int end = std::min(60, next + std::uniform_int_distribution<int>(1, 25)(random)); next < end;
                 ++next) {
                ros::TransformStamped transform{
                    {{1'700'000'000 + next, 0}, next % 2 ? "odom" : "map"}, next % 2 ? "base" : "odom", {}};
                transform.transform.translation.x = next;
                part.add("/tf", {(1'700'000'000 + next) * int64_t{1'000'000}}, ros::TFMessage{{transform}});
            }
            names.push_back("bag_" + std::to_string(file) + (round % 2 ? ".db3" : ".mcap"));
            if (round % 2)
                ASSERT_EQ(part.writeDb3(split / names.back()), "");
            else
                part.writeMcap(split / names.back());
        }
        std::ranges::shuffle(names, random);
        std::string list;
        for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
        std::ofstream(split / "metadata.yaml")
            << "rosbag2_bagfile_information: {relative_file_paths: [" << list << "]}\n";
        const auto log = openLog(split.path());
        ASSERT_EQ(log->streams().size(), 1u);
        EXPECT_EQ(log->streams()[0].count, 60u);
        addPoses(*log, {"map->base", "p"}, types::WorldFrame::AsIs);
        std::vector<double> places;
        log->forEach<types::Pose>(
            "p", [&](const types::Pose& pose, const SampleRef&) { places.push_back(pose.position.x); });
        // At each second from 1 to 58 both transforms are known, one of them by interpolation: both are the second.
        ASSERT_EQ(places.size(), 58u) << "across the borders of the files";
        for (size_t second = 1; second <= 58; ++second) EXPECT_NEAR(places[second - 1], 2.0 * second, 1e-9);
    }
}

TEST_F(Db3Test, AReadOnlyBagThatWasLoggedAheadIsReadAndNoFileIsMadeNextToIt) {
    std::filesystem::create_directory(folder / "wal");
    ASSERT_EQ(bag.writeDb3(folder / "wal/bag.db3", "wal"), "");
    EXPECT_EQ(toBytes(folder / "wal/bag.db3")[18], 2) << "a database of this kind";
    const auto filesNow = [&] { return std::distance(std::filesystem::directory_iterator(folder / "wal"), {}); };
    const auto before = filesNow();
    {
        const auto log = openLog(folder / "wal/bag.db3");
        EXPECT_EQ(log->samples().size(), 100u);
        EXPECT_EQ(filesNow(), before);
    }
    EXPECT_EQ(filesNow(), before);
}

TEST_F(Db3Test, OtherFilesAreOneErrorWithItsReason) {
    std::ofstream(folder / "text.db3") << "topics,messages\n" << std::string(500, 'x');
    EXPECT_THAT(getRefusal(folder / "text.db3"), HasSubstr("is no SQLite database"));
    std::ofstream(folder / "empty.db3") << "";
    EXPECT_THAT(getRefusal(folder / "empty.db3"), HasSubstr("is no SQLite database"));
    EXPECT_THAT(getRefusal(folder / "absent.db3"), HasSubstr("cannot be read: No such file"));
    execute("CREATE TABLE more(x); DROP TABLE topics;");
    EXPECT_THAT(getRefusal(path), HasSubstr("without the tables topics and messages"));
    execute(
        "CREATE VIEW topics AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i FROM n) SELECT i AS id, i AS name, "
        "i AS type, i AS "
        "serialization_format FROM n;");
    EXPECT_THAT(getRefusal(path), HasSubstr("without the tables topics and messages")) << "which would never end";
    execute("DROP VIEW topics; CREATE TABLE topics(id, name);");
    EXPECT_THAT(getRefusal(path), AllOf(HasSubstr("cannot be read as a bag"), HasSubstr("no such column")));
    execute(
        "DROP TABLE topics; CREATE TABLE topics(id, name, type, serialization_format); INSERT INTO topics VALUES(7, "
        "NULL, x'ff', 3);");
    EXPECT_THAT(getRefusal(path), HasSubstr("the message of id 1 is of topic 1, which is not there"));
}

TEST_F(Db3Test, AMessageThatIsNotOfItsTypeIsNamedById) {
    execute("UPDATE messages SET data = x'00010000ff' WHERE id = 3;");
    EXPECT_THAT(getRefusal(path), HasSubstr("the sample of id 3"));
    execute("UPDATE messages SET data = 5 WHERE id = 3;");
    EXPECT_THAT(getRefusal(path), HasSubstr("the sample of id 3"));
}

TEST_F(Db3Test, ALockedBagIsRefusedAndReadAfterwards) {
    std::ofstream(folder / "hold.py")
        << "import sqlite3, sys\ndb = sqlite3.connect(sys.argv[1])\ndb.execute('BEGIN EXCLUSIVE')\n"
           "open(sys.argv[2], 'w').close()\nsys.stdin.read()\n";
    const std::string command =
        python() + " " + (folder / "hold.py").string() + " '" + path.string() + "' " + (folder / "held").string();
    FILE* const holder = popen(command.c_str(), "w");
    ASSERT_NE(holder, nullptr);
    for (int i = 0; i < 200 && !std::filesystem::exists(folder / "held"); ++i) usleep(50'000);
    EXPECT_THAT(getRefusal(path), HasSubstr("is locked: another program writes it; wait until it has ended"));
    pclose(holder);
    EXPECT_EQ(getRefusal(path), "");
}

TEST_F(Db3Test, ATruncatedBagIsDamagedWhereverItEnds) {
    const std::vector<char> whole = toBytes(path);
    std::mt19937 random(1);
    for (int i = 0; i < 40; ++i) {
        const size_t size = std::uniform_int_distribution<size_t>(0, whole.size() - 1)(random);
        writeBytes(folder / "cut.db3", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
        EXPECT_THAT(getRefusal(folder / "cut.db3"),
                    HasSubstr(size < 100 ? "is no SQLite database" : "is damaged or incomplete"))
            << size;
    }
}

TEST_F(Db3Test, DamagedBytesAreReadOrOneError) {
    const std::vector<char> whole = toBytes(path);
    std::mt19937 random(2);
    for (int i = 0; i < 300; ++i) {
        std::vector<char> damaged = whole;
        for (int k = 0; k < 4; ++k)
            damaged[std::uniform_int_distribution<size_t>(16, damaged.size() - 1)(random)] =
                static_cast<char>(random());
        writeBytes(folder / "cut.db3", damaged);
        getRefusal(folder / "cut.db3");  // checks that there is one
    }
}

TEST_F(Db3Test, MessagesThatAreCompressedOneByOneAreRead) {
    std::vector<char> bytes, packed;
    ros::Odometry odometry;
    odometry.pose.pose.position = {4, 5, 6};
    ros::encode(odometry, bytes);
    packed.resize(ZSTD_compressBound(bytes.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
    std::string hex;
    for (const char c : packed) {
        char digits[3];
        std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned char>(c));
        hex += digits;
    }
    execute("UPDATE messages SET data = x'" + hex + "' WHERE topic_id = 1;");
    types::Pose pose;
    const auto log = openLog(path);
    log->read(log->samples()[0], pose);
    EXPECT_EQ(pose.position, glm::dvec3(5, -4, 6));
    execute("UPDATE messages SET data = x'" + hex.substr(0, hex.size() - 10) + "' WHERE id = 1;");
    EXPECT_THAT(getRefusal(path), AllOf(HasSubstr("the sample of id 1"), HasSubstr("is compressed, and damaged")));
}

}  // namespace
}  // namespace insonify::log
