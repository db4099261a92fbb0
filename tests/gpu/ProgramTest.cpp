#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "components/gpu/Program.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::gpu {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

TEST(ProgramTest, ReportsAnUnknownShaderFile) {
    EXPECT_THAT(test::computeError<GlError>([] { shaderFile("sonar.glsl"); }), HasSubstr("'sonar.glsl'"));
    EXPECT_THAT(test::computeError<GlError>([] { shaderSource("", {}); }), HasSubstr("''"));
}

TEST(ProgramTest, AFileIsCompleteToTheLastLine) {
    const std::string_view text = shaderFile("surface.vert.glsl");
    EXPECT_THAT(std::string(text), HasSubstr("void main()"));
    EXPECT_EQ(text.substr(text.size() - 2), "}\n");
}

TEST(ProgramTest, IncludesAreReplacedByTheirFiles) {
    ASSERT_THAT(std::string(shaderFile("deposit.comp.glsl")), HasSubstr("#include \"interface.glsl\""));
    const std::string source = shaderSource("deposit.comp.glsl", {});
    EXPECT_THAT(source, Not(HasSubstr("#include")));
    for (const char* file :
         {"interface.glsl", "footprint.glsl", "plane.glsl", "picture.glsl", "trapezoid.glsl", "deposit.glsl"})
        EXPECT_THAT(source, HasSubstr(std::string(shaderFile(file)))) << file;
}

TEST(ProgramTest, DefinesFollowTheVersionAndPrecedeTheText) {
    const std::string source = shaderSource("surface.frag.glsl", {"HAVE_NORMAL_MAP", "ANSWER 42"});
    EXPECT_THAT(source, StartsWith("#version 450 core\n"));
    const size_t first = source.find("#define HAVE_NORMAL_MAP\n"), second = source.find("#define ANSWER 42\n");
    ASSERT_NE(first, std::string::npos);
    EXPECT_LT(first, second);
    EXPECT_LT(second, source.find("flat in uvec2 seen"));
}

/** Types and literals in double precision in a shader's whole text. */
std::vector<std::string> doubles(std::string text) {
    static const std::regex comments("//[^\n]*"), kinds("\\b(double|d(vec|mat)[2-4]|[\\d.]+(e-?\\d+)?lf)\\b");
    static const std::string meaning = "#define double float";
    text = std::regex_replace(text, comments, "");
    const size_t from = text.find(meaning);
    if (from != std::string::npos) text.erase(from, meaning.size());
    std::vector<std::string> all;
    for (std::sregex_iterator at(text.begin(), text.end(), kinds), end; at != end; ++at)
        if ((*at)[1] != "double" || static_cast<size_t>(at->position()) < from) all.push_back((*at)[1]);
    return all;
}

TEST(ProgramTest, NoShaderNeedsDoubles) {
    for (const auto& entry : std::filesystem::directory_iterator(test::sourceFile("shaders"))) {
        const std::string name = entry.path().filename();
        if (std::ranges::count(name, '.') == 2) {
            EXPECT_THAT(doubles(shaderSource(name, {})), IsEmpty()) << name;
        }
    }
    EXPECT_THAT(doubles("double x;\n#define double float\ndouble y; dvec3 z = 1e-3lf;  // double\n"),
                ElementsAre("double", "dvec3", "1e-3lf"));
}

TEST(ProgramTest, EveryCombinationOfFeaturesCompiles) {
    EglContext context("software");
    using Defines = std::vector<std::string>;
    for (const Defines& defines : {Defines{}, Defines{"HAVE_NORMAL_MAP"}})
        EXPECT_GT(Program::raster("surface.vert.glsl", "surface.frag.glsl", defines).id(), 0u);
    for (const Defines& defines :
         {Defines{"HAVE_PHYSICAL"}, Defines{"HAVE_PHYSICAL", "HAVE_CONICAL", "HAVE_NORMAL_MAP"},
          Defines{"HAVE_PHYSICAL", "HAVE_NEAREST", "HAVE_JITTER"}, Defines{"HAVE_CERQUEIRA2017"},
          Defines{"HAVE_CERQUEIRA2017", "HAVE_ABSORPTION"},
          Defines{"HAVE_CERQUEIRA2017", "HAVE_ABSORPTION", "HAVE_PUBLISHED"}}) {
        const Program program = Program::compute("deposit.comp.glsl", defines);
        program.use();
        GLint used = 0;
        glGetIntegerv(GL_CURRENT_PROGRAM, &used);
        EXPECT_EQ(static_cast<GLuint>(used), program.id());
    }
    EXPECT_NO_THROW(context.check());
}

TEST(ProgramTest, AContextCompilesEachTextOnce) {
    EglContext context("software");
    Programs& programs = context.programs();
    const Program& first = programs.compute("deposit.comp.glsl", {});
    EXPECT_EQ(&programs.compute("deposit.comp.glsl", {}), &first);
    EXPECT_NE(&programs.compute("deposit.comp.glsl", {"HAVE_CERQUEIRA2017"}), &first);
    EXPECT_EQ(&programs.raster("surface.vert.glsl", "surface.frag.glsl", {}),
              &programs.raster("surface.vert.glsl", "surface.frag.glsl", {}));
    EXPECT_EQ(programs.count(), 3u);
    EXPECT_NO_THROW(context.check());
}

TEST(ProgramTest, ReportsAnErrorInAShaderWithItsFileAndTheCompilersText) {
    EglContext context("software");
    EXPECT_THAT(
        test::computeError<GlError>([] { Program::compute("deposit.comp.glsl", {"image_size no_such_thing +"}); }),
        AllOf(StartsWith("deposit.comp.glsl: "), HasSubstr("error")));
    EXPECT_THAT(test::computeError<GlError>(
                    [] { Program::raster("surface.vert.glsl", "surface.frag.glsl", {"gl_Position no_such_thing"}); }),
                AllOf(StartsWith("surface.vert.glsl: "), HasSubstr("no_such_thing")));
}

TEST(ProgramTest, ReportsErrorsOfTheLinker) {
    EglContext context("software");
    EXPECT_THAT(test::computeError<GlError>(
                    [] { Program::raster("surface.vert.glsl", "surface.frag.glsl", {"main not_main"}); }),
                AllOf(StartsWith("linking: "), HasSubstr("main")));
}

}  // namespace
}  // namespace insonify::gpu
