// The state of a run for systemd, for probes of containers and for scripts.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <csignal>
#include <set>
#include <thread>

#include "components/deployer/Supervision.hpp"
#include "components/framework/Registry.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/Draw.hpp"
#include "tests/support/Variable.hpp"

using namespace insonify;
using namespace insonify::deployer;
using insonify::test::Variable;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using namespace std::chrono_literals;

namespace {

/** The socket of a service manager. */
class Manager {
public:
    /** @param name a path, or "@..." in the abstract name space */
    explicit Manager(const std::string& name) : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        name.copy(address.sun_path, sizeof address.sun_path - 1);
        if (name[0] == '@') address.sun_path[0] = '\0';
        const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
        EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0) << name;
    }
    ~Manager() { close(socket_); }
    /** Returns all messages so far. */
    const std::vector<std::string>& messages() {
        char bytes[4096];
        for (ssize_t got; (got = recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT)) >= 0;)
            all_.emplace_back(bytes, static_cast<size_t>(got));
        return all_;
    }
    long count(const std::string& message) { return std::ranges::count(messages(), message); }
    bool gets(const std::string& message, long times) {
        return test::becomesTrue([&] { return count(message) >= times; });
    }

private:
    int socket_;
    std::vector<std::string> all_;
};

uint16_t freePort() {
    const int probe = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(probe, reinterpret_cast<sockaddr*>(&address), size), 0);
    getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
    close(probe);
    return ntohs(address.sin_port);
}

/** Connects; negative: refused. */
int connected(uint16_t port) {
    const int client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{5, 0};
    setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return client;
    close(client);
    return -1;
}

std::string answerTo(uint16_t port, const std::string& request = "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n") {
    const int client = connected(port);
    std::string answer;
    if (client < 0) return answer;
    send(client, request.data(), request.size(), MSG_NOSIGNAL);
    char bytes[4096];
    for (ssize_t got; (got = recv(client, bytes, sizeof bytes, 0)) > 0;) answer.append(bytes, static_cast<size_t>(got));
    close(client);
    return answer;
}

json getBody(const std::string& answer) { return json::parse(answer.substr(answer.find("\r\n\r\n") + 4)); }

std::atomic<bool> is_held{false}, is_ill{false};

/** Its cycles end unless they are held. */
struct Slug : framework::TaskContext {
    using TaskContext::TaskContext;
    void updateHook() override {
        while (is_held) std::this_thread::sleep_for(1ms);
        if (is_ill) error("has a cold");
    }
    void errorHook() override {
        if (!is_ill) recover();
    }
};

/** A realtime run of one task, supervised. */
class Supervised {
public:
    explicit Supervised(const std::string& health) : supervision_(std::in_place, health) {
        is_held = is_ill = false;
        registry_.add<Slug>("test::Slug", "hangs when it is held");
        deployment_.emplace(framework::DeploymentSpec::parse(
                                "schedule: realtime\ntasks: {slug: {type: test::Slug, activity: {period: 0.01, "
                                "watchdog: 0.2}}}\n",
                                "a.yml"),
                            registry_);
        deployment_->configure();
        supervision_->watch(*deployment_, stop_);
        thread_ = std::thread([this] { deployment_->run({}, stop_); });
    }
    ~Supervised() {
        is_held = false;
        end();
    }
    void stop() { stop_ = true; }
    void end() {
        stop();
        if (thread_.joinable()) thread_.join();
        supervision_.reset();
    }

private:
    framework::Registry registry_;
    std::optional<framework::Deployment> deployment_;
    std::atomic<bool> stop_{false};
    std::optional<Supervision> supervision_;
    std::thread thread_;
};

}  // namespace

TEST(SupervisionTest, SystemdIsToldOfTheStartTheHealthyCyclesAndTheEnd) {
    const TestFolder folder;
    for (const std::string& name : {(folder / "notify").string(), "@insonify-test-" + std::to_string(getpid())}) {
        SCOPED_TRACE(name);
        Manager manager(name);
        const Variable socket("NOTIFY_SOCKET", name), beat("WATCHDOG_USEC", "200000"),
            process("WATCHDOG_PID", std::to_string(getpid()));
        Supervised run("");
        EXPECT_TRUE(manager.gets("WATCHDOG=1", 5));
        EXPECT_EQ(manager.count("READY=1"), 1);
        EXPECT_EQ(manager.messages()[0], "STATUS=loading the deployment");
        EXPECT_LT(std::ranges::find(manager.messages(), "READY=1"),
                  std::ranges::find(manager.messages(), "WATCHDOG=1"));
        EXPECT_TRUE(manager.gets("STATUS=running", 1));

        is_held = true;
        EXPECT_TRUE(manager.gets("STATUS=hanging", 1));
        const long beats = manager.count("WATCHDOG=1");
        std::this_thread::sleep_for(600ms);  // three times as long as the manager waits
        EXPECT_EQ(manager.count("WATCHDOG=1"), beats) << "a task hangs, so the manager will restart the service";
        is_held = false;
        EXPECT_TRUE(manager.gets("WATCHDOG=1", beats + 3));

        is_ill = true;
        EXPECT_TRUE(manager.gets("STATUS=running; slug: has a cold", 1));
        const long then = manager.count("WATCHDOG=1");
        EXPECT_TRUE(manager.gets("WATCHDOG=1", then + 3)) << "an error that it waits out is no reason for a restart";
        run.end();
        EXPECT_EQ(manager.count("READY=1"), 1);
        EXPECT_EQ(manager.count("STOPPING=1"), 1);
    }
}

TEST(SupervisionTest, WithoutAManagerNothingIsSent) {
    unsetenv("NOTIFY_SOCKET");
    EXPECT_FALSE(notifyManager("READY=1"));
    for (const std::string& name : {std::string(), std::string("@"), std::string("/"), std::string("relative"),
                                    std::string("/nowhere/socket"), "/" + std::string(200, 'x')}) {
        const Variable socket("NOTIFY_SOCKET", name);
        EXPECT_FALSE(notifyManager("READY=1")) << name;
    }
    const TestFolder folder;
    Manager manager((folder / "notify").string());
    const Variable socket("NOTIFY_SOCKET", (folder / "notify").string()), beat("WATCHDOG_USEC", "100000"),
        process("WATCHDOG_PID", "1");
    Supervised run("");
    EXPECT_TRUE(manager.gets("STATUS=running", 1));
    EXPECT_EQ(manager.count("WATCHDOG=1"), 0) << "it is expected of another process";
}

TEST(SupervisionTest, APortAnswersWhetherTheRunIsHealthy) {
    const uint16_t port = freePort();
    Supervised run(std::to_string(port));
    ASSERT_TRUE(test::becomesTrue([&] { return answerTo(port).starts_with("HTTP/1.1 200 OK\r\n"); }));
    EXPECT_EQ(getBody(answerTo(port))["state"], "running");
    EXPECT_EQ(getBody(answerTo(port))["healthy"], true);
    is_ill = true;
    EXPECT_TRUE(test::becomesTrue([&] { return getBody(answerTo(port))["errors"]["slug"] == "has a cold"; }));
    is_ill = false;
    for (const std::string& request :
         {std::string("x"), std::string(20'000, 'x'), std::string("POST / HTTP/1.1\r\n\r\n"), std::string("\r\n"),
          std::string(1, '\0')})
        EXPECT_THAT(answerTo(port, request), StartsWith("HTTP/1.1 200 OK\r\n"));
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        test::Draw draw(seed);
        std::string bytes;
        for (int left = 1 + draw.upTo(3000); left > 0; --left) bytes += static_cast<char>(draw.upTo(256));
        EXPECT_THAT(answerTo(port, bytes), StartsWith("HTTP/1.1 200 OK\r\n")) << seed;
    }
    std::vector<int> silent;
    for (int i = 0; i < 40; ++i) silent.push_back(connected(port));
    EXPECT_THAT(answerTo(port), StartsWith("HTTP/1.1 200 OK\r\n")) << "clients that say nothing hold nobody up";
    for (const int client : silent) close(client);

    is_held = true;
    EXPECT_TRUE(test::becomesTrue([&] { return answerTo(port).starts_with("HTTP/1.1 503 Service Unavailable\r\n"); }));
    EXPECT_EQ(getBody(answerTo(port))["state"], "hanging");
    run.stop();
    EXPECT_TRUE(test::becomesTrue([&] { return getBody(answerTo(port))["state"] == "stopping"; }));
    is_held = false;
    run.end();
    EXPECT_EQ(answerTo(port), "") << "nobody listens any more";
}

TEST(SupervisionTest, AFileIsReplacedAsAWhole) {
    const TestFolder folder;
    const fs::path file = folder / "health.json";
    {
        Supervised run(file.string());
        std::set<std::string> states;
        test::becomesTrue([&] {
            const std::string text = readFile(file);
            states.insert(json::parse(text)["state"]);  // throws for a part of it
            is_held = states.contains("running");
            return states.contains("hanging");
        });
        EXPECT_THAT(states, AllOf(Contains("running"), Contains("hanging")));
        EXPECT_EQ(json::parse(readFile(file))["process"], getpid());
    }
    EXPECT_EQ(json::parse(readFile(file))["healthy"], false);
    EXPECT_FALSE(fs::exists(folder / "health.json.part"));
}

TEST(SupervisionTest, APlaceThatCannotBeUsedIsRefused) {
    const WallFolder folder;
    const auto refused = [&](const std::string& where) {
        return callInsonify(folder, {"run", "wall.yml", "--pings", "1", "--out", "o", "--health", where});
    };
    for (const char* port : {"0", "65536", "99999999999", "localhost:80", "1.2.3:80", ":80"})
        EXPECT_THAT(refused(port), isRefused(HasSubstr("--health: is " + std::string(port) + "; may be a file, or ")));
    EXPECT_THAT(refused("nowhere/x.json"), isRefused(HasSubstr("which cannot be written: No such file")));
    fs::create_symlink("target.json", folder / "link.json");
    for (const char* other : {"/dev/null", "link.json"}) {
        EXPECT_THAT(refused(other), isRefused(HasSubstr("it is no regular file")));
        EXPECT_FALSE(fs::is_regular_file(fs::symlink_status(fs::path(folder.path()) / other))) << "it is not replaced";
    }
    EXPECT_THAT(refused("."), isRefused(HasSubstr("which cannot be written")));
    EXPECT_THAT(refused("192.0.2.1:8080"), isRefused(HasSubstr("where no requests can be taken: ")));
    const uint16_t port = freePort();
    Supervision other(std::to_string(port));
    EXPECT_THAT(refused(std::to_string(port)), isRefused(HasSubstr("where no requests can be taken: Address already")));
    EXPECT_FALSE(fs::exists(folder / "o"));
    EXPECT_THAT(refused("health.json"), succeeds());
    const json last = json::parse(readFile(folder / "health.json"));
    EXPECT_EQ(last["state"], "stopping");
    EXPECT_EQ(last["pings"]["sonar.ping"], 1);
}

TEST(SupervisionTest, AServiceIsReadyOnceItPingsAndEndsInOrderOnEachSignal) {
    std::signal(SIGHUP, SIG_DFL);  // under nohup, the tests and their children ignore it
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        const WallFolder folder(realtimeWall());
        Manager manager((folder / "notify").string());
        const Variable socket("NOTIFY_SOCKET", (folder / "notify").string());
        const Process process(insonifyWords({"run", "wall.yml", "--out", "out"}), folder.path());
        EXPECT_TRUE(manager.gets("READY=1", 1));
        EXPECT_TRUE(test::becomesTrue([&] { return fs::exists(folder / "out/wall.0.log"); }));
        process.signal(signal);
        EXPECT_THAT(process.wait(), succeeds());
        EXPECT_EQ(manager.count("STOPPING=1"), 1);
        EXPECT_THAT(callInsonify(folder, {"log", "check", "out/wall.0.log"}), succeeds()) << "with its end";
    }
}

TEST(SupervisionTest, ARunUnderNohupOutlivesItsTerminal) {
    const WallFolder folder(realtimeWall());
    std::vector<std::string> words = insonifyWords({"run", "wall.yml", "--out", "out"});
    words.insert(words.begin(), {"/bin/sh", "-c", "trap '' HUP; exec \"$@\"", "sh"});
    Manager manager((folder / "notify").string());
    const Variable socket("NOTIFY_SOCKET", (folder / "notify").string());
    const Process process(words, folder.path());
    EXPECT_TRUE(manager.gets("READY=1", 1));
    process.signal(SIGHUP);
    std::this_thread::sleep_for(500ms);
    EXPECT_EQ(manager.count("STOPPING=1"), 0);
    process.signal(SIGTERM);
    EXPECT_THAT(process.wait(), succeeds());
}

TEST(SupervisionTest, LinesOfTheJournalHaveTheirPriority) {
    const WallFolder folder(replaced(wall_deployment, "range: 20", "range: 20\n      speed_of_sound: 900"));
    writeFile(folder / "stderr.txt", "");
    struct stat error {};
    ASSERT_EQ(stat((folder / "stderr.txt").c_str(), &error), 0);
    const std::string journal = std::to_string(error.st_dev) + ":" + std::to_string(error.st_ino);
    const auto lines = [&](const std::string& stream, const std::string& range) {
        const Variable variable("JOURNAL_STREAM", stream);
        return callInsonify(folder, {"run", "wall.yml", "--pings", "1", "--out", "o", "--set", "sonar.range=" + range})
            .err;
    };
    EXPECT_THAT(lines(journal, "20"), HasSubstr("<4>warning: sonar: "));
    EXPECT_THAT(lines("1:2", "20"), AllOf(HasSubstr("warning: sonar: "), Not(HasSubstr("<4>"))));
    EXPECT_THAT(lines(journal, "-1"), StartsWith("<3>"));
    EXPECT_THAT(lines(journal, "20"), HasSubstr("<5>notice: ")) << "the folder has files already";
}
