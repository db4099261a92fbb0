#pragma once
// The `insonify` command as a separate process: its exit code and its output.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/Folder.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::deployer {

namespace fs = std::filesystem;
using nlohmann::json;

inline std::string readFile(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

inline void writeFile(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

using TestFolder = Folder;

struct Outcome {
    int code = -1;  ///< Exit code; minus the signal that killed it.
    std::string out, err;
};
inline std::ostream& operator<<(std::ostream& stream, const Outcome& outcome) {
    return stream << "code " << outcome.code << ", output: " << outcome.out << ", errors: " << outcome.err;
}

/** Matches the outcome of a command that is refused with this message. */
inline auto isRefused(const testing::Matcher<const std::string&>& message) {
    return testing::AllOf(testing::Field("code", &Outcome::code, 2), testing::Field("err", &Outcome::err, message));
}
inline auto succeeds() { return testing::Field("code", &Outcome::code, 0); }
/** Matches the outcome of a command that succeeds with this output. */
inline auto prints(const testing::Matcher<const std::string&>& output) {
    return testing::AllOf(succeeds(), testing::Field("out", &Outcome::out, output));
}

/** A running program; its output is written to files in `folder`, which is also its current folder. */
class Process {
public:
    Process(std::vector<std::string> words, fs::path folder) : folder_(std::move(folder)) {
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        const std::string out = folder_ / "stdout.txt", err = folder_ / "stderr.txt";
        pid_ = fork();
        if (pid_ != 0) return;
        if (chdir(folder_.c_str()) == 0 && redirect(out, STDOUT_FILENO) && redirect(err, STDERR_FILENO))
            execvp(arguments[0], arguments.data());
        _exit(127);
    }
    void signal(int number) const { kill(pid_, number); }
    Outcome wait() const {
        int status = 0;
        waitpid(pid_, &status, 0);
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        return {code, readFile(folder_ / "stdout.txt"), readFile(folder_ / "stderr.txt")};
    }

private:
    static bool redirect(const std::string& file, int descriptor) {
        const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        return opened >= 0 && dup2(opened, descriptor) >= 0;
    }

    fs::path folder_;
    pid_t pid_ = -1;
};

inline std::vector<std::string> insonifyWords(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), test::program("insonify"));
    return arguments;
}

inline Outcome callInsonify(const TestFolder& folder, std::vector<std::string> arguments) {
    return Process(insonifyWords(std::move(arguments)), folder.path()).wait();
}

/** Returns the output of a successful command with --json. */
inline json makeJson(const TestFolder& folder, std::vector<std::string> arguments) {
    arguments.push_back("--json");
    const Outcome outcome = callInsonify(folder, std::move(arguments));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out);
}

/** Waits until a program has written something to its error output. */
inline bool says(const TestFolder& folder, const std::string& text) {
    return test::becomesTrue([&] { return readFile(folder / "stderr.txt").find(text) != std::string::npos; });
}

/** Runs a program in Debian's Python, which has numpy; returns its output. */
inline Outcome python(const TestFolder& folder, const std::string& program) {
    return Process({"/usr/bin/python3", "-c", program}, folder.path()).wait();
}

}  // namespace insonify::deployer
