#include <gmock/gmock.h>

#include "components/framework/config/DeploymentSpec.hpp"
#include "tests/framework/Tasks.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::framework {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/** A deployment with property files in one folder. */
struct PropertySourcesTest : testing::Test {
    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
    DeploymentSpec parse(const std::string& yaml) { return DeploymentSpec::parse(yaml, (folder_ / "a.yml").string()); }
    /** Returns the merged properties of task `t` in one line. */
    std::string properties(const std::string& yaml, const std::string& task = "t") { return text(parse(yaml), task); }
    static std::string text(const DeploymentSpec& spec, const std::string& task = "t") {
        YAML::Emitter out;
        out.SetMapFormat(YAML::Flow);
        out.SetSeqFormat(YAML::Flow);
        out << spec.task(task)->properties;
        return out.c_str();
    }
    /** Returns every diagnostic, without the folder. */
    std::vector<std::string> diagnostics(const std::string& yaml, const std::vector<std::string>& sets = {}) {
        Registry registry = test::testRegistry();
        std::vector<std::string> texts = test::refused([&] {
            DeploymentSpec spec = parse(yaml);
            for (const std::string& set : sets) spec.set(set);
            Deployment deployment(spec, registry);
        });
        const std::string prefix = folder_.path().string() + "/";
        for (std::string& text : texts)
            if (text.starts_with(prefix)) text.erase(0, prefix.size());
        return texts;
    }

private:
    Folder folder_;
};

const std::string head = "tasks:\n  t:\n    type: test::Source\n    activity: {period: 1}\n";

TEST_F(PropertySourcesTest, SectionsApplyInOrderOverTheDeploymentAndBlocksAreMerged) {
    write("one.yml",
          "range: 50\nhead: {left: 1, right: 2}\nlist: [1, 2, 3]\n"
          "--- name:near\nrange: 5\nhead: {right: 9}\nlist: [7]\n");
    const std::string yaml = head + "    properties: {range: 1, gain: 2}\n";
    EXPECT_EQ(properties(yaml + "    property_files: {files: [one.yml]}\n"),
              "{gain: 2, range: 50, head: {left: 1, right: 2}, list: [1, 2, 3]}");
    EXPECT_EQ(properties(yaml + "    property_files: {files: [one.yml], sections: [default, near]}\n"),
              "{gain: 2, range: 5, head: {left: 1, right: 9}, list: [7, 2, 3]}");
    EXPECT_EQ(properties(yaml + "    property_files: {files: [one.yml], sections: [near, default]}\n"),
              "{gain: 2, range: 50, head: {left: 1, right: 2}, list: [1, 2, 3]}");
}

TEST_F(PropertySourcesTest, ChainedSectionsAreTheBase) {
    write("one.yml",
          "--- name:default\na: 1\nb: 1\nc: 1\n"
          "--- name:base\nb: 2\nc: 2\n"
          "--- name:top chain:default,base\nc: 3\n");
    EXPECT_EQ(properties(head + "    property_files: {files: [one.yml], sections: [top]}\n"), "{a: 1, b: 2, c: 3}");
}

TEST_F(PropertySourcesTest, ALaterFileIsMergedOverOrReplacesAnEarlierOne) {
    write("one.yml", "--- name:default\na: 1\nb: 1\n");
    write("two.yml", "--- name:default\nb: 2\n");
    write("three.yml", "--- name:default merge:false\nb: 3\n");
    EXPECT_EQ(properties(head + "    property_files: {files: [one.yml, two.yml]}\n"), "{a: 1, b: 2}");
    EXPECT_EQ(properties(head + "    property_files: {files: [one.yml, two.yml, three.yml]}\n"), "{b: 3}");
}

TEST_F(PropertySourcesTest, AllDiagnosticsNameTheFileAndLineOfTheValue) {
    write("one.yml", "# as Rock writes it\n--- name:default\nlast: 0\n\n--- name:more\nsed: 3\nseed: many\n");
    EXPECT_THAT(
        diagnostics(head + "    properties: {lost: 1}\n" +
                    "    property_files: {files: [one.yml], sections: [default, more]}\n"),
        ElementsAre("a.yml:5:18: tasks.t.properties.lost: is not a key here; did you mean last? known: last, seed",
                    "one.yml:3:7: last: is 0; may be 1 to 1000000",
                    "one.yml:6:1: sed: is not a key here; did you mean seed? known: last, seed",
                    "one.yml:7:7: seed: is many; must be a whole number"));
}

TEST_F(PropertySourcesTest, NamesThePlaceInAnInvalidPropertyFile) {
    write("bad.yml",
          "--- name:a b:c\n"
          "last: [1\n"
          "---\n"
          "--- name:a\n"
          "--- name:loop chain:loop,nobody\n"
          "- 1\n"
          "--- name:ruby\n"
          "last: <%= 3 %>\n");
    EXPECT_THAT(
        diagnostics(head + "    property_files: {files: [bad.yml, no.yml], sections: [loop, defalt]}\n"),
        testing::UnorderedElementsAre(
            HasSubstr("a.yml:5:21: tasks.t.property_files.sections: there is no section defalt"),
            HasSubstr("bad.yml:1:1: has b:c in the head of a section"), HasSubstr("bad.yml:3:1: is not YAML"),
            HasSubstr("bad.yml:3:1: starts a section without a name"),
            HasSubstr("bad.yml:5:1: loop: chains loop, which chains it"),
            HasSubstr("bad.yml:5:1: loop: chains nobody; "), HasSubstr("bad.yml:6:1: loop: is a list; must be a block"),
            HasSubstr("bad.yml:8:1: holds Ruby, which is not run"),
            HasSubstr("a.yml:5:39: tasks.t.property_files.files[1]: is no.yml, which cannot be opened; must be a "
                      "property file")));
    write("twice.yml", "--- name:a\nlast: 1\n--- name:a\nlast: 2\n");
    EXPECT_THAT(diagnostics(head + "    property_files: {files: [twice.yml], sections: [a]}\n"),
                ElementsAre("twice.yml:3:1: a: is a section that is given twice; once is allowed"));
}

TEST_F(PropertySourcesTest, CopiesAValueToAPropertyOfAnyTask) {
    write("one.yml", "model: fine\n");
    const std::string yaml = head +
                             "    copies: {model: other.display.model}\n    properties: {model: coarse, last: 3}\n" +
                             "  other: {type: test::Source, activity: {period: 1}, properties: {display: {gain: 1}}}\n";
    EXPECT_EQ(properties(yaml), "{model: coarse, last: 3}");
    EXPECT_EQ(properties(yaml, "other"), "{display: {gain: 1, model: coarse}}");
    DeploymentSpec spec = parse(yaml);
    spec.set("t.model=fine");
    EXPECT_EQ(text(spec), "{last: 3, model: fine}");
    EXPECT_EQ(text(spec, "other"), "{display: {gain: 1, model: fine}}");
    const std::string read = head + "    copies: {model: other.model}\n    property_files: {files: [one.yml]}\n" +
                             "  other: {type: test::Source, activity: {period: 1}}\n";
    EXPECT_EQ(properties(read), "{model: fine}");
    EXPECT_EQ(properties(read, "other"), "{model: fine}");
    EXPECT_THAT(diagnostics(head + "    copies: {last: nobody.x}\n"),
                ElementsAre("a.yml:5:20: tasks.t.copies.last: there is no task nobody; known: t"));
}

TEST_F(PropertySourcesTest, AnAliasLeadsToAPropertyOfAnyTask) {
    write("one.yml", "beam_width: {rad: 20.deg}\nwater: {kelvin: 280, salt: 35}\n");
    const std::string yaml =
        head +
        "    aliases: {beam_width: t.head.width_deg, water.kelvin: other.celsius}\n"
        "    property_files: {files: [one.yml]}\n"
        "  other: {type: test::Source, activity: {period: 1}, properties: {celsius: 1, seed: 2}}\n";
    EXPECT_EQ(properties(yaml), "{water: {salt: 35}, head: {width_deg: {rad: 20.deg}}}");
    EXPECT_EQ(properties(yaml, "other"), "{seed: 2, celsius: 280}");
}

TEST_F(PropertySourcesTest, ASwitchInsertsOrRemovesABlock) {
    write("one.yml", "enable_noise: false\n--- name:loud\nenable_noise: true\n");
    const auto noise = [&](const std::string& more) {
        return properties(head + "    switches: {enable_noise: t.noise}\n" + more);
    };
    EXPECT_EQ(noise("    properties: {enable_noise: true, a: 1}\n"), "{a: 1, noise: {}}");
    EXPECT_EQ(noise("    properties: {enable_noise: true, noise: {law: 3}}\n"), "{noise: {law: 3}}");
    EXPECT_EQ(noise("    properties: {a: 1, noise: {law: 3}}\n    property_files: {files: [one.yml]}\n"), "{a: 1}");
    EXPECT_EQ(noise("    property_files: {files: [one.yml], sections: [default, loud]}\n"), "{noise: {}}");
}

TEST_F(PropertySourcesTest, ReportsDiagnosticsOfAliasesAtThePlaceOfTheValue) {
    write("one.yml", "count: 0\nloud: 3\n");
    EXPECT_THAT(
        diagnostics(head + "    aliases: {count: t.last, of_nobody: nobody.x, short: last}\n"
                           "    switches: {loud: t.noise}\n"
                           "    properties: {of_nobody: 1}\n"
                           "    property_files: {files: [one.yml]}\n"),
        ElementsAre("a.yml:5:41: tasks.t.aliases.of_nobody: there is no task nobody; known: t",
                    "a.yml:5:58: tasks.t.aliases.short: is last; must be task.property or task.port",
                    "one.yml:1:8: count: is 0; may be 1 to 1000000", "one.yml:2:7: loud: is 3; may be true or false"));
}

TEST_F(PropertySourcesTest, SettingsOverridePropertyFilesAndAcceptAliases) {
    write("one.yml", "last: 5\nhead: {left: 1}\n");
    DeploymentSpec spec = parse(head +
                                "    aliases: {count: t.last}\n    switches: {loud: t.noise}\n"
                                "    property_files: {files: [one.yml]}\n");
    spec.set("t.head.left=7");
    spec.set("t.count=8");
    spec.set("t.loud=true");
    EXPECT_THAT(spec.diagnostics, IsEmpty());
    EXPECT_EQ(text(spec), "{head: {left: 7}, last: 8, noise: {}}");
    EXPECT_THAT(diagnostics(head + "    aliases: {count: t.last}\n", {"t.count=0"}),
                ElementsAre("--set: tasks.t.properties.count: is 0; may be 1 to 1000000"));
}

TEST_F(PropertySourcesTest, IgnoredPropertiesAreOmittedAndNamed) {
    write("one.yml", "height: 600\nlast: 5\nwater: {kelvin: 280, depth: 3}\n");
    const std::string yaml =
        head +
        "    aliases: {water.kelvin: t.last}\n    ignored_properties: [height, water.depth, of_none]\n"
        "    property_files: {files: [one.yml]}\n";
    const DeploymentSpec spec = parse(yaml);
    EXPECT_THAT(spec.diagnostics, IsEmpty());
    EXPECT_EQ(text(spec), "{last: 280}");
    EXPECT_THAT(spec.unused(), ElementsAre("t: omitted by ignored_properties: height, water.depth"));
    EXPECT_THAT(diagnostics(yaml, {"t.height=3"}),
                ElementsAre(HasSubstr("t.height=3: is one of the task's ignored_properties")));
}

TEST_F(PropertySourcesTest, KnownNamesIncludeAliasesAndSwitches) {
    write("one.yml", "coumt: 4\nwater: {depht: 3}\n");
    EXPECT_THAT(
        diagnostics(head + "    aliases: {count: t.last, water.depth: t.last, samples: t.value}\n"
                           "    property_files: {files: [one.yml]}\n"),
        ElementsAre("one.yml:1:1: coumt: is not a key here; did you mean count? known: last, seed, count, water",
                    "one.yml:2:9: water.depht: is not a key here; did you mean depth? known: depth"));
}

TEST_F(PropertySourcesTest, KnownPortsIncludeAliases) {
    const std::string yaml =
        "tasks:\n  s: {type: test::Source, activity: {period: 1}, aliases: {samples: s.value, command: r.in}}\n"
        "  r: {type: test::Relay}\nconnections: [{from: s.sample, to: r.in}]\n";
    EXPECT_THAT(diagnostics(yaml), testing::Contains(HasSubstr("s has no output port sample; did you mean samples? ")));
}

TEST_F(PropertySourcesTest, TheModelIsThatOfThePropertyFilesOrTheType) {
    write("rock::Task.yml", "last: 5\n");
    EXPECT_EQ(parse(head).task("t")->model(), "test::Source");
    EXPECT_EQ(parse(head + "    property_files: {files: [rock::Task.yml]}\n").task("t")->model(), "rock::Task");
    EXPECT_EQ(parse(head + "    property_files: {files: [one.yml]}\n").task("t")->model(), "test::Source");
}

TEST_F(PropertySourcesTest, APortIsConnectedByItsAlias) {
    Registry registry = test::testRegistry();
    Deployment deployment(parse("tasks:\n"
                                "  s: {type: test::Source, activity: {period: 1}, aliases: {samples: r.out}}\n"
                                "  r: {type: test::Relay, aliases: {command: r.in}}\n"
                                "  last: {type: test::Relay}\n"
                                "connections:\n"
                                "  - {from: s.value, to: r.command}\n"
                                "  - {from: s.samples, to: last.in}\n"),
                          registry);
    ASSERT_EQ(deployment.connections().size(), 2u);
    EXPECT_EQ(deployment.connections()[0].text(), "s.value>r.in");
    EXPECT_EQ(deployment.connections()[1].text(), "r.out>last.in");
}

}  // namespace
}  // namespace insonify::framework
