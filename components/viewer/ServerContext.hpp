#pragma once
#include <atomic>
#include <cstdint>
#include <utility>

#include "components/viewer/AccessPolicy.hpp"
#include "components/viewer/Server.hpp"
#include "types/ThrottledWarning.hpp"

namespace insonify::viewer {

/** Data shared by all connections of a server. */
struct ServerContext {
    ServerContext(ServerOptions asked, ServerHandler& answers)
        : options(std::move(asked)), handler(answers), access{options.token} {}
    virtual ~ServerContext() = default;
    virtual void leave(uint64_t session) = 0;
    virtual void recount() = 0;  ///< Counts clients and subscriptions again.

    const ServerOptions options;
    ServerHandler& handler;
    const AccessPolicy access;
    types::ThrottledWarning refused{"connection", "refused"};
    std::atomic<uint64_t> clients{0}, dropped{0};
};

}  // namespace insonify::viewer
