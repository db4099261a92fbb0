#include <gmock/gmock.h>

#include <fstream>
#include <thread>

#include "components/dataset/Store.hpp"
#include "tests/support/Folder.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::dataset {
namespace {

namespace fs = std::filesystem;

struct StoreTest : ::testing::Test {
    Store store(const std::string& digest = "a") const { return Store(folder_.path(), digest); }
    void putSample(Store& store, uint64_t index) const {
        const std::string name = store.makeStem(index) + ".txt";
        Json record{{"index", index}, {"value", 0.1}};
        record["files"] = {{name, store.putText(name, "sample " + std::to_string(index))}};
        store.putRecord(index, record);
    }
    void overwrite(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

    const Folder folder_;
};

TEST_F(StoreTest, ASampleExistsOnceItsRecordExists) {
    Store files = store();
    EXPECT_FALSE(files.has(3));
    files.putText(files.makeStem(3) + ".txt", "sample 3");
    EXPECT_FALSE(files.has(3));
    putSample(files, 3);
    EXPECT_TRUE(files.has(3));
    EXPECT_TRUE(store().has(3));
    EXPECT_FALSE(files.has(4));
    EXPECT_EQ((*files.record(3))["value"], 0.1);
}

TEST_F(StoreTest, ADamagedSampleDoesNotExist) {
    Store files = store();
    const std::string stem = files.makeStem(0);
    const auto broken = [&](const std::string& name, const std::string& text) {
        putSample(files, 0);
        EXPECT_TRUE(files.has(0));
        overwrite(name, text);
        return !files.has(0);
    };
    putSample(files, 0);
    std::string record(128, ' ');
    std::ifstream(folder_ / (stem + ".json")).read(record.data(), 40);
    EXPECT_TRUE(broken(stem + ".txt", "sample"));
    EXPECT_TRUE(broken(stem + ".txt", "sample 1"));
    EXPECT_TRUE(broken(stem + ".json", ""));
    EXPECT_TRUE(broken(stem + ".json", record));
    EXPECT_TRUE(broken(stem + ".json", R"({"index":0,"files":{}})"));
    putSample(files, 0);
    fs::remove(folder_ / (stem + ".txt"));
    EXPECT_FALSE(files.has(0));
}

TEST_F(StoreTest, NamesAreOfNumberAndDigest) {
    EXPECT_THAT(store().makeStem(42), testing::MatchesRegex("000042_[0-9a-f]{12}"));
    EXPECT_NE(store("a").makeStem(42), store("b").makeStem(42));
    EXPECT_NE(store("a").makeStem(1).substr(7), store("a").makeStem(2).substr(7));
}

TEST_F(StoreTest, AFolderOfAnotherDataSetIsRefused) {
    Store files = store("a");
    putSample(files, 1);
    EXPECT_NO_THROW(store("a"));
    EXPECT_THROW(store("b"), types::ConfigError);
    overwrite("notes.txt", "mine");
    EXPECT_NO_THROW(store("a"));
}

TEST_F(StoreTest, AWriterThatFailsLeavesNothing) {
    Store files = store();
    const auto failing = [](const fs::path& file) {
        std::ofstream(file) << "half";
        throw std::runtime_error("the disk is full");
    };
    EXPECT_THROW(files.put("x.png", failing), std::runtime_error);
    EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(StoreTest, RemovesFilesOfKilledWriters) {
    Store files = store();
    overwrite(".part_0123_1_x.png", "half");
    fs::create_directory(folder_ / ".part_0123_2_y.mcap.bag");
    putSample(files, 0);
    files.removeLeftovers();
    EXPECT_TRUE(files.has(0));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(StoreTest, AWriterWhoseFileIsTakenForALeftoverWritesAgain) {
    Store files = store();
    int tries = 0;
    files.put("x.png", [&](const fs::path& file) {
        std::ofstream(file) << "whole";
        if (++tries == 1) files.removeLeftovers();
    });
    EXPECT_EQ(tries, 2);
    EXPECT_EQ(toBytes(folder_ / "x.png").size(), 5u);
}

TEST_F(StoreTest, SeveralMayWriteTheSameSample) {
    std::vector<std::jthread> writers;
    for (int i = 0; i < 4; ++i)
        writers.emplace_back([this] {
            Store files = store();
            for (uint64_t index = 0; index < 20; ++index) putSample(files, index);
        });
    writers.clear();
    for (uint64_t index = 0; index < 20; ++index) EXPECT_TRUE(store().has(index));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 40);
}

}  // namespace
}  // namespace insonify::dataset
