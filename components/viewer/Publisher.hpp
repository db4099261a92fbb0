#pragma once
#include <arpa/inet.h>

#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "components/ros/Options.hpp"
#include "components/viewer/Messages.hpp"
#include "components/viewer/PingPicture.hpp"
#include "components/viewer/Server.hpp"
#include "types/samples/DeploymentControl.hpp"
#include "types/text/Describe.hpp"

namespace insonify::viewer {

struct ViewerConfig {
    int port = 8765;
    std::string address = "127.0.0.1";
    std::string token, token_file;
    int clients = 16;
    double idle_timeout = 30;
    bool control = true;
    int max_triangles = 500000;
    ros::WorldFrame world_frame = ros::WorldFrame::Enu;
    ros::SonarOptions messages;

    static void describe(auto& self, auto& visit) {
        visit({"port", "1", "TCP port of the page and of Foxglove; 0: any free port, printed in a notice", 0, 65535},
              self.port);
        visit({"address", "", "numeric address to listen on; an address other than loopback requires a token"},
              self.address);
        visit({"token", "", "required from clients: http://address:port/?token=...; empty: none"}, self.token);
        visit({"token_file", "",
               "a file whose first line is the token, relative to the deployment; logs then do not contain the token"},
              self.token_file);
        visit({"clients", "1", "max number of connected clients; others are refused", 1, 1000}, self.clients);
        visit({"idle_timeout", "s", "a client that has not answered for this long is disconnected", 1, 3600},
              self.idle_timeout);
        visit({"control", "", "whether pages may set properties, call operations and pause; else they only show"},
              self.control);
        visit({"max_triangles", "1",
               "max triangles of the page's scene; above, large meshes are coarse, small meshes omitted", 1000, 1e8},
              self.max_triangles);
        visit({"world_frame", "",
               "axes of poses for Foxglove: ours (x north, y west, z up), x east, y north, z up, or x north, y "
               "east, z down"},
              self.world_frame);
        visit({"messages", "", "how pings become messages for Foxglove; `scale` also applies to the page"},
              self.messages);
    }

    bool isLocal() const {
        in_addr v4{};
        return address == "::1" || (inet_pton(AF_INET, address.c_str(), &v4) == 1 && ntohl(v4.s_addr) >> 24 == 127);
    }
    bool isNumeric() const {
        in6_addr any{};
        return inet_pton(AF_INET, address.c_str(), &any) == 1 || inet_pton(AF_INET6, address.c_str(), &any) == 1;
    }
    void check(types::Diagnostics& diagnostics) const {
        if (!isNumeric())
            diagnostics.push_back(
                {"address", "is '" + address + "'; it must be a numeric address, such as 127.0.0.1, 0.0.0.0 or ::1"});
        else if (!isLocal() && token.empty() && token_file.empty())
            diagnostics.push_back({"token", "is missing; it is required because address is " + address +
                                                ", which other machines can reach"});
        if (!token.empty() && !token_file.empty())
            diagnostics.push_back({"token_file", "is given in addition to token; only one of them may be given"});
    }
};

/** Returns the state of the deployment as JSON for pages. */
std::string statusText(const types::DeploymentStatus& status, const ServerCounts& counts);
/** Returns all properties, named "sonar.range", as JSON values. */
Parameters listParameters(const types::DeploymentStatus& status);
std::string interfacesText(const std::vector<types::TaskInterface>& interfaces, bool control);

/** A page's request. */
struct Request {
    enum class Kind { Call, Pause, Step } kind = Kind::Call;
    uint64_t id = 0;                     ///< Repeated in the answer.
    std::string operation;               ///< "sonar.setRange"
    std::vector<std::string> arguments;  ///< In YAML.
    bool on = false;                     ///< For Pause.
};
/** Reads a request. Throws std::invalid_argument with what is wrong; `request` then has what was read before, such as
 *  the id. */
void readRequest(const std::string& text, Request& request);

std::string answerText(uint64_t id, const std::string& result);
std::string refusalText(uint64_t id, const std::string& why);

/** Runs work that may wait long. The work of one executor runs in order, on a thread that starts with its first work;
 *  executors do not wait for each other. Thread-safe. */
class SerialExecutors {
public:
    static constexpr size_t max_waiting = 16;  ///< In one executor.
    using Work = std::function<void()>;        ///< Must not throw.

    SerialExecutors() = default;
    ~SerialExecutors() { end(); }
    SerialExecutors(const SerialExecutors&) = delete;
    SerialExecutors& operator=(const SerialExecutors&) = delete;

    /** Queues work. Returns false, without running it, if too much work waits in that executor, or after end(). */
    bool run(const std::string& executor, Work work);
    /** Waits for running work; queued work is dropped. */
    void end();

private:
    struct Executor {
        std::atomic<size_t> waiting = 0;
        boost::asio::thread_pool thread{1};
    };

    std::mutex mutex_;
    std::map<std::string, Executor> executors_;
    bool ending_ = false;
};

/** The environment of a publisher. */
struct Host {
    std::string viewer;                                      ///< The name of its task, which pages cannot control.
    types::DeploymentControl* deployment = nullptr;          ///< The deployment that pages see and control; null: none.
    std::function<void(const std::string&)> warn = nullptr;  ///< Called on a thread of the publisher.
};

struct Source {
    std::string name;                 ///< "noise.noisy"
    std::vector<FoxgloveForm> forms;  ///< Its forms for Foxglove.
    bool on_pages = false;            ///< Whether pages show it too.
};

/** Sends the newest sample of each source to all clients, and executes the requests of pages.
 *
 *  Threads: the server's thread; one that encodes samples, which no caller waits for; and one for each task that pages
 *  have sent requests to, because requests wait for the task. */
class Publisher final : private ServerHandler {
public:
    /** Throws ListenError if the port cannot be opened. */
    Publisher(const ViewerConfig& config, std::vector<Source> sources, Host host);
    ~Publisher() override;

    /** Offers the newest sample of a source; does not block. `now`: on the deployment's clock. */
    void offer(size_t source, AnySample sample, types::Time now);
    uint16_t port() const { return server_.port(); }
    ServerCounts counts() const;
    /** Returns why samples could not be encoded since the last call; empty if all could. */
    std::string consumeError();

private:
    struct Slot {
        AnySample sample;
        types::Time stamp;
        double latency_s = 0;           ///< Since its stamp [s].
        uint64_t count = 0, shown = 0;  ///< Number of samples so far; number at the last that was shown.
        bool fresh = false;
        bool for_newcomer = false;  ///< A Foxglove client has not received its scene yet.
    };

    std::optional<PageFile> file(std::string_view path) override;
    std::vector<Frame> greeting() override;
    void request(uint64_t client, std::string text) override;
    void parameters(uint64_t client, ParameterRequest request, bool may_set) override;
    void subscribed(const std::vector<uint32_t>& channels) override;
    void subscribedToParameters() override;
    uint64_t audience(size_t source) const;
    void publishAll();
    void publishFresh(std::unique_lock<std::mutex>& lock);
    void publish(size_t source, const Slot& slot);
    void showInFoxglove(size_t source, const Slot& slot);
    void sendScene(uint32_t channel, size_t source, const Slot& slot);
    void showOnPages(size_t source, const Slot& slot);
    void showScene(size_t source, const types::GeometryPtr& geometry);
    void showStatus();
    void showParameters(const types::DeploymentStatus& status);
    void sendTime(types::Time now);
    std::string answerParameters(uint64_t client, const ParameterRequest& request, bool may_set);
    std::string setParameter(const std::string& name, const std::string& yaml, bool may_set) const;
    std::string getTask(const std::string& path) const;
    std::string answer(const Request& request) const;
    std::string carryOut(const Request& request) const;
    void refuseOwn(const std::string& operation) const;

    const ViewerConfig config_;
    const std::vector<Source> sources_;
    const Host host_;
    const PingPicture picture_;
    std::vector<Messages> messages_;       ///< By source; for the publishing thread.
    std::vector<uint32_t> first_channel_;  ///< First channel of each source.
    std::mutex mutex_;
    std::condition_variable fresh_;
    std::vector<Slot> slots_;
    std::string diagnostic_;
    types::Time now_;         ///< The time of the newest sample's offer().
    bool newcomers_ = false;  ///< A Foxglove client has received no parameters yet.
    Parameters reported_;     ///< Values that clients have received; for the publishing thread.
    std::map<size_t, types::GeometryPtr> geometries_;  ///< The geometries of `scenes_`; for the publishing thread.
    std::map<size_t, Bytes> scenes_;                   ///< By source, for later pages, like interfaces_.
    const std::vector<types::TaskInterface> tasks_;
    const Bytes interfaces_;
    bool ending_ = false;
    std::atomic<uint64_t> skipped_{0};
    SerialExecutors executors_;  ///< Executes requests, one executor per task.
    Server server_;
    std::thread publishing_;
};

}  // namespace insonify::viewer
