#pragma once
// A vehicle by PyPI's pymavlink.
#include <signal.h>

#include <sstream>
#include <string>
#include <vector>

#include "tests/deployer/Command.hpp"
#include "tests/support/Python.hpp"

namespace insonify::mavlink {

/** A program that sends until it goes. */
class Vehicle {
public:
    /** What vehicle.py is to do: "poses2 1". */
    Vehicle(uint16_t port, const std::string& work) : process_(wordsOf(port, work), folder_.path()) {}
    ~Vehicle() {
        process_.signal(SIGKILL);
        process_.wait();
    }
    static bool available() { return pythonHas("pymavlink"); }

private:
    static std::vector<std::string> wordsOf(uint16_t port, std::string work) {
        std::vector<std::string> words = {python(), INSONIFY_SOURCE_DIR "/tests/mavlink/vehicle.py",
                                          std::to_string(port)};
        for (std::istringstream text(work); text >> work;) words.push_back(work);
        return words;
    }

    deployer::TestFolder folder_;
    deployer::Process process_;
};

}  // namespace insonify::mavlink
