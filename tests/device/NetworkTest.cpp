// The ends on which drivers find a device, with real clients on this machine.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "components/device/wire/Network.hpp"
#include "tests/support/Folder.hpp"

namespace insonify::device {
namespace {

using Kind = NetworkEvent::Kind;
using namespace std::chrono_literals;

/** A driver's end of a connection, of datagrams or of a line. */
class Peer {
public:
    Peer(int type, uint16_t port) : file_(socket(AF_INET, type, 0)) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(port);
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(connect(file_, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
    }
    explicit Peer(const std::filesystem::path& line) : file_(open(line.c_str(), O_RDWR | O_NOCTTY)) {
        termios raw{};
        cfmakeraw(&raw);
        tcsetattr(file_, TCSANOW, &raw);
    }
    ~Peer() { close(file_); }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;
    void say(const Bytes& bytes) const { EXPECT_EQ(::write(file_, bytes.data(), bytes.size()), ssize_t(bytes.size())); }
    /** Reads `count` bytes, or fewer if the end closes or falls silent. */
    Bytes nextBytes(size_t count) const {
        Bytes bytes;
        for (pollfd ready{file_, POLLIN, 0}; bytes.size() < count && poll(&ready, 1, 5000) == 1;) {
            Bytes part(count - bytes.size());
            const ssize_t got = ::read(file_, part.data(), part.size());
            if (got <= 0) break;
            bytes.insert(bytes.end(), part.begin(), part.begin() + got);
        }
        return bytes;
    }

    /** Stops the writer. */
    void hangUp() const { shutdown(file_, SHUT_RDWR); }

private:
    int file_;
};

struct NetworkTest : testing::Test {
    /** Returns the next events, as soon as there are enough of a kind; fewer after ten seconds. */
    std::vector<NetworkEvent> await(Kind kind, size_t count = 1) { return await(network_, kind, count); }
    static std::vector<NetworkEvent> await(Network& network, Kind kind, size_t count = 1) {
        std::vector<NetworkEvent> all;
        const auto end = std::chrono::steady_clock::now() + 10s;
        while (std::ranges::count(all, kind, &NetworkEvent::kind) < std::ptrdiff_t(count)) {
            if (std::chrono::steady_clock::now() > end) break;
            for (NetworkEvent& event : network.take()) all.push_back(std::move(event));
            std::this_thread::sleep_for(1ms);
        }
        return all;
    }

    std::atomic<int> woken_{0};
    Network network_{[this] { ++woken_; }};
};

TEST_F(NetworkTest, TransfersBytesByConnectionDatagramAndLine) {
    const Folder folder;
    const End tcp = network_.listenTcp("127.0.0.1", 0), udp = network_.listenUdp("127.0.0.1", 0);
    network_.openSerial(folder / "line");
    const Peer a(SOCK_STREAM, network_.getPort(tcp)), b(SOCK_DGRAM, network_.getPort(udp)), c(folder / "line");
    for (const Peer* peer : {&a, &b, &c}) {
        peer->say({1, 2, 3});
        const NetworkEvent got = await(Kind::Received).back();
        EXPECT_THAT(got.bytes, testing::ElementsAre(1, 2, 3));
        network_.send(got.client, {9, 8});
        EXPECT_THAT(peer->nextBytes(2), testing::ElementsAre(9, 8));
    }
    EXPECT_GE(woken_, 3);
    EXPECT_THAT(network_.names(),
                testing::ElementsAre(testing::StartsWith("TCP 127.0.0.1:"), testing::StartsWith("UDP 127.0.0.1:"),
                                     "serial line " + (folder / "line").string()));
}

TEST_F(NetworkTest, ALineOutlivesDriversAndRemovesItsLink) {
    const Folder folder;
    {
        Network network([] {});
        network.openSerial(folder / "line");
        for (uint8_t i = 0; i < 3; ++i) {
            const Peer driver(folder / "line");
            driver.say({i});
            const auto events = await(network, Kind::Received);
            ASSERT_FALSE(events.empty());
            EXPECT_EQ(events.back().bytes, Bytes{i});
        }
    }
    EXPECT_FALSE(std::filesystem::is_symlink(folder / "line"));
}

TEST_F(NetworkTest, ADriverThatOpensALineReadsFewOldBytesAndTheNewest) {
    const Folder folder;
    network_.openSerial(folder / "line");
    const Client line = await(Kind::Opened).back().client;
    constexpr size_t packets = 10'000, size = 100, little = 32'768;
    for (size_t i = 0; i < packets; ++i) network_.send(line, Bytes(size, static_cast<uint8_t>(i % 200)));
    network_.send(line, Bytes(size, 255));
    network_.listenTcp("127.0.0.1", 0);  // once all have been read
    EXPECT_GT(network_.dropped(), packets / 2);
    const Peer driver(folder / "line");
    size_t past = 0;
    Bytes next;
    while (past <= little && !(next = driver.nextBytes(1)).empty() && next[0] != 255) ++past;
    EXPECT_LE(past, little) << "of " << packets * size;
    EXPECT_THAT(next, testing::ElementsAre(255));
    EXPECT_EQ(driver.nextBytes(size - 1), Bytes(size - 1, 255));
}

TEST_F(NetworkTest, AThousandReconnectsLeakNoClientAndNoFile) {
    const auto openFiles = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                             std::filesystem::directory_iterator());
    };
    const End end = network_.listenTcp("127.0.0.1", 0);
    const auto before = openFiles();
    std::vector<NetworkEvent> all;
    for (int i = 0; i < 1000; ++i) {
        const Peer peer(SOCK_STREAM, network_.getPort(end));
        peer.say({1});
        for (NetworkEvent& event : await(Kind::Received)) all.push_back(std::move(event));
    }
    const auto closed = [&] { return std::ranges::count(all, Kind::Closed, &NetworkEvent::kind); };
    for (NetworkEvent& event : await(Kind::Closed, static_cast<size_t>(1000 - closed())))
        all.push_back(std::move(event));
    EXPECT_EQ(closed(), 1000);
    EXPECT_EQ(std::ranges::count(all, Kind::Opened, &NetworkEvent::kind), 1000);
    EXPECT_EQ(openFiles(), before);
}

TEST_F(NetworkTest, AClientThatDoesNotReadLosesStreamedMessagesAndDelaysNoOther) {
    const End end = network_.listenTcp("127.0.0.1", 0);
    const Peer deaf(SOCK_STREAM, network_.getPort(end));
    const Client never = await(Kind::Opened).back().client;
    const Peer other(SOCK_STREAM, network_.getPort(end));
    const Client reads = await(Kind::Opened).back().client;
    for (int i = 0; i < 200; ++i) network_.send(never, Bytes(1 << 20, 7), Network::Kind::Stream);
    network_.send(reads, {5});
    EXPECT_THAT(other.nextBytes(1), testing::ElementsAre(5));
    EXPECT_GT(network_.dropped(), 100u);
    for (int i = 0; i < 30; ++i) network_.send(never, Bytes(1 << 20, 7));
    const NetworkEvent closed = await(Kind::Closed).back();
    EXPECT_EQ(closed.client, never) << "for whom too much waits that must arrive";
}

TEST_F(NetworkTest, AnEndlessSenderIsReadAtTheSpeedOfTheTask) {
    const End end = network_.listenTcp("127.0.0.1", 0);
    const Peer peer(SOCK_STREAM, network_.getPort(end));
    std::thread sender([&] { peer.say(Bytes(size_t{16} << 20, 3)); });
    std::this_thread::sleep_for(200ms);
    size_t maximum = 0, total = 0;
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (total < size_t{16} << 20 && std::chrono::steady_clock::now() < deadline) {
        size_t part = 0;
        for (const NetworkEvent& event : network_.take()) part += event.bytes.size();
        maximum = std::max(maximum, part);
        total += part;
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(total, size_t{16} << 20);
    peer.hangUp();
    sender.join();
    EXPECT_LE(maximum, Network::max_received + 65536);
}

TEST_F(NetworkTest, AClosedClientReceivesEarlierMessages) {
    const End end = network_.listenTcp("127.0.0.1", 0);
    const Peer peer(SOCK_STREAM, network_.getPort(end));
    const Client client = await(Kind::Opened).back().client;
    network_.send(client, Bytes(100'000, 4));
    network_.close(client);
    EXPECT_EQ(peer.nextBytes(100'001).size(), 100'000u);
    EXPECT_EQ(await(Kind::Closed).back().client, client);
}

/** Silent clients block no new clients. */
TEST_F(NetworkTest, ANewConnectionReplacesTheOneSilentForLongest) {
    const End end = network_.listenTcp("127.0.0.1", 0);
    std::vector<std::unique_ptr<Peer>> peers;
    std::vector<Client> clients;
    for (size_t i = 0; i < Network::max_clients; ++i) {
        peers.push_back(std::make_unique<Peer>(SOCK_STREAM, network_.getPort(end)));
        clients.push_back(await(Kind::Opened).back().client);
        if (i == 5) continue;
        peers.back()->say({1});
        await(Kind::Received);
    }
    const Peer newer(SOCK_STREAM, network_.getPort(end));
    const auto events = await(Kind::Opened);
    ASSERT_GE(events.size(), 2u);
    EXPECT_EQ(events.front().kind, Kind::Closed);
    EXPECT_EQ(events.front().client, clients[5]) << "it has never sent anything";
    EXPECT_TRUE(peers[5]->nextBytes(1).empty());
    network_.send(events.back().client, {7});
    EXPECT_THAT(newer.nextBytes(1), testing::ElementsAre(7));
    network_.send(clients[0], {8});
    EXPECT_THAT(peers[0]->nextBytes(1), testing::ElementsAre(8));
    EXPECT_EQ(network_.displaced(), 1u);
}

TEST_F(NetworkTest, CountsAFailureOfTheThreadAndContinues) {
    std::atomic<bool> fails{false};
    Network network([&] {
        if (fails.exchange(false)) throw std::bad_alloc();
    });
    const End streams = network.listenTcp("127.0.0.1", 0), datagrams = network.listenUdp("127.0.0.1", 0);
    const Peer stream(SOCK_STREAM, network.getPort(streams)), datagram(SOCK_DGRAM, network.getPort(datagrams));
    await(network, Kind::Opened);
    for (const Peer* peer : {&stream, &datagram})
        for (int i = 0; i < 3; ++i) {
            fails = i == 1;
            peer->say({static_cast<uint8_t>(i)});
            EXPECT_FALSE(await(network, Kind::Received).empty());
        }
    fails = true;
    const Peer second(SOCK_STREAM, network.getPort(streams)), third(SOCK_STREAM, network.getPort(streams));
    EXPECT_EQ(await(network, Kind::Opened, 2).size(), 2u);
    EXPECT_EQ(network.failures(), 3u);
}

TEST_F(NetworkTest, DatagramsReachTheirReceiver) {
    const End end = network_.listenUdp("127.0.0.1", 0);
    network_.sendTo("127.0.0.1", network_.getPort(end), {6, 6});
    EXPECT_THAT(await(Kind::Received).back().bytes, testing::ElementsAre(6, 6));
}

TEST_F(NetworkTest, ForgetsTheDatagramClientSilentForLongest) {
    const uint16_t port = network_.getPort(network_.listenUdp("127.0.0.1", 0));
    const Peer talks(SOCK_DGRAM, port);
    talks.say({1});
    const Client stays = await(Kind::Received).back().client;
    std::vector<std::unique_ptr<Peer>> others;
    std::vector<Client> gone;
    for (size_t i = 0; i < Network::max_clients; ++i) {
        others.push_back(std::make_unique<Peer>(SOCK_DGRAM, port));
        for (const Peer* peer : {static_cast<const Peer*>(others.back().get()), &talks}) {
            peer->say({2});
            for (const NetworkEvent& event : await(Kind::Received))
                if (event.kind == Kind::Closed) gone.push_back(event.client);
        }
    }
    EXPECT_THAT(gone, testing::ElementsAre(Client{stays.end, stays.number + 1})) << "the first of the others";
    network_.send(stays, {7});
    EXPECT_THAT(talks.nextBytes(1), testing::ElementsAre(7));
}

TEST_F(NetworkTest, EmptyDatagramsAreBounded) {
    const Peer peer(SOCK_DGRAM, network_.getPort(network_.listenUdp("127.0.0.1", 0)));
    const auto end = std::chrono::steady_clock::now() + 60s;
    while (network_.dropped() == 0 && std::chrono::steady_clock::now() < end) {
        for (int i = 0; i < 100; ++i) peer.say({});
        std::this_thread::sleep_for(1ms);  // time to read them
    }
    EXPECT_GT(network_.dropped(), 0u);
    EXPECT_LE(network_.take().size(), Network::max_received / sizeof(NetworkEvent) + 1);
}

TEST_F(NetworkTest, ConnectionsUseKeepAlive) {
    const uint16_t port = network_.getPort(network_.listenTcp("127.0.0.1", 0));
    const Peer peer(SOCK_STREAM, port);
    await(Kind::Opened);
    const auto getOption = [](int file, int level, int option) {
        int value = 0;
        socklen_t size = sizeof value;
        getsockopt(file, level, option, &value, &size);
        return value;
    };
    int found = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        const int file = std::stoi(entry.path().filename());
        sockaddr_in own{}, other{};
        socklen_t own_size = sizeof own, other_size = sizeof other;
        if (getsockname(file, reinterpret_cast<sockaddr*>(&own), &own_size) != 0 || own.sin_port != htons(port) ||
            getpeername(file, reinterpret_cast<sockaddr*>(&other), &other_size) != 0)
            continue;
        ++found;
        EXPECT_EQ(getOption(file, SOL_SOCKET, SO_KEEPALIVE), 1);
        EXPECT_EQ(getOption(file, IPPROTO_TCP, TCP_KEEPIDLE), 10);
        EXPECT_EQ(getOption(file, IPPROTO_TCP, TCP_KEEPINTVL), 5);
        EXPECT_EQ(getOption(file, IPPROTO_TCP, TCP_KEEPCNT), 3);
    }
    EXPECT_EQ(found, 1);
}

TEST_F(NetworkTest, WakesAtTheGivenTime) {
    const auto begin = std::chrono::steady_clock::now();
    network_.wakeAt(begin + 10s);
    network_.wakeAt(begin + 50ms);
    while (woken_ == 0 && std::chrono::steady_clock::now() < begin + 5s) std::this_thread::sleep_for(1ms);
    EXPECT_EQ(woken_, 1);
    EXPECT_GE(std::chrono::steady_clock::now(), begin + 50ms);
}

TEST_F(NetworkTest, ReportsWhyAnEndCannotBeOpened) {
    const uint16_t taken = network_.getPort(network_.listenTcp("127.0.0.1", 0));
    const auto getWhy = [](auto&& open) -> std::string {
        try {
            open();
        } catch (const NetworkError& error) {
            return error.property + ": " + error.what();
        }
        return "";
    };
    EXPECT_EQ(getWhy([&] { network_.listenTcp("127.0.0.1", taken); }),
              "port: is 127.0.0.1:" + std::to_string(taken) + ", where it cannot listen: Address already in use");
    EXPECT_EQ(getWhy([&] { network_.listenUdp("sonar", 1); }),
              "address: is sonar, which is no address; write one as 127.0.0.1 or ::1");
    EXPECT_THAT(getWhy([&] { network_.openSerial("/nowhere/line"); }),
                testing::StartsWith("serial: is /nowhere/line, which cannot be made: "));
    EXPECT_THAT(getWhy([&] { network_.sendTo("", 1, {}); }), testing::HasSubstr("no address"));
}

TEST(NetworkSerialTest, LeavesALinkThatIsNoLineAndAnAbsentFolderAsTheyAre) {
    const Folder folder;
    const auto failure = [](const std::filesystem::path& link) {
        try {
            Network network([] {});
            network.openSerial(link);
        } catch (const NetworkError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto descriptors = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                             std::filesystem::directory_iterator());
    };
    std::filesystem::create_symlink("/dev/null", folder / "by-id");
    std::filesystem::create_symlink("nowhere", folder / "broken");
    std::filesystem::create_symlink("loop", folder / "loop");
    EXPECT_THAT(failure(folder / "by-id"), ::testing::HasSubstr("File exists"));
    const auto before = descriptors();
    for (int i = 0; i < 5; ++i) {
        EXPECT_THAT(failure(folder / "by-id"), ::testing::HasSubstr("File exists"));
        EXPECT_THAT(failure(folder / "broken"), ::testing::HasSubstr("File exists"));
        EXPECT_THAT(failure(folder / "no" / "line"), ::testing::HasSubstr("cannot be made"));
        EXPECT_THAT(failure(folder / "loop" / "line"), ::testing::HasSubstr("cannot be made"));
        EXPECT_THAT(failure(folder / std::string(300, 'x')), ::testing::HasSubstr("cannot be made"));
    }
    EXPECT_EQ(descriptors(), before);
    EXPECT_EQ(std::filesystem::read_symlink(folder / "by-id"), "/dev/null");
    std::filesystem::create_symlink("/dev/pts/999999", folder / "left");
    EXPECT_EQ(failure(folder / "left"), "") << "of a process that was killed";
    EXPECT_FALSE(std::filesystem::is_symlink(folder / "left"));
}

}  // namespace
}  // namespace insonify::device
