#pragma once
// A program that runs during a test.
#include <signal.h>

#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

namespace insonify::test {

/** A process that runs until it ends, or until this object is destroyed. */
class Peer {
public:
    /** Starts a program with its arguments. */
    explicit Peer(std::vector<std::string> words) { process_.emplace(std::move(words), folder_.path()); }
    /** Starts a Python script by its path from the root, with its arguments: "listen PoseStamped /pose 2". */
    Peer(const std::string& script, const std::string& arguments) : Peer(splitWords(script, arguments)) {}
    ~Peer() {
        if (!process_) return;
        signal(SIGKILL);
        process_->wait();
    }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    /** Returns whether its output contains this text. */
    bool hasSaid(const std::string& text) const {
        return deployer::readFile(folder_ / "stdout.txt").find(text) != std::string::npos;
    }
    void signal(int number) const { process_->signal(number); }
    /** Waits for the end, and returns the outcome. */
    deployer::Outcome wait() {
        const deployer::Outcome outcome = process_->wait();
        process_.reset();
        return outcome;
    }

private:
    static std::vector<std::string> splitWords(const std::string& script, const std::string& arguments) {
        std::vector<std::string> words = {python(), sourceFile(script)};
        std::istringstream text(arguments);
        for (std::string word; text >> word;) words.push_back(word);
        return words;
    }

    deployer::TestFolder folder_;
    std::optional<deployer::Process> process_;
};

}  // namespace insonify::test
