#include <gmock/gmock.h>

#include "components/framework/Wiring.hpp"
#include "tests/framework/Tasks.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::framework {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::atomic<bool> never{false};

struct LockstepRun {
    Registry registry = test::testRegistry();
    std::unique_ptr<Deployment> deployment;
    RunResult result;
    explicit LockstepRun(const std::string& yaml, const RunLimits& limits = {}, uint64_t seed = 0) {
        deployment = std::make_unique<Deployment>(DeploymentSpec::parse(yaml, "a.yml"), registry, ".", seed);
        deployment->configure();
        result = deployment->run(limits, never);
    }
    std::vector<std::string> notes(const std::string& task) {
        return dynamic_cast<test::Relay&>(*deployment->task(task)).notes;
    }
};

const char* chain = R"(
tasks:
  last: {type: test::Relay}
  middle: {type: test::Relay, activity: {trigger: [in]}}
  source: {type: test::Source, activity: {period: 0.1}}
connections:
  - {from: middle.out, to: last.in}
  - {from: source.value, to: middle.in}
)";

TEST(DeploymentRunTest, InLockstepWritersRunBeforeReadersAtEachInstantOfSimulatedTime) {
    LockstepRun run(chain);
    EXPECT_FALSE(run.result.failed());
    EXPECT_EQ(run.notes("middle"),
              (std::vector<std::string>{"middle:1@1000000", "middle:2@1100000", "middle:3@1200000"}));
    EXPECT_EQ(run.notes("last"),
              (std::vector<std::string>{"last:101@1000000", "last:102@1100000", "last:103@1200000"}));
    EXPECT_NEAR(run.result.elapsed_s, 0.2, 1e-9);
}

TEST(DeploymentRunTest, TheSameDeploymentGivesTheSameRun) {
    EXPECT_EQ(LockstepRun(chain).notes("last"), LockstepRun(chain).notes("last"));
}

TEST(DeploymentRunTest, PaceLimitsSimulatedTimePerWallClockTime) {
    LockstepRun run(chain, {.pace = 0.5});
    EXPECT_GE(run.result.wall_s, 0.4) << "0.2 s of simulated time at half the pace";
    EXPECT_EQ(run.notes("last"), LockstepRun(chain).notes("last"));
}

TEST(DeploymentRunTest, StopDoesNotWaitForThePace) {
    Registry registry = test::testRegistry();
    Deployment deployment(DeploymentSpec::parse(chain, "a.yml"), registry);
    deployment.configure();
    std::atomic<bool> stop{false};
    const RunResult result = deployment.run({.pace = 1e-6}, stop, [&](const Progress&) { stop = true; });
    EXPECT_FALSE(result.failed());
    EXPECT_LT(result.wall_s, 3600) << "the second instant would be due after a day";
}

TEST(DeploymentRunTest, TimeStartsAtStartTimeAndInstantsDoNotDrift) {
    LockstepRun run(std::string("start_time: 10\n") + chain, {.duration_s = 100});
    EXPECT_EQ(run.notes("last").front(), "last:101@10000000");
    EXPECT_EQ(run.notes("last").back(), "last:1100@109900000");
}

TEST(DeploymentRunTest, TasksDueAtOnceRunInFileOrder) {
    LockstepRun run(R"(
tasks:
  slow: {type: test::Source, activity: {period: 0.3}, properties: {last: 2}}
  fast: {type: test::Source, activity: {period: 0.1}}
  relay: {type: test::Relay}
connections:
  - {from: fast.value, to: relay.in, policy: {type: buffer, size: 9}}
  - {from: slow.value, to: relay.in, policy: {type: buffer, size: 9}}
)");
    EXPECT_EQ(run.notes("relay"), (std::vector<std::string>{"relay:1@1000000", "relay:1@1000000", "relay:2@1100000",
                                                            "relay:3@1200000", "relay:4@1300000", "relay:2@1300000"}));
}

TEST(DeploymentRunTest, ATriggeredTaskRunsUntilItsPortsAreEmptyAndLossesAreCounted) {
    LockstepRun run(R"(
tasks:
  burst: {type: test::Burst, activity: {period: 0.1}}
  all: {type: test::Relay}
  four: {type: test::Relay}
  one: {type: test::Relay}
connections:
  - {from: burst.value, to: all.in, policy: {type: buffer, size: 10}}
  - {from: burst.value, to: four.in, policy: {type: circular_buffer, size: 4}}
  - {from: burst.value, to: one.in}
)");
    EXPECT_EQ(run.notes("all").size(), 10u);
    EXPECT_EQ(run.notes("four").front(), "four:6@1000000");
    EXPECT_EQ(run.notes("one"), (std::vector<std::string>{"one:9@1000000"}));
    EXPECT_EQ(run.deployment->losses(),
              (std::map<std::string, uint64_t>{
                  {"burst.value>all.in", 0}, {"burst.value>four.in", 6}, {"burst.value>one.in", 9}}));
}

TEST(DeploymentRunTest, BackwardBufferedSamplesArriveAtTheNextInstant) {
    LockstepRun run(R"(
tasks:
  source: {type: test::Source, activity: {period: 0.1}}
  a: {type: test::Relay}
  b: {type: test::Relay}
connections:
  - {from: source.value, to: a.in}
  - {from: a.out, to: b.in}
  - {from: b.out, to: a.in, policy: {type: buffer, size: 4}}
)");
    EXPECT_EQ(run.notes("a")[2], "a:201@1100000");
    EXPECT_FALSE(run.result.failed());
}

TEST(DeploymentRunTest, AThrowingTaskEndsTheRunAndTheOthersStopInOrder) {
    LockstepRun run(R"(
tasks:
  source: {type: test::Source, activity: {period: 0.1}, properties: {last: 9}}
  throwing: {type: test::Throwing}
  relay: {type: test::Relay}
connections:
  - {from: source.value, to: throwing.in}
  - {from: source.value, to: relay.in}
)");
    EXPECT_EQ(run.result.failures, (std::vector<std::string>{"throwing: updateHook: the third is too much"}));
    EXPECT_EQ(run.notes("relay").size(), 3u);
    EXPECT_EQ(run.deployment->task("throwing")->state(), TaskState::Exception);
    EXPECT_EQ(run.deployment->task("source")->state(), TaskState::Stopped);
}

/** Records its transitions in a shared list; "bad" refuses to be configured, "writer" writes on start. */
struct Tracer : TaskContext {
    explicit Tracer(const std::string& task, std::vector<std::string>& shared) : TaskContext(task), all(shared) {}
    std::vector<std::string>& all;
    InputPort<double> in{this, "in", "numbers", Need::Optional};
    OutputPort<double> out{this, "out", "numbers"};
    void note(const char* what) { all.push_back(std::string(what) + " " + name()); }
    bool configureHook() override {
        note("configure");
        if (name().starts_with("bad")) error("out of order");
        return !name().starts_with("bad");
    }
    bool startHook() override {
        note("start");
        if (name() == "writer") out.write(1);
        return true;
    }
    void updateHook() override {
        for (double value; in.readNew(value);) note("update");
    }
    void stopHook() override {
        note("stop");
        if (name() == "writer") out.write(2);
    }
    void cleanupHook() override { note("cleanup"); }
};

TEST(DeploymentRunTest, ReadersStartFirstStopLastAndLoseNoWaitingSample) {
    std::vector<std::string> all;
    Registry registry;
    registry.add(
        {"test::Tracer", "traces", [&](const std::string& name) { return std::make_unique<Tracer>(name, all); }});
    const char* yaml =
        "tasks: {reader: {type: test::Tracer}, writer: {type: test::Tracer, activity: {period: 1}}}\n"
        "connections: [{from: writer.out, to: reader.in}]\n";
    {
        Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
        deployment.configure();
        EXPECT_FALSE(deployment.run({.duration_s = 1}, never).failed());
    }
    EXPECT_EQ(all, (std::vector<std::string>{"configure reader", "configure writer", "start reader", "start writer",
                                             "update reader", "stop writer", "update reader", "stop reader",
                                             "cleanup writer", "cleanup reader"}));
}

TEST(DeploymentRunTest, NamesAllTasksThatFailToConfigureAndCleansUpTheOthers) {
    std::vector<std::string> all;
    Registry registry;
    registry.add(
        {"test::Tracer", "traces", [&](const std::string& name) { return std::make_unique<Tracer>(name, all); }});
    const char* yaml =
        "tasks:\n"
        "  bad: {type: test::Tracer, activity: {period: 1}}\n"
        "  good: {type: test::Tracer, activity: {period: 1}}\n"
        "  bad2: {type: test::Tracer, activity: {period: 1}}\n";
    Deployment deployment(DeploymentSpec::parse(yaml, "a.yml"), registry);
    EXPECT_THAT(test::refused([&] { deployment.configure(); }),
                testing::ElementsAre("a.yml:2:8: tasks.bad: configureHook refused: out of order",
                                     "a.yml:4:9: tasks.bad2: configureHook refused: out of order"));
    EXPECT_EQ(all, (std::vector<std::string>{"configure bad", "configure good", "configure bad2", "cleanup good"}));
}

TEST(DeploymentRunTest, WithoutLimitsARunEndsWithItsSources) {
    EXPECT_EQ(LockstepRun("tasks: {s: {type: test::Source, activity: {period: 1}, properties: {last: 5}}}")
                  .deployment->task("s")
                  ->cycles()
                  .count(),
              5u);
}

using Seeds = std::vector<uint64_t>;

/** Returns the seeds of sources a and b, with these properties of b, keys of the document, seed of the run, and
 *  --set. */
Seeds readSeeds(const std::string& of_b, const std::string& document = "", uint64_t seed = 0,
                const std::string& set = "") {
    Registry registry = test::testRegistry();
    DeploymentSpec spec = DeploymentSpec::parse(document +
                                                    "tasks:\n  a: {type: test::Source, activity: {period: 1}}\n"
                                                    "  b: {type: test::Source, activity: {period: 1}, "
                                                    "properties: {" +
                                                    of_b + "}}\n",
                                                "a.yml");
    if (!set.empty()) spec.set(set);
    const Deployment deployment(spec, registry, ".", seed);
    Seeds seeds;
    for (const auto& task : deployment.tasks()) seeds.push_back(dynamic_cast<test::Source&>(*task).config->seed);
    return seeds;
}

TEST(DeploymentRunTest, TaskSeedsDeriveFromTheDeploymentsSeedAndTheTasksName) {
    EXPECT_EQ(readSeeds(""), (Seeds{computeSeed(1, "a"), computeSeed(1, "b")}));
    EXPECT_NE(computeSeed(1, "a"), computeSeed(1, "b"));
    EXPECT_EQ(readSeeds("", "seed: 1\n"), readSeeds(""));
    EXPECT_EQ(readSeeds("", "seed: 5\n"), (Seeds{computeSeed(5, "a"), computeSeed(5, "b")}));
    EXPECT_EQ(readSeeds("", "seed: 0\n"), (Seeds{computeSeed(0, "a"), computeSeed(0, "b")}));
    EXPECT_EQ(readSeeds("last: 2"), readSeeds("")) << "other properties change nothing";
    EXPECT_THAT(test::refused([&] { readSeeds("", "seed: many\n"); }),
                testing::Contains(testing::StartsWith("a.yml:1:7: seed: ")));
}

TEST(DeploymentRunTest, KeepsAWrittenSeed) {
    EXPECT_EQ(readSeeds("seed: 7"), (Seeds{computeSeed(1, "a"), 7}));
    EXPECT_EQ(readSeeds("seed: 1", "seed: 5\n"), (Seeds{computeSeed(5, "a"), 1}))
        << "the struct's default, but written";
    EXPECT_EQ(readSeeds("", "", 0, "b.seed=7"), (Seeds{computeSeed(1, "a"), 7}));
    EXPECT_EQ(readSeeds("seed: 7", "", 0, "b.seed=null"), readSeeds("")) << "removed again";
}

struct PlacedConfig {
    std::optional<types::Datum> datum;
    static void describe(auto& self, auto& visit) { visit({"datum", "", "of the world"}, self.datum); }
};
struct Placed : TaskContext {
    using TaskContext::TaskContext;
    Properties<PlacedConfig> config{this};
};

/** Returns the datum of tasks a and b of a deployment with these keys of the document and properties, as texts. */
std::string readDatums(const std::string& document, const std::string& of_a = "", const std::string& of_b = "") {
    Registry registry = test::testRegistry();
    registry.add<Placed>("test::Placed", "is somewhere");
    const auto task = [](const std::string& properties) {
        return "{type: test::Placed, activity: {period: 1}, properties: {" + properties + "}}\n";
    };
    const Deployment deployment(
        DeploymentSpec::parse(document + "tasks:\n  a: " + task(of_a) + "  b: " + task(of_b), "a.yml"), registry);
    std::string texts;
    for (const auto& made : deployment.tasks()) {
        const auto& datum = dynamic_cast<Placed&>(*made).config->datum;
        texts += (datum ? text(*datum) : "none") + " ";
    }
    return texts;
}

TEST(DeploymentRunTest, ADatumOfTheDeploymentIsThatOfAllTasksThatHaveOne) {
    const std::string kiel = "{latitude_deg: 54.5, longitude_deg: 10.25, height_m: 40}";
    EXPECT_EQ(readDatums(""), "none none ");
    EXPECT_EQ(readDatums("datum: " + kiel + "\n"), kiel + " " + kiel + " ");
    EXPECT_EQ(readDatums("datum: " + kiel + "\n", "datum: " + kiel), kiel + " " + kiel + " ");
    EXPECT_EQ(readDatums("", "datum: " + kiel), kiel + " none ");
    EXPECT_EQ(readDatums("datum: {latitude_deg: -90, longitude_deg: 360}\n").substr(0, 60),
              "{latitude_deg: -90, longitude_deg: 360, height_m: 0} {latitu");
}

TEST(DeploymentRunTest, TasksWithOtherDatumsAreRefused) {
    const std::string kiel = "{latitude_deg: 54.5, longitude_deg: 10.25, height_m: 40}",
                      faro = "{latitude_deg: 37, longitude_deg: -8, height_m: 50}";
    EXPECT_THAT(test::refused([&] { readDatums("datum: " + kiel + "\n", "", "datum: " + faro); }),
                testing::ElementsAre(AllOf(testing::StartsWith("a.yml:4:"),
                                           HasSubstr("tasks.b.properties.datum: is " + faro + ", and datum is " + kiel),
                                           HasSubstr("a world has one origin"))));
    EXPECT_THAT(test::refused([&] { readDatums("", "datum: " + kiel, "datum: " + faro); }),
                testing::ElementsAre(
                    HasSubstr("tasks.b.properties.datum: is " + faro + ", and tasks.a.properties.datum is " + kiel)));
}

TEST(DeploymentRunTest, ADatumThatIsNoPlaceIsRefused) {
    const std::pair<const char*, const char*> all[] = {
        {"{latitude_deg: 91, longitude_deg: 0}", "datum.latitude_deg: is 91"},
        {"{latitude_deg: -90.001, longitude_deg: 0}", "datum.latitude_deg: is -90.001"},
        {"{latitude_deg: .nan, longitude_deg: 0}", "datum.latitude_deg: is .nan"},
        {"{latitude_deg: 54, longitude_deg: .inf}", "datum.longitude_deg: is .inf"},
        {"{latitude_deg: 54, longitude_deg: 361}", "datum.longitude_deg: is 361"},
        {"{latitude_deg: 54, longitude_deg: 10, height_m: -20000}", "datum.height_m: is -20000"},
        {"{latitude_deg: 54, longitude_deg: 10, height_m: 1e9}",
         "datum.height_m: is 1000000000 m; may be -12000 to 100000 m"},
        {"{latitude_deg: 54}", "datum.longitude_deg: is missing"},
        {"{longitude_deg: 10}", "datum.latitude_deg: is missing"},
        {"{}", "datum.latitude_deg: is missing"},
        {"{latitude: 54, longitude: 10}", "datum.latitude: is not a key here; did you mean latitude_deg?"},
        {"{latitude_deg: 54, longitude_deg: 10, latitude_deg: 54}", "latitude_deg"},
        {"[54, 10]", "datum: "},
        {"54", "datum: "},
        {"{latitude_deg: 54 N, longitude_deg: 10}", "datum.latitude_deg: is 54 N"},
        {"{latitude_deg: [54], longitude_deg: 10}", "datum.latitude_deg: "}};
    for (const auto& [datum, words] : all) {
        const auto whole = test::refused([&, given = datum] { readDatums(std::string("datum: ") + given + "\n"); });
        EXPECT_THAT(whole, testing::Contains(AllOf(testing::StartsWith("a.yml:1:"), HasSubstr(words)))) << datum;
        const auto own = test::refused([&, given = datum] { readDatums("", std::string("datum: ") + given); });
        EXPECT_THAT(own, testing::Contains(HasSubstr(words))) << datum;
    }
}

TEST(DeploymentRunTest, TheRunsSeedReachesEveryTaskWithASeed) {
    EXPECT_EQ(readSeeds("", "", 5), readSeeds("", "seed: 5\n"));
    EXPECT_EQ(readSeeds("seed: 7", "seed: 9\n", 5), readSeeds("", "", 5)) << "for any written seed";
    EXPECT_EQ(readSeeds("seed: 7", "", 5, "b.seed=8"), (Seeds{computeSeed(5, "a"), 8})) << "except --set";
}

/** Has a seed with too few bits for a hash. */
struct NarrowConfig {
    int seed = 3;
    static void describe(auto& self, auto& visit) { visit({"seed", "1", "of 31 bits", 0, 1e9}, self.seed); }
};
struct Narrow : TaskContext {
    using TaskContext::TaskContext;
    Properties<NarrowConfig> config{this};
};

TEST(DeploymentRunTest, ASeedTooNarrowForAHashKeepsItsDefault) {
    Registry registry;
    registry.add<Narrow>("test::Narrow", "has 31 bits");
    const DeploymentSpec spec =
        DeploymentSpec::parse("tasks: {n: {type: test::Narrow, activity: {period: 1}}}", "a.yml");
    const Deployment deployment(spec, registry);
    EXPECT_EQ(dynamic_cast<Narrow&>(*deployment.task("n")).config->seed, 3);
    EXPECT_THAT(test::refused([&] { Deployment(spec, registry, ".", 5); }),
                testing::ElementsAre(testing::HasSubstr("tasks.n.properties.seed")));
}

TEST(DeploymentRunTest, OperationsOfTasksAreCalledByName) {
    Registry registry = test::testRegistry();
    Deployment deployment(DeploymentSpec::parse("tasks: {s: {type: test::Source, activity: {period: 1}}}", "a.yml"),
                          registry);
    const auto why = [&](const char* operation, const std::vector<std::string>& arguments) -> std::string {
        try {
            return deployment.call(operation, arguments);
        } catch (const std::runtime_error& error) {
            return error.what();
        }
    };
    EXPECT_EQ(why("s.setLast", {"7"}), "");
    EXPECT_EQ(dynamic_cast<test::Source&>(*deployment.task("s")).config->last, 7);
    EXPECT_EQ(why("s.setLast", {"0"}), "last: is 0; may be 1 to 1000000");
    EXPECT_EQ(why("s.start", {}), "cannot start: s is PreOperational, must be Stopped");
    EXPECT_EQ(why("s.configure", {}), "");
    EXPECT_EQ(why("s.start", {}), "");
    EXPECT_EQ(why("s.setLast", {"5"}), "cannot set last: s is Running; it can when it is stopped");
    EXPECT_EQ(why("s.setLost", {"5"}).substr(0, 56), "s.setLost: s has no operation setLost; did you mean setL");
    EXPECT_EQ(why("t.start", {}), "t.start: there is no task t; known: s");
}

/** Warns when it ends. */
struct Farewell : TaskContext {
    using TaskContext::TaskContext;
    ~Farewell() override { warn("ends"); }
};

/** What takes the warnings, and whether it was there when one came. */
struct Receiver {
    struct Seen {
        int present = 0;
        std::vector<int> present_at;
    };
    explicit Receiver(Seen& where) : seen(&where) { ++seen->present; }
    Receiver(const Receiver& other) : seen(other.seen) { ++seen->present; }
    ~Receiver() { --seen->present; }
    void operator()(const std::string&) const { seen->present_at.push_back(seen->present); }

    char before[64] = {};
    Seen* seen;
};

TEST(DeploymentRunTest, TasksMayWarnUntilTheyEnd) {
    Registry registry;
    registry.add<Farewell>("test::Farewell", "warns when it ends");
    Receiver::Seen seen;
    {
        Deployment deployment(
            DeploymentSpec::parse("tasks: {f: {type: test::Farewell, activity: {period: 1}}}", "a.yml"), registry);
        deployment.onWarning(Receiver(seen));
    }
    EXPECT_EQ(seen.present_at, std::vector<int>{1});
    EXPECT_EQ(seen.present, 0);
}

}  // namespace
}  // namespace insonify::framework
