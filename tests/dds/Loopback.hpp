#pragma once
// A separate DDS domain of the test on the loopback interface, and other peers in it.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <random>
#include <string>

#include "tests/support/Peer.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::dds {

using test::becomesTrue;

/** A DDS domain that no other test in this network uses during its lifetime. Its ports are below those that the system
 *  assigns. */
class OwnDomain {
public:
    OwnDomain() {
        std::random_device random;
        do number_ = 20 + static_cast<int>(random() % 80);
        while (!isFree());
    }
    ~OwnDomain() { close(socket_); }
    OwnDomain(const OwnDomain&) = delete;
    OwnDomain& operator=(const OwnDomain&) = delete;
    int number() const { return number_; }

private:
    /** Reserves a name for the domain, without a file. */
    bool isFree() {
        socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        const std::string name = "insonify-test-domain-" + std::to_string(number_);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        name.copy(address.sun_path + 1, name.size());
        const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
        if (bind(socket_, reinterpret_cast<sockaddr*>(&address), size) == 0) return true;
        close(socket_);
        return false;
    }

    int number_ = 0, socket_ = -1;
};

/** Tests in a separate domain; `lo` has no multicast. */
struct Loopback : testing::Test {
    Loopback() {
        constexpr const char* settings =
            "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
            "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
            "<MaxAutoParticipantIndex>40</MaxAutoParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers>"
            "</Discovery></Domain></CycloneDDS>";
        setenv("CYCLONEDDS_URI", settings, 1);
        setenv("ROS_DOMAIN_ID", std::to_string(domain_.number()).c_str(), 1);
    }

private:
    const OwnDomain domain_;
};

/** A peer with another DDS implementation, which prints that it is ready, then its findings. */
class Peer : public test::Peer {
public:
    /** Runs a command of peer.py: "listen PoseStamped /pose 2" */
    explicit Peer(const std::string& command) : test::Peer("tests/dds/peer.py", command) {}
    /** Runs a program with its arguments. */
    explicit Peer(std::vector<std::string> words) : test::Peer(std::move(words)) {}
    /** Returns whether PyPI's cyclonedds is installed. */
    static bool available() { return pythonHas("cyclonedds"); }
    bool ready() const { return ready_; }
    /** Sends greetings until a listener has received one; it then receives all that is sent. */
    bool meets(auto&& greet) const {
        return becomesTrue([&] { return greet(), hasSaid("met"); });
    }
    /** Starts a sender, whose first greeting has arrived. */
    void begin() const { signal(SIGUSR1); }
    /** Returns whether the peer has printed its findings. */
    bool hasEnded() const { return hasSaid("{"); }
    /** Returns its findings; null, with a test failure, if it ended otherwise. */
    nlohmann::json result() {
        const deployer::Outcome outcome = wait();
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const size_t begin = outcome.out.find('{');
        return outcome.code == 0 && begin != std::string::npos ? nlohmann::json::parse(outcome.out.substr(begin))
                                                               : nlohmann::json();
    }

private:
    const bool ready_ = becomesTrue([&] { return hasSaid("ready"); });
};

/** For tests with a peer. */
struct WithPeer : Loopback {
    void SetUp() override {
        if (!Peer::available())
            GTEST_SKIP() << "PyPI's cyclonedds is not in " << python() << ": scripts/setup puts it there";
    }
};

}  // namespace insonify::dds
