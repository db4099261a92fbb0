#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/framework/config/DeploymentSpec.hpp"
#include "tests/framework/Tasks.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::framework {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

/** Returns every diagnostic of a deployment, as reported before anything starts. */
std::vector<std::string> findDiagnostics(const std::string& yaml, const std::vector<std::string>& sets = {}) {
    Registry registry = test::testRegistry();
    return test::refused([&] {
        DeploymentSpec spec = DeploymentSpec::parse(yaml, "a.yml");
        for (const std::string& set : sets) spec.set(set);
        Deployment deployment(spec, registry);
    });
}

TEST(DeploymentSpecTest, ReportsAllDiagnosticsOfAFileAtOnce) {
    const char* yaml =
        "schedule: sometimes\n"
        "color: red\n"
        "tasks:\n"
        "  source: {type: test::Source, activity: {period: -1}, properties: {last: 0, sed: 3}}\n"
        "  source: {type: test::Source}\n"
        "  ghost: {type: test::Gost}\n"
        "  relay: {type: test::Relay, activity: {trigger: [inn]}}\n"
        "  idle: {type: test::Relay, activty: {}}\n"
        "  words: {type: test::Words}\n"
        "connections:\n"
        "  - {from: source.value, to: relay.in}\n"
        "  - {from: source.value, to: relay.in}\n"
        "  - {from: source.valu, to: relay.extra}\n"
        "  - {from: sorce.value, to: nobody.in}\n"
        "  - {from: burst, to: relay.in}\n"
        "  - {from: relay.out, to: words.in}\n"
        "  - {from: relay.out, to: relay.extra, policy: {type: ring, size: 0}}\n";
    EXPECT_THAT(
        findDiagnostics(yaml),
        UnorderedElementsAre(
            "a.yml:1:11: schedule: is sometimes; may be lockstep, realtime",
            HasSubstr("a.yml:2:1: color: is not a key here"),
            "a.yml:4:51: tasks.source.activity.period: is -1 s; may be 1e-06 to 1000000 s",
            "a.yml:4:75: tasks.source.properties.last: is 0; may be 1 to 1000000",
            "a.yml:4:78: tasks.source.properties.sed: is not a key here; did you mean seed? known: last, seed",
            "a.yml:5:3: tasks.source: is given twice; once is allowed",
            HasSubstr("a.yml:6:17: tasks.ghost.type: is test::Gost; did you mean "),
            "a.yml:7:40: tasks.relay.activity.trigger: there is no input port inn; did you mean in? known: in, extra",
            HasSubstr("a.yml:8:29: tasks.idle.activty: is not a key here; did you mean activity?"),
            "a.yml:8:9: tasks.idle: input port in (/double) is not connected; it must be",
            "a.yml:12:5: connections[1]: is given twice: source.value>relay.in",
            HasSubstr("a.yml:13:12: connections[2].from: source has no output port valu; did you mean value?"),
            HasSubstr("a.yml:14:12: connections[3].from: there is no task sorce; did you mean source?"),
            HasSubstr("a.yml:14:29: connections[3].to: there is no task nobody"),
            "a.yml:15:12: connections[4].from: is \"burst\"; must be task.port",
            "a.yml:16:5: connections[5]: relay.out is /double, words.in is /std/string; types must be equal",
            "a.yml:17:55: connections[6].policy.type: is ring; may be data, buffer, circular_buffer",
            "a.yml:17:67: connections[6].policy.size: is 0; may be 1 to 1000000"));
}

TEST(DeploymentSpecTest, SchedulersPrioritiesAndProcessorsAreChecked) {
    const char* yaml =
        "watchdog: 0\n"
        "lock_memory: maybe\n"
        "tasks:\n"
        "  a: {type: test::Source, activity: {period: 1, scheduler: rr, cpus: [-1], deadline: 0}}\n"
        "  b: {type: test::Source, activity: {period: 1, scheduler: fifo}}\n"
        "  c: {type: test::Source, activity: {period: 1, priority: 5}}\n"
        "  d: {type: test::Source, activity: {period: 1, scheduler: fifo, priority: 100, cpus: [1, 2000]}}\n";
    EXPECT_THAT(
        findDiagnostics(yaml),
        UnorderedElementsAre(
            "a.yml:1:11: watchdog: is 0 s; may be 0.001 to 1000000 s", HasSubstr("a.yml:2:14: lock_memory: is maybe"),
            "a.yml:4:60: tasks.a.activity.scheduler: is rr; may be other, fifo",
            HasSubstr("tasks.a.activity.cpus[0]: is -1"), HasSubstr("tasks.a.activity.deadline: is 0 s"),
            HasSubstr("tasks.b.activity: has no priority; scheduler: fifo needs one, from 1 to 99"),
            HasSubstr("tasks.c.activity.priority: has no effect with scheduler: other"),
            HasSubstr("tasks.d.activity.priority: is 100"), HasSubstr("tasks.d.activity.cpus[1]: is 2000")));
}

TEST(DeploymentSpecTest, NamesAMissingPortAndTheExistingPorts) {
    EXPECT_THAT(
        findDiagnostics("tasks:\n"
                        "  s: {type: test::Source, activity: {period: 1}}\n"
                        "  r: {type: test::Relay}\n"
                        "connections:\n"
                        "  - {from: s.vlue, to: r.in}\n"
                        "  - {from: s.value, to: r.inn}\n"),
        ElementsAre(
            "a.yml:5:12: connections[0].from: s has no output port vlue; did you mean value? known: state, value",
            "a.yml:6:25: connections[1].to: r has no input port inn; did you mean in? known: in, extra"));
}

TEST(DeploymentSpecTest, ALoopNeedsABuffer) {
    const std::string head =
        "tasks:\n"
        "  s: {type: test::Source, activity: {period: 1}}\n"
        "  a: {type: test::Relay}\n"
        "  b: {type: test::Relay}\n"
        "connections:\n"
        "  - {from: s.value, to: a.in}\n"
        "  - {from: a.out, to: b.in}\n";
    EXPECT_THAT(findDiagnostics(head + "  - {from: b.out, to: a.extra}\n"),
                testing::Contains(HasSubstr("closes a loop without a buffer")));
    EXPECT_THAT(findDiagnostics(head + "  - {from: b.out, to: a.extra, policy: {type: buffer, size: 1}}\n"),
                testing::IsEmpty());
    EXPECT_THAT(findDiagnostics(head + "  - {from: b.out, to: b.extra, policy: {type: buffer, size: 1}}\n"),
                ElementsAre("a.yml:8:5: connections[2]: connects b with itself"));
}

TEST(DeploymentSpecTest, RefusesATaskThatNothingRuns) {
    EXPECT_THAT(findDiagnostics("tasks: {s: {type: test::Source}}"),
                ElementsAre(HasSubstr("has nothing that would run it")));
    EXPECT_THAT(findDiagnostics("tasks: {d: {type: test::Doorbell}}"), testing::IsEmpty()) << "an Event runs it";
    EXPECT_THAT(findDiagnostics("tasks: {s: {type: test::Source, activity: {period: 1, trigger: [a]}}}"),
                testing::Contains(HasSubstr("both period and trigger")));
    EXPECT_THAT(findDiagnostics("tasks: {s: {type: test::Source, activity: {period: .nan}}}"),
                testing::Contains(HasSubstr("must be a finite number")));
}

TEST(DeploymentSpecTest, RefusesATextThatIsNotADeployment) {
    EXPECT_THAT(findDiagnostics(""), ElementsAre("a.yml: is empty; a deployment needs tasks"));
    EXPECT_THAT(findDiagnostics("# nothing\n"), ElementsAre(HasSubstr("is empty")));
    EXPECT_THAT(findDiagnostics("tasks: {}"), ElementsAre("a.yml:1:8: tasks: is empty; a deployment needs a task"));
    for (const char* wrong : {"tasks: 5", "tasks: [a]", "tasks: []"})
        EXPECT_THAT(findDiagnostics(wrong), ElementsAre(HasSubstr("; must be a block of keys and values"))) << wrong;
    EXPECT_THAT(findDiagnostics("hello"),
                ElementsAre("a.yml:1:1: is hello; must be a block of keys and values, such as {schedule: lockstep}"));
    EXPECT_THAT(findDiagnostics("- 1\n"), ElementsAre(HasSubstr("is a list")));
    EXPECT_THAT(findDiagnostics("tasks:\n  a: [1\nb: 2\n"), ElementsAre(HasSubstr("a.yml:3:2: is not YAML")));
    EXPECT_THAT(findDiagnostics("tasks: {a: *nobody}"), ElementsAre(HasSubstr("is not YAML")));
    EXPECT_THAT(findDiagnostics("tasks: {}\n---\ntasks: {}\n"), ElementsAre(HasSubstr("several YAML documents")));
    EXPECT_THAT(findDiagnostics(std::string("\0\1\2\xff", 4)), ElementsAre(HasSubstr("is not text")));
    EXPECT_THAT(findDiagnostics("tasks: {[1, 2]: 3}"), testing::Contains(HasSubstr("has a key that is a list")));
    EXPECT_THAT(findDiagnostics("tasks: 3\nconnections: 4\nlibraries: {}\n"), testing::SizeIs(3));
}

TEST(DeploymentSpecTest, RefusesInvalidStartsOfValuesInsteadOfReadingForever) {
    for (const char* text : {",", "]", "}", ", 2.5, \"x\"]\nc: {d: .nan}\n", "--- a\n---\n,", "- a\n--- ]\n"})
        EXPECT_THAT(findDiagnostics(text), ElementsAre(HasSubstr("a.yml:"))) << text;
    EXPECT_THAT(findDiagnostics("tasks: {source: {type: test::Source}}\n", {"source.last=,"}),
                testing::Contains(HasSubstr("this cannot begin a value")));
}

TEST(DeploymentSpecTest, DeepNestingIsRefusedNotFatal) {
    for (const char* bracket : {"[", "{", "[a: ", "- ", "? "}) {
        std::string yaml = "tasks: ";
        for (int i = 0; i < 100000; ++i) yaml += bracket;
        EXPECT_THAT(findDiagnostics(yaml), testing::SizeIs(1)) << bracket;
    }
}

TEST(DeploymentSpecTest, AMissingFileAndADirectoryAreNamed) {
    EXPECT_THAT(test::refused([] { DeploymentSpec::load("no/such.yml"); }),
                ElementsAre("no/such.yml: cannot be opened; must be a deployment file"));
    EXPECT_THAT(test::refused([] { DeploymentSpec::load("."); }),
                ElementsAre(".: is a directory; must be a deployment file"));
}

TEST(DeploymentSpecTest, SettingsOverrideTheFile) {
    Registry registry = test::testRegistry();
    DeploymentSpec spec = DeploymentSpec::parse(
        "tasks: {s: {type: test::Source, activity: {period: 1}, properties: {last: 5}}}", "a.yml");
    spec.set("s.last=7");
    spec.set("s.seed=11");
    Deployment deployment(spec, registry);
    const auto& config = dynamic_cast<test::Source&>(*deployment.task("s")).config;
    EXPECT_EQ(config->last, 7);
    EXPECT_EQ(config->seed, 11u);
}

TEST(DeploymentSpecTest, SettingsReachIntoBlocks) {
    DeploymentSpec spec = DeploymentSpec::parse("tasks: {s: {type: t, properties: {tvg: {a: 1, b: 2}}}}", "a.yml");
    spec.set("s.tvg.b=[3]");
    spec.set("s.water.depth=8");
    const YAML::Node properties = spec.task("s")->properties;
    EXPECT_EQ(properties["tvg"]["a"].as<int>(), 1);
    EXPECT_EQ(properties["tvg"]["b"][0].as<int>(), 3);
    EXPECT_EQ(properties["water"]["depth"].as<int>(), 8);
}

TEST(DeploymentSpecTest, NamesSettingsThatDoNotFit) {
    EXPECT_THAT(findDiagnostics("tasks: {s: {type: test::Source, activity: {period: 1}}}",
                                {"s.last=many", "s.lost=1", "t.last=1", "s.last", "s=1", "s.seed=[", "s.last="}),
                UnorderedElementsAre("--set: tasks.s.properties.last: is many; must be a whole number",
                                     HasSubstr("--set: tasks.s.properties.lost: is not a key here; did you mean last?"),
                                     HasSubstr("--set: t.last=1: there is no task t; known: s"),
                                     "--set: s.last: must be task.property=value",
                                     "--set: s=1: must be task.property=value, namespace=value or frame_prefix=value",
                                     HasSubstr("--set: s.seed=[: is not YAML"),
                                     "--set: s.last=: has no value; null removes the property"));
    for (const char* nothing : {"%5", "#5", " ", "...", "---", "%06d.png"})
        EXPECT_THAT(findDiagnostics("tasks: {s: {type: test::Source, activity: {period: 1}}}",
                                    {std::string("s.last=") + nothing}),
                    ElementsAre(HasSubstr(std::string("is `") + nothing + "`, which YAML takes for nothing")))
            << nothing;
    for (const char* absent : {"null", "~", "NULL"})
        EXPECT_THAT(findDiagnostics("tasks: {s: {type: test::Source, activity: {period: 1}}}",
                                    {std::string("s.last=") + absent}),
                    testing::IsEmpty())
            << absent;
}

}  // namespace
}  // namespace insonify::framework
