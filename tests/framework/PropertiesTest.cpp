#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "components/framework/Properties.hpp"
#include "components/framework/config/DeploymentSpec.hpp"

namespace insonify {
namespace {

using types::Field;

enum class Law { Rayleigh, Gaussian };

struct Speckle {
    Law law = Law::Rayleigh;
    double mean = 0.4;
    static void describe(auto& self, auto& visit) {
        visit({"law", "", "distribution"}, self.law);
        visit({"mean", "1", "of the factor", 0, 10}, self.mean);
    }
};

struct Config {
    double range = 50;
    int32_t bins = 500;
    uint64_t seed = 1;
    int64_t offset = 0;
    bool loud = false;
    std::string file;
    glm::dvec3 position{0};
    std::optional<Speckle> speckle;
    std::optional<double> gain;
    std::vector<double> bearings;
    std::vector<Speckle> layers;
    std::map<std::string, Speckle> materials;
    Speckle always;
    static void describe(auto& self, auto& visit) {
        visit({"range", "m", "far edge", 0.1, 500}, self.range);
        visit({"bins", "1", "per beam", 1, 65536}, self.bins);
        visit({"seed", "1", "of the noise"}, self.seed);
        visit({"offset", "1", "any"}, self.offset);
        visit({"loud", "", "or not"}, self.loud);
        visit({"file", "", "to read"}, self.file);
        visit({"position", "m", "of the sensor", -100, 100}, self.position);
        visit({"speckle", "", "noise"}, self.speckle);
        visit({"gain", "dB", "if any"}, self.gain);
        visit({"bearings", "deg", "centres", -180, 180}, self.bearings);
        visit({"layers", "", "some"}, self.layers);
        visit({"materials", "", "by name"}, self.materials);
        visit({"always", "", "a block"}, self.always);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (loud && file.empty()) diagnostics.push_back({"loud", "needs file"});
        if (layers.size() > 1) diagnostics.push_back({"layers[1].mean", "is one too many"});
    }
};

struct Task : framework::TaskContext {
    using TaskContext::TaskContext;
    framework::Properties<Config> config{this};
};

std::vector<std::string> findDiagnostics(Task& task, const std::string& yaml) {
    framework::ConfigReader reader("a.yml");
    task.config.load(reader, YAML::Load(yaml), "p");
    std::vector<std::string> texts;
    for (const auto& diagnostic : reader.diagnostics()) texts.push_back(diagnostic.text());
    return texts;
}

}  // namespace
}  // namespace insonify

template <>
struct insonify::types::EnumNames<insonify::Law> {
    static constexpr std::string_view names[] = {"rayleigh", "gaussian"};
};

namespace insonify {
namespace {

TEST(PropertiesTest, EveryKindOfMemberIsRead) {
    Task task("t");
    const char* yaml = R"(
range: 12.5
bins: 1e3
seed: 18446744073709551615
offset: -9223372036854775808
loud: true
file: a.glb
position: [1, -2.5, 3]
speckle:
gain: -3
bearings: [-10, 0, 10]
layers: [{law: gaussian}]
materials: {sand: {mean: 0.1}, rock: {mean: 0.2}}
always: {mean: 2}
)";
    EXPECT_THAT(findDiagnostics(task, yaml), testing::IsEmpty());
    const Config& config = *task.config;
    EXPECT_EQ(config.range, 12.5);
    EXPECT_EQ(config.bins, 1000);
    EXPECT_EQ(config.seed, std::numeric_limits<uint64_t>::max());
    EXPECT_EQ(config.offset, std::numeric_limits<int64_t>::min());
    EXPECT_TRUE(config.loud);
    EXPECT_EQ(config.file, "a.glb");
    EXPECT_EQ(config.position, glm::dvec3(1, -2.5, 3));
    ASSERT_TRUE(config.speckle);  // an empty block is present
    EXPECT_EQ(config.speckle->mean, 0.4);
    EXPECT_EQ(config.gain, -3);
    EXPECT_EQ(config.bearings, (std::vector<double>{-10, 0, 10}));
    EXPECT_EQ(config.layers.at(0).law, Law::Gaussian);
    EXPECT_EQ(config.materials.at("rock").mean, 0.2);
    EXPECT_EQ(config.always.mean, 2);
    EXPECT_EQ(config.always.law, Law::Rayleigh);
}

TEST(PropertiesTest, NumbersChangeTogetherOrNotAtAllAndDottedNamesReachIntoBlocks) {
    Task task("t");
    task.config.change({{"range", 12.5}, {"always.mean", 0.1 + 0.2}, {"bins", 7}});
    EXPECT_EQ(task.config->range, 12.5);
    EXPECT_EQ(task.config->always.mean, 0.1 + 0.2) << "to the last bit";
    EXPECT_EQ(task.config->bins, 7);
    const auto refusal = [&](const std::map<std::string, std::optional<double>>& values) -> std::string {
        try {
            task.config.change(values);
        } catch (const types::ConfigError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(refusal({{"bins", 8}, {"rang", 5}}),
                testing::HasSubstr("rang: is not a key here; did you mean range?"));
    EXPECT_THAT(refusal({{"range", std::nan("")}}), testing::HasSubstr("must be a finite number"));
    EXPECT_THAT(refusal({{"always", 1}, {"always.mean", 2}}), testing::HasSubstr("is given as a block and as a value"));
    EXPECT_THAT(refusal({{"always.mean", 2}, {"bins", 1.5}}), testing::HasSubstr("must be a whole number"));
    EXPECT_EQ(task.config->bins, 7) << "all or none";
    EXPECT_EQ(task.config->always.mean, 0.1 + 0.2);
    task.config.change({{"range", std::nullopt}});
    EXPECT_EQ(task.config->range, Config().range);
}

/** The results of a value in a deployment's properties, in one `--set` and in a live setter, and the state after
 *  both. */
TEST(PropertiesTest, SettingsFromOutsideAndLiveAreEquivalent) {
    const std::string written =
        "{range: 20, speckle: {law: gaussian, mean: 2}, gain: 3, bearings: [1, 2], materials: {a: {mean: 3}, b: {mean: "
        "4}}, always: {law: gaussian, mean: 7}}";
    const std::pair<const char*, const char*> settings[] = {
        {"range", "30"},
        {"range", "null"},
        {"gain", "null"},
        {"speckle", "{mean: 5}"},
        {"speckle", "{mean: null}"},
        {"speckle", "{}"},
        {"speckle", "null"},
        {"bearings", "[9]"},
        {"materials", "{a: {law: gaussian}, b: null, c: {mean: 6}}"},
        {"always", "{law: null}"},
        {"always", "null"}};
    for (const auto& [name, value] : settings) {
        const std::string setting = std::string(name) + "=" + value;
        Task live("t"), set("t");
        ASSERT_THAT(findDiagnostics(live, written), testing::IsEmpty());
        static_cast<framework::PropertiesBase&>(live.config).set(name, value);
        framework::DeploymentSpec spec =
            framework::DeploymentSpec::parse("tasks: {t: {type: t, properties: " + written + "}}", "a.yml");
        spec.set("t." + setting);
        framework::ConfigReader reader("a.yml");
        set.config.load(reader, spec.task("t")->properties, "");
        EXPECT_TRUE(spec.diagnostics.empty() && reader.diagnostics().empty()) << setting;
        EXPECT_EQ(live.config.values(), set.config.values()) << setting;
    }
}

TEST(PropertiesTest, NullRemovesAndUnnamedFieldsOfABlockStay) {
    Task task("t");
    ASSERT_THAT(findDiagnostics(task, "{range: 20, speckle: {law: gaussian, mean: 2}, gain: 3}"), testing::IsEmpty());
    framework::PropertiesBase& properties = task.config;
    properties.set("speckle", "{mean: 5}");
    EXPECT_EQ(task.config->speckle->law, Law::Gaussian);
    EXPECT_EQ(task.config->speckle->mean, 5);
    properties.set("speckle", "null");
    properties.set("gain", "null");
    properties.set("range", "null");
    EXPECT_FALSE(task.config->speckle || task.config->gain);
    EXPECT_EQ(task.config->range, 50);
}

TEST(PropertiesTest, ReportsEveryDiagnosticAtItsPlaceAtOnce) {
    Task task("t");
    const char* yaml =
        "rang: 3\n"
        "range: 1000\n"
        "bins: 1.5\n"
        "seed: -1\n"
        "offset: 9223372036854775808\n"
        "loud: yes\n"
        "file: [a]\n"
        "position: [1, 2]\n"
        "speckle: {law: poisson, mean: .nan}\n"
        "gain: \"3\"\n"
        "bearings: [0, 200, x]\n"
        "layers: gaussian\n"
        "materials: {sand: {mean: 11}}\n"
        "always: {mean: 1, mean: 2}\n";
    EXPECT_THAT(
        findDiagnostics(task, yaml),
        testing::UnorderedElementsAre(
            "a.yml:1:1: p.rang: is not a key here; did you mean range? known: range, bins, seed, offset, loud, file, "
            "position, speckle, gain, bearings, layers, materials, always",
            "a.yml:2:8: p.range: is 1000 m; may be 0.1 to 500 m", "a.yml:3:7: p.bins: is 1.5; must be a whole number",
            "a.yml:4:7: p.seed: is -1; must be a whole number from 0 to 18446744073709551615",
            "a.yml:5:9: p.offset: is 9223372036854775808; must be a whole number from -9223372036854775808 to "
            "9223372036854775807",
            "a.yml:6:7: p.loud: is yes; write true; may be true or false",
            "a.yml:7:7: p.file: is a list; must be a text",
            "a.yml:8:11: p.position: is a list of 2; must be a list of three numbers [x, y, z]",
            "a.yml:9:16: p.speckle.law: is poisson; may be rayleigh, gaussian",
            "a.yml:9:31: p.speckle.mean: is .nan; must be a finite number",
            "a.yml:10:7: p.gain: is the text \"3\"; must be a finite number",
            "a.yml:11:15: p.bearings[1]: is 200 deg; may be -180 to 180 deg",
            "a.yml:11:20: p.bearings[2]: is x; must be a finite number",
            "a.yml:12:9: p.layers: is gaussian; must be a list, such as [{law: rayleigh}]",
            "a.yml:13:26: p.materials.sand.mean: is 11; may be 0 to 10",
            "a.yml:14:19: p.always.mean: is given twice; once is allowed"));
}

TEST(PropertiesTest, ReportsDiagnosticsOfSeveralFieldsAtTheBlock) {
    Task task("t");
    EXPECT_THAT(findDiagnostics(task, "range: 1\nloud: true\nlayers:\n  - {}\n  - {law: gaussian, mean: 3}\n"),
                testing::ElementsAre("a.yml:2:7: p.loud: needs file", "a.yml:5:27: p.layers[1].mean: is one too many"));
}

TEST(PropertiesTest, OneBlockIsAListOfOne) {
    Task task("t");
    EXPECT_THAT(findDiagnostics(task, "layers: {law: gaussian}"), testing::IsEmpty());
    ASSERT_EQ(task.config->layers.size(), 1u);
    EXPECT_EQ(task.config->layers[0].law, Law::Gaussian);
    EXPECT_THAT(findDiagnostics(task, "layers: {mean: 11}"),
                testing::ElementsAre("a.yml:1:16: p.layers.mean: is 11; may be 0 to 10"));
}

TEST(PropertiesTest, RefusesInvalidNumbers) {
    for (const char* number : {".inf", "-.inf", "nan", "inf", "1e999", "0x10", "1_000", "1,5", "", "1m"}) {
        Task task("t");
        EXPECT_EQ(findDiagnostics(task, std::string("range: ") + number).size(), 1u) << number;
        EXPECT_EQ(findDiagnostics(task, std::string("bins: ") + number).size(), 1u) << number;
        EXPECT_EQ(task.config->range, 50);
    }
}

TEST(PropertiesTest, RefusesNumbersBeyondTheirType) {
    framework::ConfigReader reader("a.yml");
    float narrow = 1;
    uint32_t word = 1;
    EXPECT_FALSE(reader.readValue(YAML::Load("1e39"), "narrow", Field{"narrow"}, narrow));
    EXPECT_FALSE(reader.readValue(YAML::Load("4294967296"), "word", Field{"word"}, word));
    EXPECT_FALSE(reader.readValue(YAML::Load("1e30"), "word", Field{"word"}, word));
    EXPECT_EQ(reader.diagnostics().size(), 3u);
    EXPECT_EQ(narrow, 1);
    EXPECT_EQ(word, 1u);
    EXPECT_TRUE(reader.readValue(YAML::Load("4294967295"), "word", Field{"word"}, word));
    EXPECT_EQ(word, 4294967295u);
}

TEST(PropertiesTest, ListsAllProperties) {
    const auto list = Task("t").config.list();
    const auto named = [&](const std::string& name) {
        return *std::find_if(list.begin(), list.end(), [&](const auto& info) { return info.name == name; });
    };
    EXPECT_EQ(named("range").type, "double");
    EXPECT_EQ(named("range").unit, "m");
    EXPECT_EQ(named("range").default_value, "50");
    EXPECT_EQ(named("range").min, 0.1);
    EXPECT_EQ(named("range").max, 500);
    EXPECT_EQ(named("range").doc, "far edge");
    EXPECT_EQ(named("speckle").type, "block, optional");
    EXPECT_EQ(named("speckle.law").type, "rayleigh|gaussian");
    EXPECT_EQ(named("speckle.law").default_value, "rayleigh");
    EXPECT_EQ(named("layers[].mean").default_value, "0.4");
    EXPECT_EQ(named("materials.<name>.mean").max, 10);
}

TEST(PropertiesTest, ValuesForTheLogAreTypedAndBlocksAreTextThatIsReadBack) {
    Task task("t");
    Config config;
    config.range = 0.1;
    config.seed = 7;
    config.loud = true;
    config.file = "a.glb";
    config.position = {1, -2.5, 3e-7};
    config.bearings = {0.5, -0.5};
    config.always = {Law::Gaussian, 0.25};
    config.materials = {{"sand: \"wet\"\n", {Law::Rayleigh, 2}}};
    task.config.set(config);
    const auto values = task.config.values();
    EXPECT_EQ(values.at("range"), types::PropertyValue(0.1));
    EXPECT_EQ(values.at("seed"), types::PropertyValue(int64_t{7}));
    EXPECT_EQ(values.at("loud"), types::PropertyValue(true));
    EXPECT_EQ(values.at("file"), types::PropertyValue("a.glb"));
    EXPECT_FALSE(values.contains("speckle"));
    EXPECT_EQ(values.at("always"), types::PropertyValue("{\"law\": \"gaussian\", \"mean\": 0.25}"));

    Config again;
    framework::ConfigReader reader("");
    for (const char* name : {"position", "bearings", "always", "materials"}) {
        const YAML::Node node = YAML::Load(std::string(name) + ": " + std::get<std::string>(values.at(name)));
        EXPECT_TRUE(reader.read(node, "", again)) << name;
    }
    EXPECT_EQ(again.position, config.position);
    EXPECT_EQ(again.bearings, config.bearings);
    EXPECT_EQ(again.always.law, Law::Gaussian);
    EXPECT_EQ(again.materials.at("sand: \"wet\"\n").mean, 2);
}

}  // namespace
}  // namespace insonify
