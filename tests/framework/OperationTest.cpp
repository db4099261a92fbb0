#include <gmock/gmock.h>

#include "components/framework/Operation.hpp"
#include "components/framework/Properties.hpp"
#include "tests/support/Refused.hpp"

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
    ASSERT_NE(motor.operation("turn"), nullptr);
    OperationBase& turn = *motor.operation("turn");
    EXPECT_EQ(turn.doc(), "angle times count");
    EXPECT_EQ(turn.signature(), "double(double, integer)");
    EXPECT_EQ(turn.callText({"0.5", "3"}), "1.5");
    EXPECT_EQ(motor.operation("reset")->callText({}), "");
    EXPECT_EQ(motor.operation("rest"), nullptr);
}

TEST(OperationTest, NamesAllArgumentsThatDoNotFit) {
    Motor motor("motor");
    EXPECT_THAT(
        test::refused([&] {
            motor.turn.callText({"fast", "1.5"});
        }),
        testing::ElementsAre("turn[0]: is fast; must be a finite number", "turn[1]: is 1.5; must be a whole number"));
    EXPECT_THROW(motor.turn.callText({"1"}), types::ConfigError);
}

TEST(OperationTest, AThrowReachesTheCallerAndLeavesTheTask) {
    Motor motor("motor");
    motor.configure();
    EXPECT_THROW(motor.turn(1, 0), std::runtime_error);
    EXPECT_EQ(motor.state(), TaskState::Stopped);
}

/** Returns the result of a call of "task.operation", or why it fails. */
std::string called(TaskContext& task, const std::string& operation, const std::vector<std::string>& arguments) {
    try {
        return task.operation(operation)->callText(arguments);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

TEST(OperationTest, TransitionsAreOperationsThatReportWhyTheyAreRefused) {
    Motor motor("motor");
    const auto call = [&](const char* name) { return called(motor, name, {}); };
    EXPECT_EQ(call("start"), "cannot start: motor is PreOperational, must be Stopped");
    EXPECT_EQ(call("configure"), "");
    EXPECT_EQ(call("start"), "");
    EXPECT_EQ(motor.state(), TaskState::Running);
    EXPECT_EQ(call("cleanup"), "cannot cleanup: motor is Running, must be Stopped");
    EXPECT_EQ(call("recover"), "cannot recover: motor is Running, must be RunTimeError or Exception");
    EXPECT_EQ(call("stop"), "");
    EXPECT_EQ(call("cleanup"), "");
    EXPECT_EQ(motor.state(), TaskState::PreOperational);
}

struct WheelConfig {
    double radius = 1;
    int spoke_count = 8;
    static void describe(auto& self, auto& visit) {
        visit({"radius", "m", "of the rim", 0.1, 10}, self.radius);
        visit({"spoke_count", "1", "an even number", 2, 100}, self.spoke_count);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (spoke_count % 2) diagnostics.push_back({"spoke_count", "is odd; must be even"});
    }
};

/** Applies properties while it runs, except a radius of 7. */
struct Wheel : TaskContext {
    using TaskContext::TaskContext;
    Properties<WheelConfig> config{this};
    double taken_over = 0;
    bool propertiesHook() override {
        if (config->radius == 7) throw std::runtime_error("7 m does not fit");
        taken_over = config->radius;
        return config->radius < 9;
    }
};

TEST(OperationTest, EveryPropertyHasASetterThatChecksItsArgument) {
    Wheel wheel("wheel");
    EXPECT_EQ(called(wheel, "setRadius", {"2.5"}), "");
    EXPECT_EQ(wheel.config->radius, 2.5);
    EXPECT_EQ(wheel.operation("setRadius")->signature(), "void(double)");
    EXPECT_EQ(called(wheel, "setRadius", {"20"}), "radius: is 20 m; may be 0.1 to 10 m");
    EXPECT_EQ(called(wheel, "setRadius", {"wide"}), "radius: is wide; must be a finite number");
    EXPECT_EQ(called(wheel, "setRadius", {"["}).substr(0, 8), "radius: ");
    EXPECT_EQ(called(wheel, "setRadius", {}), "setRadius: has 0 arguments, takes void(double)");
    EXPECT_EQ(called(wheel, "setSpoke_count", {"7"}), "spoke_count: is odd; must be even");
    EXPECT_EQ(wheel.config->radius, 2.5);
    EXPECT_EQ(wheel.config->spoke_count, 8);
}

TEST(OperationTest, ARunningTaskAppliesASettingOrKeepsTheOldOneWithAReason) {
    Wheel wheel("wheel");
    wheel.configure();
    wheel.start();
    EXPECT_EQ(called(wheel, "setRadius", {"3"}), "");
    EXPECT_EQ(wheel.taken_over, 3);
    EXPECT_EQ(called(wheel, "setRadius", {"7"}), "cannot set radius: 7 m does not fit");
    EXPECT_EQ(called(wheel, "setRadius", {"9.5"}), "cannot set radius: wheel is Running; it can when it is stopped");
    EXPECT_EQ(wheel.config->radius, 3);
    EXPECT_EQ(wheel.state(), TaskState::Running);
}

}  // namespace
}  // namespace insonify::framework
