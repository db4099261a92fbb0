#pragma once
// A DDS domain of the test's own on the loopback interface, and other peers on it.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <thread>

#include "tests/deployer/Command.hpp"
#include "tests/support/Python.hpp"

namespace insonify::dds {

/** Waits until it holds, 10 s at most. */
template <class Condition>
bool becomes(Condition&& condition, double seconds = 10) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!condition())
        if (std::chrono::steady_clock::now() > end)
            return false;
        else
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return true;
}

/** Tests in a domain of a random number, where `lo` has no multicast. */
class Loopback : public testing::Test {
protected:
    Loopback() {
        constexpr const char* settings =
            "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
            "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
            "<MaxAutoParticipantIndex>40</MaxAutoParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers>"
            "</Discovery></Domain></CycloneDDS>";
        setenv("CYCLONEDDS_URI", settings, 1);
        setenv("ROS_DOMAIN_ID", std::to_string(std::random_device()() % 200 + 20).c_str(), 1);
    }
};

/** A peer by another DDS, which says when it is ready, then what it found. It is stopped at the end. */
class Peer {
public:
    /** Of peer.py: "listen PoseStamped /pose 2" */
    explicit Peer(const std::string& command) : Peer(wordsOf(command)) {}
    /** A program and its arguments. */
    explicit Peer(std::vector<std::string> words) {
        process_.emplace(std::move(words), folder_.path());
        ready_ = becomes([&] { return deployer::readFile(folder_ / "stdout.txt").starts_with("ready"); }, 30);
    }
    ~Peer() {
        if (!process_) return;
        signal(SIGKILL);
        process_->wait();
    }
    /** Whether PyPI's cyclonedds is here. */
    static bool available() { return pythonHas("cyclonedds"); }
    bool ready() const { return ready_; }
    void signal(int number) const { process_->signal(number); }
    /** What it found; null, with a failure, if it ended otherwise. */
    nlohmann::json result() {
        const deployer::Outcome outcome = process_->wait();
        process_.reset();
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const size_t begin = outcome.out.find('{');
        return outcome.code == 0 && begin != std::string::npos ? nlohmann::json::parse(outcome.out.substr(begin))
                                                               : nlohmann::json();
    }

private:
    static std::vector<std::string> wordsOf(std::string command) {
        std::vector<std::string> words = {python(), INSONIFY_SOURCE_DIR "/tests/dds/peer.py"};
        for (std::istringstream text(command); text >> command;) words.push_back(command);
        return words;
    }

    deployer::TestFolder folder_;
    std::optional<deployer::Process> process_;
    bool ready_ = false;
};

/** For tests with a peer. */
class WithPeer : public Loopback {
protected:
    void SetUp() override {
        if (!Peer::available())
            GTEST_SKIP() << "PyPI's cyclonedds is not in " << python() << ": scripts/setup puts it there";
    }
};

}  // namespace insonify::dds
