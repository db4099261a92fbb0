#include <gmock/gmock.h>

#include "components/logger/LoggerConfig.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::logger {
namespace {

size_t countRefusals(const std::string& file) {
    LoggerConfig config;
    config.file = file;
    return test::countRefusals(config).size();
}

TEST(LoggerConfigTest, AcceptsOnlyNamesThatEndInLog) {
    for (const char* good : {"harbour.0.log", "harbour.log", "day/harbour.1.log", "x.LOG", "x.0.Mcap"})
        EXPECT_EQ(countRefusals(good), 0u) << good;
    for (const char* bad : {"", ".log", "harbour", "harbour.log.gz", "harbour.log/"})
        EXPECT_EQ(countRefusals(bad), 1u) << bad;
}

TEST(LoggerConfigTest, ALogOfSeveralFilesHasANumber) {
    LoggerConfig config;
    config.max_file_size = 1e6;
    for (const auto& [file, count] : {std::pair{"harbour.0.log", 0u}, {"harbour.17.log", 0u}, {"harbour.log", 1u}}) {
        config.file = file;
        EXPECT_THAT(test::countRefusals(config), testing::SizeIs(count)) << file;
    }
    EXPECT_EQ(nextInSequence("day/harbour.9.log"), "day/harbour.10.log");
}

TEST(LoggerConfigTest, AQuotaHoldsTwoFiles) {
    LoggerConfig config;
    config.file = "x.0.log";
    config.max_total_size = 3e6;
    EXPECT_THAT(test::countRefusals(config), testing::ElementsAre(testing::HasSubstr("needs max_file_size")));
    config.max_file_size = 1.6e6;
    EXPECT_THAT(test::countRefusals(config), testing::ElementsAre(testing::HasSubstr("twice max_file_size: 3200000")));
    config.max_file_size = 1.5e6;
    EXPECT_THAT(test::countRefusals(config), testing::IsEmpty());
}

TEST(LoggerConfigTest, PropertiesHaveTheirOwnFile) {
    LoggerConfig config;
    config.file = "day/x.0.log";
    for (const auto& [file, count] :
         {std::pair{"properties.0.log", 0u}, {"", 0u}, {"x.0.log", 1u}, {"a/b.0.log", 1u}, {"properties", 1u}}) {
        config.property_file = file;
        EXPECT_THAT(test::countRefusals(config), testing::SizeIs(count)) << file;
    }
}

}  // namespace
}  // namespace insonify::logger
