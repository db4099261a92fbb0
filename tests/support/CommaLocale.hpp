#pragma once
// A host with a decimal comma.
//
//     const CommaLocale german;
//     if (!german.isThere()) GTEST_SKIP() << german.why();
#include <clocale>
#include <cstdlib>
#include <string>

#include "tests/support/Folder.hpp"

namespace insonify::test {

/** Sets the process to German numbers, 0,5, for the duration of a test. The locale is made in a temporary folder. */
class CommaLocale {
public:
    CommaLocale() {
        const std::string command = "localedef -i de_DE -f UTF-8 " + (folder_ / "de_DE.UTF-8").string() + " 2>&1";
        if (std::system((command + " > /dev/null").c_str()) < 0) return;
        setenv("LOCPATH", folder_.path().c_str(), 1);
        is_there_ = std::setlocale(LC_NUMERIC, "de_DE.UTF-8") && *std::localeconv()->decimal_point == ',';
    }
    ~CommaLocale() {
        std::setlocale(LC_NUMERIC, "C");
        unsetenv("LOCPATH");
    }
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;
    bool isThere() const { return is_there_; }
    static const char* why() { return "SKIPPED: localedef makes no de_DE here; the Debian package locales has it"; }

private:
    const Folder folder_;
    bool is_there_ = false;
};

}  // namespace insonify::test
