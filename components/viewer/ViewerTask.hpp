#pragma once
#include <memory>
#include <string>
#include <vector>

#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/viewer/Publisher.hpp"
#include "components/viewer/ViewerConfig.hpp"

namespace insonify::viewer {

/** Shows a deployment while it runs: a page at http://address:port/, and the same samples for Foxglove on that port.
 *
 *  Ports: an input for each connection that names one, whatever the name, of any type in types/Samples.hpp, and
 *  snapshots. The page shows pings as a fan, the scene and the sonar's place from snapshots, the vehicle's path from
 *  poses, the tasks, what connections lost and what is left out; where `control` allows it sets properties, calls
 *  operations and, in lockstep, pauses. Foxglove gets channels for each input, and the properties of tasks as
 *  parameters, which it sets where `control` allows it.
 *
 *  configure opens the port; one that is taken refuses it. Cycles only hand over the newest samples: no client delays
 *  them, and what a client is too slow for is dropped and counted. Connections that are refused are counted, and warned
 *  of every ten seconds at most. A ping whose lists are not as long as its counts
 *  say, or what no message can hold, is left out and makes the task RunTimeError until the next sample. */
class ViewerTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::Properties<ViewerConfig> config{this};

    /** Throws ConfigError for a type that cannot be shown. */
    framework::InputPortBase* makeInput(const std::string& port, framework::OutputPortBase& source) override;
    /** Where the page is; connections refused and frames dropped so far, see ServerCounts. */
    std::vector<std::string> notices() const override;
    bool reachesOutside() const override { return true; }
    /** Where it listens, 0 when it does not. */
    uint16_t port() const { return publisher_ ? publisher_->port() : 0; }
    ServerCounts counts() const { return publisher_ ? publisher_->counts() : ServerCounts{}; }

private:
    /** What an input's samples are shown as. */
    template <class T>
    struct SourceOf {
        const Source source;
        explicit SourceOf(const std::string& path) : source{path, formsOf<T>(path), on_pages<T>} {}
    };

    bool configureHook() override;
    void updateHook() override;
    void errorHook() override;
    void cleanupHook() override;
    /** The first line of the token's file; types::ConfigError where there is none. */
    std::string readToken() const;

    framework::DynamicInputs<ShownTypes, SourceOf> inputs_{this};
    std::unique_ptr<Publisher> publisher_;
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::viewer
