#include "components/gpu/Program.hpp"

#include <algorithm>

namespace insonify::gpu {
namespace {

constexpr std::string_view include_word = "#include \"";

/** `text` with each included file in place of its line; files include at most once a level, never themselves. */
std::string withIncludes(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size() - 1);
        const std::string_view line = text.substr(0, end + 1);
        text.remove_prefix(end + 1);
        if (!line.starts_with(include_word)) {
            result += line;
            continue;
        }
        const std::string_view name = line.substr(include_word.size());
        result += withIncludes(shaderFile(name.substr(0, name.find('"'))));
    }
    return result;
}

template <class Get, class GetLog>
std::string buildLog(GLuint id, Get get, GetLog getLog) {
    GLint length = 0;
    get(id, GL_INFO_LOG_LENGTH, &length);
    std::string text(static_cast<size_t>(length), '\0');
    getLog(id, length, nullptr, text.data());
    return text;
}

GLuint compiled(GLenum stage, std::string_view file, const std::vector<std::string>& defines) {
    const std::string text = shaderSource(file, defines);
    const char* begin = text.c_str();
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &begin, nullptr);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) return shader;
    const std::string log = buildLog(shader, glGetShaderiv, glGetShaderInfoLog);
    glDeleteShader(shader);
    throw GlError(std::string(file) + ": " + log);
}

}  // namespace

std::string shaderSource(std::string_view name, const std::vector<std::string>& defines) {
    std::string text = "#version 450 core\n#define GLSL 1\n";
    for (const std::string& define : defines) text += "#define " + define + "\n";
    return text + withIncludes(shaderFile(name));
}

Program::Program(std::initializer_list<GLuint> shaders)
    : name_(glCreateProgram(), [](GLuint id) { glDeleteProgram(id); }) {
    for (GLuint shader : shaders) glAttachShader(id(), shader);
    glLinkProgram(id());
    for (GLuint shader : shaders) glDeleteShader(shader);
    GLint ok = 0;
    glGetProgramiv(id(), GL_LINK_STATUS, &ok);
    if (!ok) throw GlError("linking: " + buildLog(id(), glGetProgramiv, glGetProgramInfoLog));
}

Program Program::raster(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines) {
    return Program({compiled(GL_VERTEX_SHADER, vertex, defines), compiled(GL_FRAGMENT_SHADER, fragment, defines)});
}

Program Program::compute(std::string_view file, const std::vector<std::string>& defines) {
    return Program({compiled(GL_COMPUTE_SHADER, file, defines)});
}

const Program& Programs::raster(std::string_view vertex, std::string_view fragment,
                                const std::vector<std::string>& defines) {
    const std::string text = shaderSource(vertex, defines) + shaderSource(fragment, defines);
    const auto found = made_.find(text);
    return found != made_.end() ? found->second
                                : made_.emplace(text, Program::raster(vertex, fragment, defines)).first->second;
}

const Program& Programs::compute(std::string_view file, const std::vector<std::string>& defines) {
    const std::string text = shaderSource(file, defines);
    const auto found = made_.find(text);
    return found != made_.end() ? found->second : made_.emplace(text, Program::compute(file, defines)).first->second;
}

}  // namespace insonify::gpu
