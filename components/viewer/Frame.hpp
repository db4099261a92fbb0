#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace insonify::viewer {

/** Bytes sent to several clients, encoded once. */
using Bytes = std::shared_ptr<const std::string>;

inline Bytes toBytes(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

/** One WebSocket message. */
struct Frame {
    std::string head;  ///< Header for this client only.
    Bytes body;
    bool text = false;
};

}  // namespace insonify::viewer
