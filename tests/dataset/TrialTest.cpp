// insonify dataset: a trial with fewer scenes, and what it warns of.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/dataset/HarbourDeployment.hpp"
#include "tests/deployer/Command.hpp"

namespace insonify::dataset {
namespace {

using deployer::callInsonify;
using deployer::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct TrialTest : testing::Test {
    deployer::Outcome make(const std::string& text, const std::string& sweep) const {
        deployer::writeFile(folder_ / "d.yml", text);
        deployer::writeFile(folder_ / "sweep.yml", sweep);
        return callInsonify(folder_, {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", "out"});
    }
    std::string changed(const std::string& old, const std::string& by) const {
        std::string text = deployment;
        return text.replace(text.find(old), old.size(), by);
    }
    const deployer::TestFolder folder_;
    const std::string harbour_ = test::sourceFile("deploy/scenes/harbour.glb");
};

TEST_F(TrialTest, AClassThatNoSceneHasIsAWarning) {
    const deployer::Outcome outcome =
        make(deployment, "poses: {grid: {z: -5.5}}\nclasses: {pile: pile_*, mine: mine_*}\n");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr("warning: sweep.yml:2:25: classes.mine[0]: is mine_*, which is no name in the scene"),
                      Not(HasSubstr("pile_*"))));
    EXPECT_EQ(json::parse(deployer::readFile(folder_ / "out/manifest.json"))["classes"], json::array({"pile", "mine"}));
}

TEST_F(TrialTest, AFileThatTheSweepReplacesNeedNotExist) {
    const std::string absent = changed(harbour_, "absent.glb"), poses = "poses: {grid: {z: -5.5}}\n";
    EXPECT_THAT(make(absent, poses), deployer::isRefused(HasSubstr("absent.glb")));
    EXPECT_THAT(make(absent, poses + "scenes: [" + harbour_ + ", {set: {sonar.range: 20}}]\n"),
                deployer::isRefused(HasSubstr("absent.glb")));
    EXPECT_THAT(make(absent, poses + "scenes: [" + harbour_ + "]\n"), deployer::succeeds());
}

TEST_F(TrialTest, AWallNearAResonanceIsAWarningOnce) {
    const std::string vessels = changed(harbour_, test::sourceFile("deploy/scenes/vessels.glb"));
    std::string text = vessels;
    text.replace(text.find("      range: 30\n"), 16, "      range: 30\n      frequency_khz: 3000\n");
    const std::string shell = "scene.materials: [{glass bottle: {shell: {material: pvc, thickness_mm: 0.4}}}]\n";
    const deployer::Outcome outcome =
        make(text, "poses: {grid: {z: [-2, -2.1]}}\nsettings:\n  " + shell + "  sonar.beam_height_deg: [20, 21]\n");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::string warning = "the wall of glass bottle is near a half-wave resonance";
    const size_t first = outcome.err.find(warning);
    ASSERT_NE(first, std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find(warning, first + 1), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace insonify::dataset
