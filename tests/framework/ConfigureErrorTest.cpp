// Errors that a task finds only when it is configured.
#include <gmock/gmock.h>

#include "components/framework/Deployment.hpp"
#include "components/framework/Properties.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::framework {
namespace {

/** Finds only in configure that its port is in use. */
struct Stickler : TaskContext {
    using TaskContext::TaskContext;
    struct Config {
        double port = 1;
        static void describe(auto& self, auto& visit) { visit({"port", "1", "to listen on"}, self.port); }
    };
    Properties<Config> config{this};
    bool configureHook() override { throw types::ConfigError("", name() + ".port", "is taken"); }
};

TEST(ConfigureErrorTest, ReportsConfigureErrorsAtThePlaceOfTheProperty) {
    Registry registry;
    registry.add(
        {"test::Listener", "listens", [](const std::string& name) { return std::make_unique<Stickler>(name); }});
    const char* yaml =
        "tasks:\n"
        "  a: {type: test::Listener, activity: {period: 1}, properties: {port: 7}}\n"
        "  b: {type: test::Listener, activity: {period: 1}}\n";
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    EXPECT_THAT(test::refused([&] { deployment.configure(); }),
                testing::ElementsAre("a.yml:2:71: tasks.a.properties.port: is taken",
                                     "a.yml:3:6: tasks.b.properties.port: is taken"));
}

}  // namespace
}  // namespace insonify::framework
