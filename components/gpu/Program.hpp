#pragma once
#include <compare>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "components/gpu/EglContext.hpp"
#include "components/gpu/Objects.hpp"

namespace insonify::gpu {

/** Text of a file of shaders/, as built in. Throws GlError for an unknown name. */
std::string_view shaderFile(std::string_view name);

/** The file with its `#include "x.glsl"` lines replaced and `#define` lines put after `#version 450 core`. */
std::string shaderSource(std::string_view name, const std::vector<std::string>& defines);

/** One stage of a program. */
struct Shader {
    GLenum stage;
    std::string file, text;  ///< `text` as shaderSource() makes it of the file.
    auto operator<=>(const Shader&) const = default;
};

/** A linked program. Compiler messages become the text of a GlError. */
class Program {
public:
    Program() = default;
    explicit Program(const std::vector<Shader>& shaders);
    static Program raster(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines);
    static Program compute(std::string_view file, const std::vector<std::string>& defines);
    void use() const { glUseProgram(name_.id()); }
    GLuint id() const { return name_.id(); }

private:
    Name name_;
};

/** Programs of one context that are compiled once and kept: whoever asks for the same text again gets the same one. */
class Programs {
public:
    const Program& raster(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines);
    const Program& compute(std::string_view file, const std::vector<std::string>& defines);
    size_t count() const { return made_.size(); }
    /** The stages of all programs. */
    std::vector<Shader> shaders() const;

private:
    const Program& made(const std::vector<Shader>& shaders);
    std::map<std::vector<Shader>, Program> made_;
};

}  // namespace insonify::gpu
