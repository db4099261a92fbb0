#include "components/gpu/Program.hpp"

#include <algorithm>

namespace insonify::gpu {
namespace {

constexpr std::string_view include_word = "#include \"";

/** Returns `text` with each `#include` line replaced by the file, recursively. No file may include itself. */
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

std::string buildLog(GLuint id, auto get, auto getLog) {
    GLint length = 0;
    get(id, GL_INFO_LOG_LENGTH, &length);
    std::string text(static_cast<size_t>(length), '\0');
    getLog(id, length, nullptr, text.data());
    return text;
}

GLuint compiled(const Shader& shader) {
    const char* begin = shader.text.c_str();
    const GLuint id = glCreateShader(shader.stage);
    glShaderSource(id, 1, &begin, nullptr);
    glCompileShader(id);
    GLint ok = 0;
    glGetShaderiv(id, GL_COMPILE_STATUS, &ok);
    if (ok) return id;
    const std::string log = buildLog(id, glGetShaderiv, glGetShaderInfoLog);
    glDeleteShader(id);
    throw GlError(shader.file + ": " + log);
}

Shader makeShader(GLenum stage, std::string_view file, const std::vector<std::string>& defines) {
    return {stage, std::string(file), shaderSource(file, defines)};
}

std::vector<Shader> rasterShaders(std::string_view vertex, std::string_view fragment,
                                  const std::vector<std::string>& defines) {
    return {makeShader(GL_VERTEX_SHADER, vertex, defines), makeShader(GL_FRAGMENT_SHADER, fragment, defines)};
}

std::vector<Shader> computeShaders(std::string_view file, const std::vector<std::string>& defines) {
    return {makeShader(GL_COMPUTE_SHADER, file, defines)};
}

}  // namespace

std::string shaderSource(std::string_view name, const std::vector<std::string>& defines) {
    std::string text = "#version 450 core\n#define GLSL 1\n";
    for (const std::string& define : defines) text += "#define " + define + "\n";
    return text + withIncludes(shaderFile(name));
}

Program::Program(const std::vector<Shader>& shaders)
    : name_(glCreateProgram(), [](GLuint id) { glDeleteProgram(id); }) {
    std::vector<GLuint> ids;
    for (const Shader& shader : shaders) glAttachShader(id(), ids.emplace_back(compiled(shader)));
    glLinkProgram(id());
    for (GLuint shader : ids) glDeleteShader(shader);
    GLint ok = 0;
    glGetProgramiv(id(), GL_LINK_STATUS, &ok);
    if (!ok) throw GlError("linking: " + buildLog(id(), glGetProgramiv, glGetProgramInfoLog));
}

Program Program::raster(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines) {
    return Program(rasterShaders(vertex, fragment, defines));
}

Program Program::compute(std::string_view file, const std::vector<std::string>& defines) {
    return Program(computeShaders(file, defines));
}

const Program& Programs::raster(std::string_view vertex, std::string_view fragment,
                                const std::vector<std::string>& defines) {
    return made(rasterShaders(vertex, fragment, defines));
}

const Program& Programs::compute(std::string_view file, const std::vector<std::string>& defines) {
    return made(computeShaders(file, defines));
}

const Program& Programs::made(const std::vector<Shader>& shaders) {
    const auto found = made_.find(shaders);
    return found != made_.end() ? found->second : made_.emplace(shaders, Program(shaders)).first->second;
}

std::vector<Shader> Programs::shaders() const {
    std::vector<Shader> all;
    for (const auto& [shaders, program] : made_) all.insert(all.end(), shaders.begin(), shaders.end());
    return all;
}

}  // namespace insonify::gpu
