#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "components/deployer/Json.hpp"
#include "components/framework/Deployment.hpp"

namespace insonify::deployer {

/** Sends a message to the service manager of systemd, as sd_notify(3) does: "READY=1". Does nothing where NOTIFY_SOCKET
 *  names no socket; a name that begins with '@' is in the abstract name space. Returns whether it was sent. */
bool notifyManager(const std::string& message);

/** The state of a run for whoever started it: systemd, a container's probe, a watching script.
 *
 *  A run is healthy while all its tasks run and no cycle has lasted longer than its `watchdog`; a task in RunTimeError
 *  still runs. A thread of its own
 *
 *  - tells systemd STATUS=, READY=1 once all tasks run, STOPPING=1, and, while the run is healthy, WATCHDOG=1 at least
 *    three times in WATCHDOG_USEC;
 *  - answers HTTP requests on a port with the state in JSON: 200 while the run is healthy, else 503;
 *  - or writes the same to a file each second, replacing it as a whole. */
class Supervision {
public:
    /** @param where a file, or [ADDRESS:]PORT, by default on 127.0.0.1; empty: neither
     *  Throws types::ConfigError for a file that cannot be written, and for a port that cannot be listened on. */
    explicit Supervision(const std::string& where);
    ~Supervision();
    Supervision(const Supervision&) = delete;
    Supervision& operator=(const Supervision&) = delete;

    /** From here on reports on a run, until it is destroyed; both outlive it. */
    void watch(const framework::Deployment& deployment, const std::atomic<bool>& stop);

private:
    using Clock = std::chrono::steady_clock;
    enum class State : uint8_t { Starting, Running, Hanging, Stopping };
    /** A client that has not been answered yet, or that has not read its answer. */
    struct Client {
        int socket;
        Clock::time_point since;
        bool is_answered = false;
    };

    void listenOn(const std::string& where);
    void loop();
    void look();
    State stateNow() const;
    Json report() const;
    void writeFile() const;
    void waitForClients(std::chrono::milliseconds at_most);
    void serve(Client& client) const;

    std::filesystem::path file_;  ///< Empty: none.
    int listener_ = -1;
    std::vector<Client> clients_;
    std::optional<std::chrono::microseconds> beat_;  ///< Between two WATCHDOG=1; none: systemd does not wait for them.
    const framework::Deployment* deployment_ = nullptr;
    const std::atomic<bool>* stop_ = nullptr;
    State state_ = State::Starting;
    bool is_ready_ = false;  ///< All tasks have run.
    std::string status_;     ///< As told to systemd.
    Clock::time_point next_beat_, next_report_;
    std::atomic<bool> ending_{false};
    std::thread thread_;
};

}  // namespace insonify::deployer
