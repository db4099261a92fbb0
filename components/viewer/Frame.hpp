#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace insonify::viewer {

/** What is sent to several clients, written once. */
using Bytes = std::shared_ptr<const std::string>;

inline Bytes bytesOf(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

/** One WebSocket message. */
struct Frame {
    std::string head;  ///< Of this client alone, before the body.
    Bytes body;
    bool text = false;
};

}  // namespace insonify::viewer
