#pragma once
#include <algorithm>
#include <string>
#include <tuple>

#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Event.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/Pose.hpp"

namespace insonify::pose {

/** A base of tasks that write the poses which others send; for `schedule: realtime`.
 *
 *  `list` is the member of the configuration that has an entry for each body, with the `port` by which its poses go.
 *  Ports: an output for each of them: body in the world, Rock's axes (x north, y west, z up). Refused are lockstep,
 *  whose time does not wait for messages, and an entry from whose port no connection leads. `Kept` is what the task
 *  keeps with a port, see DynamicPorts.hpp. */
template <class Config, auto list, template <class> class Kept = framework::KeepsNothing>
class ListenerTask : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::Properties<Config> config{this};

    framework::OutputPortBase* makeOutput(const std::string& port) final {
        if (!entryOf(port)) return nullptr;
        return &outputs_.template make<types::Pose>(port, "body in the world: x north, y west, z up").port;
    }
    void check(types::Diagnostics& diagnostics) const final {
        if (environment().lockstep)
            diagnostics.push_back({"",
                                   "messages come on the wall clock's time, for which lockstep does not wait; set "
                                   "schedule: realtime"});
        for (size_t i = 0; i < entries().size(); ++i) {
            const std::string& port = entries()[i].port;
            bool has_output = false;
            outputs_.forEach([&](const auto& output) { has_output |= output.port.name() == port; });
            if (!has_output)
                diagnostics.push_back(
                    {key() + "[" + std::to_string(i) + "].port", "no connection leads from " + name() + "." + port});
        }
    }
    bool reachesOutside() const final { return true; }

protected:
    /** Of an output; null: none has that port. */
    const auto* entryOf(const std::string& port) const {
        const auto found = std::ranges::find_if(entries(), [&](const auto& entry) { return entry.port == port; });
        return found == entries().end() ? nullptr : &*found;
    }

    framework::Event arrived_{this};  ///< A message; outlives what raises it.
    framework::DynamicOutputs<std::tuple<types::Pose>, Kept> outputs_{this};

private:
    const auto& entries() const { return (*config).*list; }
    /** The name of the list in files. */
    std::string key() const {
        std::string found;
        const auto compare = [&](const types::Field& field, const auto& value) {
            if (static_cast<const void*>(&value) == &entries()) found = field.name;
        };
        Config::describe(*config, compare);
        return found;
    }
};

}  // namespace insonify::pose
