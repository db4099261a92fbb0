#include <gtest/gtest.h>

#include "components/framework/Operation.hpp"

namespace insonify::framework {
namespace {

struct Motor : TaskContext {
    using TaskContext::TaskContext;
    Operation<double(double, int)> turn{this, "turn", "angle times count", [this](double angle, int count) {
                                            thread = std::this_thread::get_id();
                                            if (count == 0) throw std::runtime_error("not at all?");
                                            return angle * count;
                                        }};
    Operation<void()> reset{this, "reset", "to the start", [this] { thread = std::this_thread::get_id(); }};
    std::thread::id thread;
};

TEST(OperationTest, RunsOnTheTasksThreadInAnyState) {
    Motor motor("motor");
    EXPECT_EQ(motor.turn(1.5, 2), 3);
    const auto own = motor.thread;
    EXPECT_NE(own, std::this_thread::get_id());
    motor.configure();
    motor.reset();
    EXPECT_EQ(motor.thread, own);
}

TEST(OperationTest, IsListedAndCalledByTextAsYaml) {
    Motor motor("motor");
    ASSERT_EQ(motor.operations().size(), 2u);
    OperationBase& turn = *motor.operations()[0];
    EXPECT_EQ(turn.name(), "turn");
    EXPECT_EQ(turn.doc(), "angle times count");
    EXPECT_EQ(turn.signature(), "double(double, integer)");
    EXPECT_EQ(turn.callText({"0.5", "3"}), "1.5");
    EXPECT_EQ(motor.operations()[1]->callText({}), "");
}

TEST(OperationTest, ArgumentsThatDoNotFitAreAllNamed) {
    Motor motor("motor");
    try {
        motor.turn.callText({"fast", "1.5"});
        FAIL();
    } catch (const types::ConfigError& error) {
        ASSERT_EQ(error.diagnostics().size(), 2u);
        EXPECT_EQ(error.diagnostics()[0].text(), "turn[0]: is fast; must be a finite number");
        EXPECT_EQ(error.diagnostics()[1].text(), "turn[1]: is 1.5; must be a whole number");
    }
    EXPECT_THROW(motor.turn.callText({"1"}), types::ConfigError);
}

TEST(OperationTest, AThrowReachesTheCallerAndLeavesTheTask) {
    Motor motor("motor");
    motor.configure();
    EXPECT_THROW(motor.turn(1, 0), std::runtime_error);
    EXPECT_EQ(motor.state(), TaskState::Stopped);
}

}  // namespace
}  // namespace insonify::framework
