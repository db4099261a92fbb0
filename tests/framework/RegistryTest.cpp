#include <gmock/gmock.h>

#include "components/framework/Registry.hpp"
#include "tests/framework/Tasks.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::framework {
namespace {

TEST(RegistryTest, MakesWhatItLists) {
    Registry registry = test::testRegistry();
    EXPECT_EQ(registry.list().front().type, "test::Source");
    EXPECT_EQ(registry.list().front().doc, "counts");
    EXPECT_EQ(registry.make("test::Source", "a")->name(), "a");
    EXPECT_EQ(registry.make("test::Sourc", "a"), nullptr);
}

TEST(RegistryTest, ADeploymentLoadsTasksFromASharedObject) {
    Registry registry = test::testRegistry();
    const std::string yaml = std::string("libraries: [") + PLUGIN + R"(]
tasks:
  plugin: {type: plugin::PluginTask, activity: {period: 0.1}}
  relay: {type: test::Relay}
connections: [{from: plugin.value, to: relay.in}]
)";
    Deployment deployment(DeploymentSpec::parse(yaml, "plugin.yml"), registry);
    deployment.configure();
    const std::atomic<bool> stop{false};
    EXPECT_FALSE(deployment.run({.duration_s = 0.15}, stop).failed());
    EXPECT_EQ(dynamic_cast<test::Relay&>(*deployment.task("relay")).notes,
              (std::vector<std::string>{"relay:42@1000000", "relay:42@1100000"}));
}

TEST(RegistryTest, NamesALibraryThatIsMissingOrHasNoEntry) {
    Registry registry;
    const std::string yaml = std::string("libraries: [nowhere.so, ") + NO_PLUGIN + "]\ntasks: {a: {type: b::C}}\n";
    EXPECT_THAT(
        test::refused([&] { Deployment(DeploymentSpec::parse(yaml, "plugin.yml"), registry); }),
        testing::ElementsAre(testing::AllOf(testing::HasSubstr("plugin.yml:1:13: libraries[0]: is nowhere.so: "),
                                            testing::HasSubstr("nowhere.so: cannot be loaded")),
                             testing::AllOf(testing::HasSubstr("plugin.yml:1:25: libraries[1]: is "),
                                            testing::HasSubstr("has no function insonify_register")),
                             testing::HasSubstr("tasks.a.type: is b::C, which is not known")));
}

struct Throwing final : TaskContext {
    explicit Throwing(const std::string& name) : TaskContext(name) { throw std::runtime_error("out of order"); }
};

TEST(RegistryTest, ATypeIsAddedOnceAndHasAName) {
    Registry registry = test::testRegistry();
    const size_t before = registry.list().size();
    EXPECT_THAT(test::refused([&] { registry.add<test::Relay>("test::Source", ""); }),
                testing::ElementsAre(testing::HasSubstr("adds the type test::Source, which Insonify has")));
    for (const char* name : {"", "a b::C", "a::C\n", "a::\xc3\xa4"})
        EXPECT_THAT(test::refused([&] { registry.add<test::Relay>(name, ""); }),
                    testing::ElementsAre(testing::HasSubstr("must be a name such as")));
    EXPECT_EQ(registry.list().size(), before);
}

TEST(RegistryTest, AConstructorThatThrowsIsReportedAtItsTask) {
    Registry registry = test::testRegistry();
    registry.add<Throwing>("own::Throwing", "");
    EXPECT_THAT(test::refused([&] {
                    Deployment(DeploymentSpec::parse("tasks: {a: {type: own::Throwing}}\n", "a.yml"), registry);
                }),
                testing::ElementsAre(testing::HasSubstr("a.yml:1:19: tasks.a.type: is own::Throwing, which has a "
                                                        "constructor that throws: out of order")));
}

}  // namespace
}  // namespace insonify::framework
