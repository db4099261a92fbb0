// deploy/insonify.service, checked by systemd.
#include <gmock/gmock.h>

#include <map>

#include "tests/install/Outside.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;

namespace {

const fs::path unit = fs::path(insonify::test::source_dir) / "deploy/insonify.service";

std::map<std::string, std::string> getSettings(const std::string& text) {
    std::map<std::string, std::string> settings;
    std::istringstream lines(text);
    std::string section;
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line[0] == '#') continue;
        const size_t equals = line.find('=');
        if (line[0] == '[')
            section = line;
        else if (equals == std::string::npos || section.empty())
            throw std::runtime_error("is no setting: " + line);
        else
            settings[section + line.substr(0, equals)] = line.substr(equals + 1);
    }
    return settings;
}

}  // namespace

TEST(ServiceTest, StopsWithSigintRestartsAfterAFailureAndMayUseRealtime) {
    const auto settings = getSettings(readFile(unit));
    const std::map<std::string, std::string> expected = {{"[Service]Type", "notify"},
                                                         {"[Service]WatchdogSec", "30"},
                                                         {"[Service]KillSignal", "SIGINT"},
                                                         {"[Service]Restart", "on-failure"},
                                                         {"[Service]RestartPreventExitStatus", "2"},
                                                         {"[Service]LimitRTPRIO", "80"},
                                                         {"[Service]LimitMEMLOCK", "infinity"},
                                                         {"[Service]CPUAffinity", "0 1"},
                                                         {"[Install]WantedBy", "multi-user.target"}};
    EXPECT_THAT(settings, testing::IsSupersetOf(expected));
    EXPECT_TRUE(settings.at("[Service]ExecStart").starts_with("insonify run "))
        << "in /usr/bin or /usr/local/bin, both of which systemd searches";
}

TEST(ServiceTest, SystemdFindsNothingWrongWithIt) {
    const TestFolder folder;
    if (call(folder, {"systemd-analyze", "--version"}).code != 0) GTEST_SKIP() << "there is no systemd-analyze here";
    // The command must exist; here it is not where systemd searches.
    std::string text = readFile(unit);
    text = replaced(text, "ExecStart=insonify", "ExecStart=" + insonify::test::program("insonify"));
    writeFile(folder / "insonify.service", text);
    const Outcome outcome = call(folder, {"systemd-analyze", "verify", "--man=no", folder / "insonify.service"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    writeFile(folder / "insonify.service", replaced(text, "KillSignal=SIGINT", "KillSignal=SIGNONE"));
    EXPECT_NE(call(folder, {"systemd-analyze", "verify", "--man=no", folder / "insonify.service"}).err, "");
}
