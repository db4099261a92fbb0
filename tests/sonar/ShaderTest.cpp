// Each shader, in each set of features that a rasterising sonar can request, is valid OpenGL 4.5. glslangValidator
// checks the texts that a context compiles; it shares no code with the driver of the other tests.
#include <gmock/gmock.h>

#include <cstdlib>
#include <regex>
#include <set>

#include "components/gpu/EglContext.hpp"
#include "components/gpu/Program.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/raster/PictureDeposit.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"

namespace insonify::sonar {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;

/** Sonars that can be rasterised, with each choice that is a feature. */
std::vector<SonarConfig> rasterSonars() {
    std::vector<SonarConfig> all;
    for (int choices = 0; choices < 32; ++choices)
        for (int volume = 0; volume < 3; ++volume) {
            SonarConfig config = test::getSonar({.beams = 2, .width_deg = 20, .bins = 4, .rows = 8, .columns = 4});
            config.visibility = Visibility::Gl;
            config.device = "software";
            if (choices & 1) config.model = Model::Cerqueira2017;
            if (choices & 2) config.beam_geometry = BeamGeometry::Conical;
            if (choices & 4) config.published = true;
            if (choices & 8) config.absorption.emplace().db_per_m = 0.1;
            if (choices & 16) config.beam_pattern.emplace().receive.elevation.emplace().width_deg = 10;
            if (volume > 0) config.volume = {volume == 1 ? VolumeLayer{{}, {}, -70} : VolumeLayer{1, 5, -70}};
            types::Diagnostics diagnostics;
            config.check(diagnostics);
            if (diagnostics.empty()) all.push_back(config);
        }
    return all;
}

/** Scenes with and without a normal map, with and without a material that follows its own law. */
std::vector<types::GeometryPtr> scenes() {
    std::vector<types::GeometryPtr> all;
    for (bool has_map : {false, true})
        for (bool has_law : {false, true}) {
            const auto geometry = std::make_shared<types::Geometry>();
            geometry->materials.resize(1);
            geometry->normal_maps = {test::flatMap()};
            if (has_map) geometry->materials[0].normal_map = 0;
            if (has_law) geometry->materials[0].measured = {{0, -40}, {90, -10}};
            geometry->meshes = {test::mappedWall()};
            geometry->objects = {{"wall", 0, glm::dmat4(1)}};
            all.push_back(geometry);
        }
    return all;
}

/** Calls use(plan, geometry) for each set of features of a rasterising sonar. */
void forEachFeatureSet(const auto& use) {
    std::set<std::vector<std::string>> seen;
    const std::vector<types::GeometryPtr> geometries = scenes();
    for (const SonarConfig& config : rasterSonars())
        for (const types::GeometryPtr& geometry : geometries)
            for (Estimator estimator : {Estimator::Footprint, Estimator::Nearest, Estimator::NearestJitter}) {
                if (estimator != Estimator::Footprint && config.model != Model::Physical) continue;
                const RenderPlan plan =
                    makeRenderPlan(config, *geometry, {.estimator = estimator, .samples_per_pixel = 4});
                if (seen.insert(plan.defines()).second) use(plan, *geometry);
            }
}

/** Returns the shaders of all programs that rasterise, cull and sum for any set of features. */
std::vector<gpu::Shader> allShaders() {
    gpu::EglContext context("software");
    ThreadPool threads(1);
    forEachFeatureSet([&](const RenderPlan& plan, const types::Geometry& geometry) {
        Culler culler(geometry, {1e-3, reach(plan)});
        const SurfacePass surface(context,
                                  {.geometry = geometry,
                                   .laws = plan.laws,
                                   .frusta = plan.frusta,
                                   .defines = plan.defines(),
                                   .near_plane = 1e-3,
                                   .empty_too = true,
                                   .cull_on_device = true},
                                  culler, threads);
        DepositSetup setup;
        const PingEffects effects(plan, geometry);
        setup.rules = makeEchoRules(plan, effects);
        setup.defines = plan.defines();
        makeGpuDeposit(setup, context);
    });
    context.check();
    return context.programs().shaders();
}

/** Returns the words HAVE_... in a text that match `pattern`. */
std::set<std::string> featuresIn(std::string_view text, const std::string& pattern) {
    std::set<std::string> all;
    const std::regex words(pattern);
    for (std::cregex_iterator at(text.begin(), text.end(), words), end; at != end; ++at) all.insert((*at)[1]);
    return all;
}

struct ShaderTest : testing::Test {
    void SetUp() override {
        if (std::system("glslangValidator --version > /dev/null 2>&1") != 0)
            GTEST_SKIP() << "SKIPPED: no glslangValidator (Debian: glslang-tools; scripts/setup installs it)";
    }
    /** Returns the errors of glslangValidator for files of the folder; empty when it accepts all. */
    std::string getMessages(const std::string& arguments) const {
        const std::string call =
            "cd " + folder_.path().string() + " && glslangValidator " + arguments + " > answer.txt 2>&1";
        const int status = std::system(call.c_str());
        const std::vector<char> text = toBytes(folder_ / "answer.txt");
        return status == 0 ? "" : std::string(text.begin(), text.end());
    }
    /** Writes a shader into the folder, in a file whose ending is its stage; returns the file's name. */
    std::string write(const gpu::Shader& shader) {
        const char* ending = shader.stage == GL_VERTEX_SHADER     ? "vert"
                             : shader.stage == GL_FRAGMENT_SHADER ? "frag"
                                                                  : "comp";
        const std::string name = std::to_string(written_++) + "_" + shader.file + "." + ending;
        std::ofstream(folder_ / name) << shader.text;
        return name;
    }

private:
    const Folder folder_;
    int written_ = 0;
};

}  // namespace

TEST_F(ShaderTest, EachSetOfFeaturesIsValidGlsl) {
    std::string files;
    std::set<std::string> compiled, known;
    size_t deposits = 0;
    for (const gpu::Shader& shader : allShaders()) {
        files += write(shader) + " ";
        deposits += shader.file == "deposit.comp.glsl";
        compiled.merge(featuresIn(shader.text, "#define (HAVE_\\w+)"));
        known.merge(featuresIn(shader.text, "(?:ifdef |ifndef |defined\\()(HAVE_\\w+)"));
    }
    EXPECT_EQ(getMessages(files), "");
    size_t feature_sets = 0;
    forEachFeatureSet([&](const RenderPlan&, const types::Geometry&) { ++feature_sets; });
    EXPECT_EQ(deposits, feature_sets) << "a program for each";
    EXPECT_THAT(compiled, IsSupersetOf(known)) << "each feature of a shader has been used";
}

TEST_F(ShaderTest, StagesFitTogether) {
    using Defines = std::vector<std::string>;
    const auto program = [&](const std::string& name, const Defines& defines) {
        const auto stage = [&](GLenum kind, const std::string& file) {
            return write({kind, file, gpu::shaderSource(file, defines)});
        };
        return "-l " + stage(GL_VERTEX_SHADER, name + ".vert.glsl") + " " +
               stage(GL_FRAGMENT_SHADER, name + ".frag.glsl");
    };
    EXPECT_EQ(getMessages(program("surface", {})), "");
    EXPECT_EQ(getMessages(program("surface", {"HAVE_NORMAL_MAP"})), "");
    EXPECT_EQ(getMessages(program("resolve", {})), "");
}

TEST_F(ShaderTest, ReportsAnErrorWithItsFileAndPlace) {
    const std::string right = gpu::shaderSource("deposit.comp.glsl", {"HAVE_PHYSICAL"});
    const std::string wrong = right + "float wrong() { return no_such_thing; }\n";
    EXPECT_THAT(getMessages(write({GL_COMPUTE_SHADER, "deposit.comp.glsl", wrong})),
                AllOf(HasSubstr("deposit.comp.glsl.comp"), HasSubstr("'no_such_thing' : undeclared identifier")));
    EXPECT_THAT(getMessages(write({GL_COMPUTE_SHADER, "deposit.comp.glsl", right})), IsEmpty());
}

TEST(ShaderTextTest, ComputeShadersHaveAtMostEightStorageBuffers) {
    const std::regex buffers("std430, binding = \\w+\\)");
    for (const char* file : {"deposit.comp.glsl", "cull.comp.glsl"}) {
        const std::string text = gpu::shaderSource(file, {});
        EXPECT_LE(std::distance(std::sregex_iterator(text.begin(), text.end(), buffers), {}), 8) << file;
    }
}

}  // namespace insonify::sonar
