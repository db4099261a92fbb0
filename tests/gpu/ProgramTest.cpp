#include <gmock/gmock.h>

#include <filesystem>
#include <regex>

#include "components/gpu/Program.hpp"
#include "tests/gpu/ErrorOf.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::gpu {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

TEST(ProgramTest, AnUnknownShaderFileIsNamed) {
    EXPECT_THAT(errorOf([] { shaderFile("sonar.glsl"); }), HasSubstr("'sonar.glsl'"));
    EXPECT_THAT(errorOf([] { shaderSource("", {}); }), HasSubstr("''"));
}

TEST(ProgramTest, AFileIsThereToTheLastLine) {
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

TEST(ProgramTest, DefinesStandAfterTheVersionAndBeforeTheText) {
    const std::string source = shaderSource("surface.frag.glsl", {"HAVE_NORMAL_MAP", "ANSWER 42"});
    EXPECT_THAT(source, StartsWith("#version 450 core\n"));
    const size_t first = source.find("#define HAVE_NORMAL_MAP\n"), second = source.find("#define ANSWER 42\n");
    ASSERT_NE(first, std::string::npos);
    EXPECT_LT(first, second);
    EXPECT_LT(second, source.find("flat in uvec2 seen"));
}

/** Numbers of a file that GLSL rounds to single precision: literals that do not end in f or lf, and their quotients. */
std::vector<std::string> roundedNumbers(const std::string& text) {
    static const std::regex unread("//[^\n]*|#ifdef GLSL\n|#else\n(#define \\w+ [\\d.e-]+\n)+#endif"),
        numbers("(^|[^\\w.])((\\d+\\.\\d*(?:e-?\\d+)?|\\d+e-?\\d+)(?![\\w.])(?: / (\\d+\\.\\d*)(?![\\w.]))?)");
    const std::string code = std::regex_replace(text, unread, "");
    std::vector<std::string> all;
    for (std::sregex_iterator at(code.begin(), code.end(), numbers), end; at != end; ++at) {
        const double value = std::stod((*at)[3]) / ((*at)[4].matched ? std::stod((*at)[4]) : 1);
        if (double{static_cast<float>(value)} != value) all.push_back((*at)[2]);
    }
    return all;
}

TEST(ProgramTest, NoNumberIsRoundedToSinglePrecision) {
    for (const auto& entry : std::filesystem::directory_iterator(test::sourceFile("shaders"))) {
        const std::string name = entry.path().filename();
        EXPECT_THAT(roundedNumbers(std::string(shaderFile(name))), IsEmpty()) << name;
    }
    EXPECT_THAT(roundedNumbers("double x = 1e-300 + 0.5 * 0.1 + 1.5e-3 + (1.0 / 24.0);  // 0.3\n"),
                ElementsAre("1e-300", "0.1", "1.5e-3", "1.0 / 24.0"));
    EXPECT_THAT(roundedNumbers("float y = 0.1f; double z2 = 1e-3lf + 1.0 / 4.0 + double(1.0) / 24.0;\n"), IsEmpty());
}

TEST(ProgramTest, WhatTheShadersHaveCompilesInEveryCombination) {
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

TEST(ProgramTest, AMistakeInAShaderComesWithItsFileAndTheCompilersWords) {
    EglContext context("software");
    EXPECT_THAT(errorOf([] { Program::compute("deposit.comp.glsl", {"image_size no_such_thing +"}); }),
                AllOf(StartsWith("deposit.comp.glsl: "), HasSubstr("error")));
    EXPECT_THAT(
        errorOf([] { Program::raster("surface.vert.glsl", "surface.frag.glsl", {"gl_Position no_such_thing"}); }),
        AllOf(StartsWith("surface.vert.glsl: "), HasSubstr("no_such_thing")));
}

TEST(ProgramTest, WhatTheLinkerMissesIsTold) {
    EglContext context("software");
    EXPECT_THAT(errorOf([] { Program::raster("surface.vert.glsl", "surface.frag.glsl", {"main not_main"}); }),
                AllOf(StartsWith("linking: "), HasSubstr("main")));
}

}  // namespace
}  // namespace insonify::gpu
