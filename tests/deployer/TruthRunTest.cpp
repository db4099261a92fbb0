// deploy/truth.yml: the picture, the log, and the arrays made from it.
#include <gmock/gmock.h>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

using namespace insonify::deployer;

namespace {

/** Two pings of a smaller sonar, in out/. */
struct TruthRunTest : testing::Test {
    void SetUp() override {
        ASSERT_THAT(callInsonify(folder_, {"run", fs::path(insonify::test::source_dir) / "deploy/truth.yml", "--pings",
                                           "2", "--out", "out", "--set", "sonar.beam_count=64", "--set",
                                           "sonar.bin_count=200", "--set", "picture.width=800"}),
                    succeeds());
    }
    void exportTo(const std::string& file, const std::string& log, const std::string& stream) {
        std::vector<std::string> words = {"log", "export", log, "--to", file};
        if (!stream.empty()) words.insert(words.end(), {"--stream", stream});
        ASSERT_THAT(callInsonify(folder_, words), succeeds());
    }
    /** Returns the output of python with numpy and json, with the arrays of a file as `x`. */
    std::string arraysSay(const std::string& file, const std::string& program) {
        std::ofstream(folder_ / "program.py") << "import json, numpy as np\nx = np.load('" << (folder_ / file).string()
                                              << "')\nmeta = json.loads(x['meta'].item())\n"
                                              << program;
        return insonify::pythonSays((folder_ / "program.py").string(), folder_ / "answer.txt");
    }

    TestFolder folder_;
};

}  // namespace

TEST_F(TruthRunTest, WritesAPictureAndALog) {
    EXPECT_TRUE(fs::exists(folder_ / "out/truth_000001.png"));
    const json info =
        json::parse(callInsonify(folder_, {"log", "info", "out/truth.0.log", "--metadata", "--json"}).out);
    const json& truth = info["metadata"]["sonar.truth"];
    const json names = json::parse(truth["metadata"]["insonify_objects"].get<std::string>());
    EXPECT_GE(names.size(), 10u);
    EXPECT_EQ(truth["meaning"]["objects"], names);
    EXPECT_THAT(truth["meaning"]["grazing"].get<std::string>(), testing::HasSubstr("[rad]"));
    EXPECT_EQ(callInsonify(folder_, {"log", "check", "out/truth.0.log"}).code, 0);
}

TEST_F(TruthRunTest, ArraysHaveTheTruthByTheNamesOfThePort) {
    if (!insonify::pythonHas("numpy")) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    exportTo("truth.npz", "out/truth.0.log", "sonar.truth");
    EXPECT_EQ(arraysSay("truth.npz", R"(
heard = x['object'] >= 0
print(x['object'].shape, heard.any(), (x['share'][heard] > 0).all(), np.isnan(x['elevation'][~heard]).all())
print((x['hits'][heard] > 0).all(), (x['hits'][~heard] == 0).all(), np.unique(x['path']).tolist())
print((x['shadow'] & heard).any(), x['shadow'].any(), x['object'].max() < len(meta['objects']))
print([str(n) for n in x['objects']] == meta['objects']))"),
              "(2, 64, 200) True True True\nTrue True [0]\nFalse True True\nTrue\n");
    exportTo("returns.npz", "out/truth.0.log", "sonar.returns");
    EXPECT_EQ(arraysSay("returns.npz", R"(
both = ~np.isnan(x['first_range'])
print(x['strongest_range'].shape, both.any(), (x['first_range'][both] <= x['strongest_range'][both]).all()))"),
              "(2, 64) True True\n");
}

TEST_F(TruthRunTest, McapHasTheSame) {
    exportTo("told.mcap", "out/truth.0.log", "");
    exportTo("a.npz", "out/truth.0.log", "sonar.truth");
    exportTo("b.npz", "told.mcap", "sonar.truth");
    EXPECT_THAT(callInsonify(folder_, {"log", "check", "told.mcap"}), succeeds());
    if (!insonify::pythonHas("numpy")) GTEST_SKIP() << "python3-numpy is not installed: the npz files are not read";
    EXPECT_EQ(arraysSay("a.npz", "y = np.load('" + (folder_ / "b.npz").string() + R"(')
print(all(x[k].tobytes() == y[k].tobytes() for k in x.files if k != 'meta'), len(x.files)))"),
              "True 12\n");
}
