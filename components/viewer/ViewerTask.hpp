#pragma once
#include <memory>
#include <string>
#include <vector>

#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/viewer/Publisher.hpp"

namespace insonify::viewer {

/** Shows a deployment while it runs: a page at http://address:port/, and the same samples for Foxglove on that port.
 *
 *  Ports: an input for each connection, with any name, of any type in types/samples/Samples.hpp, and snapshots. The
 * page shows pings as a fan, the scene and the sonar's pose from snapshots, the vehicle's path from poses, the tasks,
 * losses of connections, and omissions. If `control` allows it, the page sets properties, calls operations and, in
 * lockstep, pauses. Foxglove gets channels for each input, and the properties of tasks as parameters, which it can set
 * if `control` allows it.
 *
 *  configure opens the port, and fails if it is in use. Cycles only pass on the newest samples: no client delays them.
 *  Frames for slow clients are dropped and counted. Refused connections are counted, with a warning at most every ten
 *  seconds. A ping whose lists do not match its counts, or that no message can represent, is omitted and makes the task
 *  RunTimeError until the next sample. */
class ViewerTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::Properties<ViewerConfig> config{this};

    /** Throws ConfigError for a type that cannot be shown. */
    framework::InputPortBase* makeInput(const std::string& port, framework::OutputPortBase& source) override;
    /** Returns the address of the page; connections refused and frames dropped so far, see ServerCounts. */
    types::Notices notices() const override;
    bool reachesOutside() const override { return true; }
    /** Returns the port that it listens on; 0 if it does not. */
    uint16_t port() const { return publisher_ ? publisher_->port() : 0; }
    ServerCounts counts() const { return publisher_ ? publisher_->counts() : ServerCounts{}; }

private:
    /** The source of an input's samples. */
    template <class T>
    struct SourceOf {
        const Source source;
        explicit SourceOf(const std::string& path) : source{path, getForms<T>(path), on_pages<T>} {}
    };

    bool configureHook() override;
    void updateHook() override;
    void errorHook() override;
    void cleanupHook() override;
    /** Returns the first line of the token's file. Throws types::ConfigError if there is none. */
    std::string readToken() const;

    framework::DynamicInputs<ShownTypes, SourceOf> inputs_{this};
    std::unique_ptr<Publisher> publisher_;
};

/** Registers the tasks of this folder for deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::viewer
