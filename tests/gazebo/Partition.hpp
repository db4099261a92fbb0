#pragma once
// Isolates tests from other programs on Gazebo's transport.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <random>
#include <string>

#include "tests/support/Waiting.hpp"

namespace insonify::gazebo {

using test::becomesTrue;

/** A private partition of the test, on this machine only. */
struct OwnPartition : testing::Test {
    OwnPartition() {
        for (const char* prefix : {"GZ_", "IGN_"}) {
            setenv((prefix + std::string("IP")).c_str(), "127.0.0.1", 1);
            setenv((prefix + std::string("PARTITION")).c_str(), partition.c_str(), 1);
        }
    }
    const std::string partition = "insonify-" + std::to_string(getpid()) + "-" + std::to_string(std::random_device{}());
};

}  // namespace insonify::gazebo
