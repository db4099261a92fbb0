#pragma once
#include <compare>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "components/gpu/EglContext.hpp"
#include "components/gpu/Objects.hpp"

namespace insonify::gpu {

/** Returns the built-in text of a file of shaders/. Throws GlError for an unknown name. */
std::string_view shaderFile(std::string_view name);

/** Returns a file with its `#include "x.glsl"` lines replaced, and `#define` lines after `#version 450 core`. */
std::string shaderSource(std::string_view name, const std::vector<std::string>& defines);

/** One stage of a program. */
struct Shader {
    GLenum stage;
    std::string file, text;  ///< `text` is shaderSource() of the file.
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

/** The compiled programs of one context. Each text is compiled once; later requests return the same program. */
class Programs {
public:
    const Program& raster(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines);
    const Program& compute(std::string_view file, const std::vector<std::string>& defines);
    size_t count() const { return made_.size(); }
    /** Returns the stages of all programs. */
    std::vector<Shader> shaders() const;

private:
    const Program& made(const std::vector<Shader>& shaders);
    std::map<std::vector<Shader>, Program> made_;
};

}  // namespace insonify::gpu
