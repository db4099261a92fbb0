#include <gmock/gmock.h>

#include "components/framework/Graph.hpp"
#include "components/framework/config/StreamNames.hpp"
#include "tests/framework/Tasks.hpp"

namespace insonify::framework {
namespace {

/** A deployment of the test's tasks. */
struct Deployed {
    explicit Deployed(const std::string& yaml) : deployment(DeploymentSpec::parse(yaml, "a.yml"), registry) {}

    Registry registry = test::testRegistry();
    const Deployment deployment;
};

TEST(StreamNamesTest, APortIsNamedByItsAliasElseByItsOwnName) {
    const Deployed two(
        "tasks:\n"
        "  s: {type: test::Source, activity: {period: 1}}\n"
        "  r: {type: test::Relay, aliases: {samples: s.value}}\n"
        "connections:\n  - {from: r.samples, to: r.in}\n");
    const StreamName aliased = streamName(*two.deployment.task("s")->output("value")),
                     own = streamName(*two.deployment.task("r")->output("out"));
    EXPECT_EQ(aliased.path(), "r.samples");
    EXPECT_EQ(aliased.model, "test::Relay");
    EXPECT_EQ(own.path(), "r.out");
    test::Source alone("alone");
    EXPECT_EQ(streamName(alone.value).path(), "alone.value");
    EXPECT_EQ(streamName(alone.value).model, "") << "it is in no deployment";
}

TEST(StreamNamesTest, AReplacingPortHasTheNameOfTheReplacedPort) {
    struct Replay : TaskContext, StandIn {
        Replay() : TaskContext("replay") {}
        std::string getStream(const std::string& port) const override { return "sonar." + port; }
        std::string getModel(const std::string&) const override { return "p::Task"; }
        OutputPort<double> ping{this, "ping", ""};
    } replay;
    EXPECT_EQ(streamName(replay.ping).path(), "sonar.ping");
    EXPECT_EQ(streamName(replay.ping).model, "p::Task");
}

TEST(StreamNamesTest, ReportsAliasesOfPropertiesWithTheirTargets) {
    const Deployed two(
        "tasks:\n"
        "  s: {type: test::Source, activity: {period: 1}}\n"
        "  t: {type: test::Source, activity: {period: 1},\n"
        "      aliases: {count: s.last, samples: s.value, water.depth: s.last}}\n");
    const std::vector<PropertyAlias> aliases = propertyAliases(*two.deployment.task("t"));
    ASSERT_EQ(aliases.size(), 1u) << "neither a port nor a field of a block";
    EXPECT_EQ(aliases[0].name.path(), "t.count");
    EXPECT_EQ(aliases[0].task + "." + aliases[0].property, "s.last");
}

TEST(UpstreamTest, TakesAValueFromTheNearestTaskThatHasIt) {
    const Deployed chain(
        "tasks:\n"
        "  s: {type: test::Source, activity: {period: 1}, properties: {last: 7}}\n"
        "  a: {type: test::Relay}\n  b: {type: test::Relay}\n"
        "connections:\n  - {from: s.value, to: a.in}\n  - {from: a.out, to: b.in}\n");
    const InputPortBase& port = *chain.deployment.task("b")->input("in");
    const auto last = upstreamValue(port, {"nothing", "last"});
    ASSERT_TRUE(last);
    EXPECT_EQ(std::get<int64_t>(*last), 7);
    EXPECT_FALSE(upstreamValue(port, {"nothing"}));
    EXPECT_FALSE(upstreamNumber(port, {"last"})) << "it is a whole number";
}

TEST(UpstreamTest, AValueWithinABlockIsFoundByItsPath) {
    const types::TaskRecord task{"t", "T", {{"block", "{\"a\": {\"b\": 2.5, \"c\": true, \"d\": \"5\"}}"}}, ""};
    EXPECT_EQ(valueAt(task, "block.a.b"), types::PropertyValue(2.5));
    EXPECT_EQ(valueAt(task, "block.a.c"), types::PropertyValue(true));
    EXPECT_EQ(valueAt(task, "block.a.d"), types::PropertyValue(std::string("5")));
    EXPECT_FALSE(valueAt(task, "block.x.b"));
    EXPECT_FALSE(valueAt(task, "other"));
}

}  // namespace
}  // namespace insonify::framework
