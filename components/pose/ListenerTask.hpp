#pragma once
#include <algorithm>
#include <string>
#include <tuple>

#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::pose {

/** Base of tasks that write the poses which other programs send; for `schedule: realtime`.
 *
 *  `list` is the member of the configuration with an entry for each body, which names the `port` of its poses. Each
 *  entry has an output: body in the world, Rock's axes (x north, y west, z up). check() reports lockstep, whose time
 *  does not wait for messages, and entries whose port has no connection. `Kept` is data that the task keeps with a
 *  port, see DynamicPorts.hpp. */
template <class Config, auto list, template <class> class Kept = framework::KeepsNothing>
class ListenerTask : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::Properties<Config> config{this};

    framework::OutputPortBase* makeOutput(const std::string& port) final {
        if (!findEntry(port)) return nullptr;
        return &outputs_.template make<types::Pose>(port, "body in the world: x north, y west, z up").port;
    }
    void check(types::Diagnostics& diagnostics) const final {
        if (environment().lockstep)
            diagnostics.push_back({"",
                                   "messages arrive by the wall clock, for which lockstep does not wait; set "
                                   "schedule: realtime"});
        for (size_t i = 0; i < entries().size(); ++i) {
            const std::string& port = entries()[i].port;
            bool has_output = false;
            outputs_.forEach([&](const auto& output) { has_output |= output.port.name() == port; });
            if (!has_output)
                diagnostics.push_back(
                    {key() + "[" + std::to_string(i) + "].port", "no connection leads from " + name() + "." + port});
        }
        checkMore(diagnostics);
    }
    bool reachesOutside() const final { return true; }

protected:
    /** Reports further errors in check(). */
    virtual void checkMore(types::Diagnostics& /*diagnostics*/) const {}
    /** Returns the entry of a port; null when there is none. */
    const auto* findEntry(const std::string& port) const {
        const auto found = std::ranges::find_if(entries(), [&](const auto& entry) { return entry.port == port; });
        return found == entries().end() ? nullptr : &*found;
    }

    framework::Event arrived_{this};  ///< A message has arrived; must outlive its sender.
    framework::DynamicOutputs<std::tuple<types::Pose>, Kept> outputs_{this};

private:
    const auto& entries() const { return (*config).*list; }
    /** Returns the name of the list in files. */
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
