#include <gmock/gmock.h>

#include "components/logger/LoggerTask.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::logger {
namespace {

TEST(AllocationTest, TheTasksThreadAllocatesNothingOnceItRuns) {
    Folder folder;
    LoggerTask task("log");
    task.environment().output_folder = folder.path();
    LoggerConfig config;
    config.file = "x.0.log";
    task.config.set(config);
    test::Writer<types::SonarPtr> sonar("sonar");
    test::Writer<types::Pose> vehicle("vehicle");
    sonar.port.connectTo(*task.makeInput("ping", sonar.port), framework::ConnPolicy::buffer(8));
    vehicle.port.connectTo(*task.makeInput("pose", vehicle.port), framework::ConnPolicy::buffer(8));
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const auto ping = std::make_shared<const types::Sonar>();
    types::Pose pose;
    pose.source_frame = "body";
    const auto cycle = [&] {
        sonar.port.write(ping);
        vehicle.port.write(pose);
        task.update();
    };
    cycle();
    EXPECT_THAT(test::allocationsOn(task,
                                    [&] {
                                        for (int i = 0; i < 200; ++i) cycle();
                                    }),
                testing::IsEmpty());
}

}  // namespace
}  // namespace insonify::logger
