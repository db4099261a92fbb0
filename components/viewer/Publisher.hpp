#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "components/viewer/Messages.hpp"
#include "components/viewer/PingPicture.hpp"
#include "components/viewer/SerialExecutors.hpp"
#include "components/viewer/Server.hpp"
#include "components/viewer/StatusText.hpp"
#include "components/viewer/ViewerConfig.hpp"
#include "types/DeploymentControl.hpp"

namespace insonify::viewer {

/** Where a publisher runs. */
struct Host {
    std::string viewer;                                      ///< The name of its task, which pages do not steer.
    types::DeploymentControl* deployment = nullptr;          ///< What pages see and control; null: nothing.
    std::function<void(const std::string&)> warn = nullptr;  ///< Called on a thread of the publisher.
};

struct Source {
    std::string name;                 ///< "noise.noisy"
    std::vector<FoxgloveForm> forms;  ///< What it is for Foxglove.
    bool on_pages = false;            ///< Whether pages show it, too.
};

/** Sends the newest sample of each source to those who look, and does what pages ask for.
 *
 *  Threads: the server's; one that makes messages of samples, which nobody waits for; and one for each task that pages
 *  have asked something of, since such requests wait for the task. */
class Publisher final : private ServerHandler {
public:
    /** Throws ListenError where the port cannot be had. */
    Publisher(const ViewerConfig& config, std::vector<Source> sources, Host host);
    ~Publisher() override;

    /** The newest sample of a source; waits for nobody. `now`: on the deployment's clock. */
    void offer(size_t source, AnySample sample, types::Time now);
    uint16_t port() const { return server_.port(); }
    ServerCounts counts() const;
    /** What could not be made a message of since this was asked last, and why; empty: nothing. */
    std::string takeError();

private:
    struct Slot {
        AnySample sample;
        types::Time stamp;
        double latency_s = 0;           ///< Since its stamp [s].
        uint64_t count = 0, shown = 0;  ///< Samples so far; as of the last that was shown.
        bool fresh = false;
        bool for_newcomer = false;  ///< Somebody in Foxglove has not got its scene yet.
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
    void tellTime(types::Time now);
    std::string answerParameters(uint64_t client, const ParameterRequest& request, bool may_set);
    std::string setParameter(const std::string& name, const std::string& yaml, bool may_set) const;
    std::string taskOf(const std::string& path) const;
    std::string answer(const Request& request) const;
    std::string carryOut(const Request& request) const;
    void refuseOwn(const std::string& operation) const;

    const ViewerConfig config_;
    const std::vector<Source> sources_;
    const Host host_;
    const PingPicture picture_;
    std::vector<Messages> messages_;       ///< By source; the publishing thread's.
    std::vector<uint32_t> first_channel_;  ///< Of each source.
    std::mutex mutex_;
    std::condition_variable fresh_;
    std::vector<Slot> slots_;
    std::string diagnostic_;
    types::Time now_;                                  ///< As it came with the newest sample.
    bool newcomers_ = false;                           ///< In Foxglove, who have been told no parameters yet.
    Parameters told_;                                  ///< As clients know them; the publishing thread's.
    std::map<size_t, types::GeometryPtr> geometries_;  ///< Of `scenes_`; the publishing thread's.
    std::map<size_t, Bytes> scenes_;                   ///< By source, for pages that come later, as interfaces_.
    const std::vector<types::TaskInterface> tasks_;
    const Bytes interfaces_;
    bool ending_ = false;
    std::atomic<uint64_t> skipped_{0};
    SerialExecutors executors_;  ///< Of requests, by task.
    Server server_;
    std::thread publishing_;
};

}  // namespace insonify::viewer
