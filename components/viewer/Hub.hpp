#pragma once
#include <atomic>
#include <cstdint>
#include <utility>

#include "components/viewer/Admission.hpp"
#include "components/viewer/Refusals.hpp"
#include "components/viewer/Server.hpp"

namespace insonify::viewer {

/** What all connections of a server share. */
struct Hub {
    Hub(ServerOptions asked, ServerHandler& answers)
        : options(std::move(asked)), handler(answers), admission{options.token} {}
    virtual ~Hub() = default;
    virtual void leave(uint64_t session) = 0;
    virtual void recount() = 0;  ///< Who is connected, and subscribed to what.

    const ServerOptions options;
    ServerHandler& handler;
    const Admission admission;
    Refusals refused;
    std::atomic<uint64_t> clients{0}, dropped{0};
};

}  // namespace insonify::viewer
