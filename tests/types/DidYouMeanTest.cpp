#include <gtest/gtest.h>

#include "types/text/DidYouMean.hpp"

namespace insonify::types {
namespace {

const std::vector<std::string> known{"range", "range_min", "bin_count", "sonar::SonarTask", "sonar::ScanningSonarTask"};

TEST(DidYouMeanTest, FindsANameWithLettersMissingAddedChangedOrSwapped) {
    for (const char* wrong : {"rang", "rangee", "renge", "rnage", "Range", "RANGE"})
        EXPECT_EQ(didYouMean(wrong, known), "did you mean range? ") << wrong;
    EXPECT_EQ(didYouMean("bincount", known), "did you mean bin_count? ");
}

TEST(DidYouMeanTest, TheLastPartOrAUniquePartOfANameIsEnough) {
    EXPECT_EQ(didYouMean("SonarTask", known), "did you mean sonar::SonarTask? ");
    EXPECT_EQ(didYouMean("sonar", known), "did you mean sonar::SonarTask? ") << "without Task";
    EXPECT_EQ(didYouMean("count", known), "did you mean bin_count? ");
    EXPECT_EQ(didYouMean("Scanning", known), "did you mean sonar::ScanningSonarTask? ");
}

TEST(DidYouMeanTest, DoesNotGuessADistantName) {
    for (const std::string& wrong : {std::string("depth"), std::string(""), std::string("x"), std::string(100000, 'r')})
        EXPECT_EQ(didYouMean(wrong, known), "") << wrong.substr(0, 20);
    EXPECT_EQ(didYouMean("range", {}), "");
}

}  // namespace
}  // namespace insonify::types
