#include <gtest/gtest.h>

#include "components/logger/LoggerConfig.hpp"

namespace insonify::logger {
namespace {

size_t problemsOf(const std::string& file) {
    LoggerConfig config;
    config.file = file;
    types::Problems problems;
    config.check(problems);
    return problems.size();
}

TEST(LoggerConfigTest, OnlyANameThatEndsInLogIsTaken) {
    for (const char* good : {"harbour.0.log", "harbour.log", "day/harbour.1.log"})
        EXPECT_EQ(problemsOf(good), 0u) << good;
    for (const char* bad : {"", ".log", "harbour", "harbour.log.gz", "harbour.log/"})
        EXPECT_EQ(problemsOf(bad), 1u) << bad;
}

}  // namespace
}  // namespace insonify::logger
