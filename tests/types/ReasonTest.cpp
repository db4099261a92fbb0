#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "types/text/ConfigError.hpp"

namespace insonify::types {
namespace {

std::string reasonFor(auto act) {
    try {
        act();
    } catch (const std::exception& failure) {
        return getReason(failure);
    }
    return "nothing was thrown";
}

TEST(ReasonTest, ReplacesTextsOfTheStandardLibrary) {
    const std::string bounds = "a number, a count or an index in it is out of bounds";
    const std::string memory = "out of memory";
    EXPECT_EQ(reasonFor([] { return std::stoi("x"); }), bounds);
    EXPECT_EQ(reasonFor([] { return std::stoull("99999999999999999999999"); }), bounds);
    EXPECT_EQ(reasonFor([] { return std::stod("1e999"); }), bounds);
    EXPECT_EQ(reasonFor([] { return std::vector<int>().at(3); }), bounds);
    EXPECT_EQ(reasonFor([] { return std::array<int, 2>().at(std::string(7, ' ').size()); }), bounds);
    EXPECT_EQ(reasonFor([] { return std::map<int, int>().at(3); }), bounds);
    EXPECT_EQ(reasonFor([] { return std::unordered_map<int, int>().at(3); }), bounds);
    EXPECT_EQ(reasonFor([] { return std::string("a").substr(9); }), bounds);
    EXPECT_EQ(reasonFor([] { std::vector<int>().reserve(std::numeric_limits<size_t>::max()); }), memory);
    EXPECT_EQ(reasonFor([]() -> std::vector<int> { return std::vector<int>(std::numeric_limits<size_t>::max()); }),
              memory);
    EXPECT_EQ(reasonFor([] { throw std::bad_alloc(); }), memory);
}

TEST(ReasonTest, KeepsASentence) {
    for (const char* text : {"range: is -3; must be positive", "stop: sonar::SonarTask has no such port", "",
                             "store.log: No space left on device", "out of paper"})
        EXPECT_EQ(getReason(std::runtime_error(text)), text);
}

}  // namespace
}  // namespace insonify::types
