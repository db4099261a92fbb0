#pragma once
// A vehicle by PyPI's pymavlink.
#include <string>

#include "tests/support/Peer.hpp"

namespace insonify::mavlink {

/** A program that sends until its destructor. */
struct Vehicle : test::Peer {
    /** @param work job of vehicle.py: "poses2 1" */
    Vehicle(uint16_t port, const std::string& work)
        : Peer("tests/mavlink/vehicle.py", std::to_string(port) + " " + work) {}
    static bool available() { return pythonHas("pymavlink"); }
};

}  // namespace insonify::mavlink
