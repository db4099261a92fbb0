#include <gtest/gtest.h>

#include "components/pose/Trajectory.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

void readTrajectory(const Input& input) try {
    const auto trajectory = pose::Trajectory::fromFile(input.file());
    for (const double time : {-1e9, 0.0, 0.7, 1e9}) EXPECT_TRUE(types::isUsable(trajectory.at(time))) << time;
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

TEST(TrajectoryFuzzTest, EveryTextIsATrajectoryOrAnError) {
    push({"trajectory",
          "trajectory.csv",
          {"time,x,y,z,qw,qx,qy,qz\n", ",", "\n", "\r\n", " ", "1e-308", "0x10", "1,2,3,4,1,0,0,0\n", "\"", "-0",
           "\xef\xbb\xbf", "# t\n", "1 2 3 4 1 0 0 0\n", "#timestamp, p_RS_R_x [m], p_RS_R_y [m], ", "q_RS_z []\n"},
          readTrajectory});
}

}  // namespace
}  // namespace insonify::fuzz
