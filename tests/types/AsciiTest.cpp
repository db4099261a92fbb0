#include <gtest/gtest.h>

#include <cctype>
#include <clocale>
#include <cstdlib>

#include "tests/support/Folder.hpp"
#include "types/text/DidYouMean.hpp"
#include "types/text/RosNames.hpp"

namespace insonify::types {
namespace {

/** Sets the process to a locale of 8 bits, in which std::isalnum takes bytes above 127 for letters. */
class LatinLocale {
public:
    LatinLocale() {
        const std::string command = "localedef -i de_DE -f ISO-8859-1 " + (folder_ / "de_DE").string();
        if (std::system((command + " > /dev/null 2>&1").c_str()) < 0) return;
        setenv("LOCPATH", folder_.path().c_str(), 1);
        is_there_ = std::setlocale(LC_ALL, "de_DE") && std::isalnum(0xE4);
    }
    ~LatinLocale() {
        std::setlocale(LC_ALL, "C");
        unsetenv("LOCPATH");
    }
    LatinLocale(const LatinLocale&) = delete;
    LatinLocale& operator=(const LatinLocale&) = delete;
    bool isThere() const { return is_there_; }

private:
    const Folder folder_;
    bool is_there_ = false;
};

void expectLettersOfAscii() {
    const std::string upper = "ABCDEFGHIJKLMNOPQRSTUVWXYZ", lower = "abcdefghijklmnopqrstuvwxyz", digits = "0123456789";
    for (int byte = 0; byte < 256; ++byte) {
        const char c = static_cast<char>(byte);
        const size_t of_upper = upper.find(c), of_lower = lower.find(c);
        EXPECT_EQ(isUpperLetter(c), of_upper != upper.npos) << byte;
        EXPECT_EQ(isLowerLetter(c), of_lower != lower.npos) << byte;
        EXPECT_EQ(isLetter(c), of_upper != upper.npos || of_lower != lower.npos) << byte;
        EXPECT_EQ(isDigit(c), digits.find(c) != digits.npos) << byte;
        EXPECT_EQ(lowered(c), of_upper == upper.npos ? c : lower[of_upper]) << byte;
        EXPECT_EQ(raised(c), of_lower == lower.npos ? c : upper[of_lower]) << byte;
    }
    EXPECT_EQ(lowered("Kette_\xC4"
                      " 42"),
              "kette_\xC4"
              " 42");
}

}  // namespace

TEST(AsciiTest, LettersAreThoseOfAscii) { expectLettersOfAscii(); }

TEST(AsciiTest, NamesAreTheSameInALocaleOf8Bits) {
    const LatinLocale german;
    if (!german.isThere()) GTEST_SKIP() << "SKIPPED: localedef makes no de_DE here; the Debian package locales has it";
    expectLettersOfAscii();
    EXPECT_FALSE(
        isRosName("k\xE4"
                  "fer"));
    EXPECT_TRUE(isRosName("kaefer"));
}

}  // namespace insonify::types
