#pragma once
#include <cstddef>
#include <string_view>

#include "types/text/Describe.hpp"

namespace insonify::framework {

/** How samples wait between a writer and a reader, with Orocos' names. Every loss is counted. */
struct ConnPolicy {
    enum Type { Data, Buffer, CircularBuffer };
    Type type =
        Data;  ///< Data: newest only. Full Buffer: the newest is refused. Full CircularBuffer: the oldest is dropped.
    size_t size = 1;    ///< Capacity of a buffer [samples].
    bool init = false;  ///< Hand the writer's last sample to a reader that connects later.

    static ConnPolicy data() { return {}; }
    static ConnPolicy buffer(size_t size) { return {Buffer, size}; }
    static ConnPolicy circularBuffer(size_t size) { return {CircularBuffer, size}; }
};

}  // namespace insonify::framework

template <>
struct insonify::types::EnumNames<insonify::framework::ConnPolicy::Type> {
    static constexpr std::string_view names[] = {"data", "buffer", "circular_buffer"};
};
