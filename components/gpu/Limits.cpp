#include "components/gpu/Limits.hpp"

#include <epoxy/gl.h>

#include <algorithm>

namespace insonify::gpu {
namespace {

struct Field {
    const char* name;
    int64_t Limits::*value;
};

constexpr Field extensions[] = {{"GL_ARB_shader_draw_parameters", &Limits::draw_parameters}};

constexpr Field sizes[] = {{"GL_MAX_TEXTURE_SIZE", &Limits::texture_size},
                           {"GL_MAX_VIEWPORT_DIMS", &Limits::viewport_size},
                           {"GL_MAX_INTEGER_SAMPLES", &Limits::integer_samples},
                           {"GL_MAX_DEPTH_TEXTURE_SAMPLES", &Limits::depth_samples},
                           {"GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS", &Limits::storage_blocks},
                           {"GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS", &Limits::storage_bindings},
                           {"GL_MAX_SHADER_STORAGE_BLOCK_SIZE", &Limits::storage_bytes},
                           {"GL_MAX_COMPUTE_SHARED_MEMORY_SIZE", &Limits::shared_bytes},
                           {"GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS", &Limits::group_invocations},
                           {"GL_MAX_COMPUTE_WORK_GROUP_SIZE", &Limits::group_size},
                           {"GL_MAX_COMPUTE_WORK_GROUP_COUNT", &Limits::group_count}};

int64_t sizeOf(GLenum name) {
    GLint64 value[2] = {};  // room for GL_MAX_VIEWPORT_DIMS
    glGetInteger64v(name, value);
    return name == GL_MAX_VIEWPORT_DIMS ? std::min(value[0], value[1]) : value[0];
}

int64_t sizeOfAxes(GLenum name) {
    GLint64 first = 0, second = 0;
    glGetInteger64i_v(name, 0, &first);
    glGetInteger64i_v(name, 1, &second);
    return std::min(first, second);
}

}  // namespace

Limits Limits::ofCurrentContext() {
    Limits limits;
    for (const Field& extension : extensions) limits.*extension.value = epoxy_has_gl_extension(extension.name);
    limits.texture_size = sizeOf(GL_MAX_TEXTURE_SIZE);
    limits.viewport_size = sizeOf(GL_MAX_VIEWPORT_DIMS);
    limits.integer_samples = sizeOf(GL_MAX_INTEGER_SAMPLES);
    limits.depth_samples = sizeOf(GL_MAX_DEPTH_TEXTURE_SAMPLES);
    limits.storage_blocks = sizeOf(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS);
    limits.storage_bindings = sizeOf(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
    limits.storage_bytes = sizeOf(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
    limits.shared_bytes = sizeOf(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE);
    limits.group_invocations = sizeOf(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
    limits.group_size = sizeOfAxes(GL_MAX_COMPUTE_WORK_GROUP_SIZE);
    limits.group_count = sizeOfAxes(GL_MAX_COMPUTE_WORK_GROUP_COUNT);
    return limits;
}

std::string Limits::shortfall(const Limits& needs) const {
    for (const auto& [name, value] : extensions)
        if (this->*value < needs.*value) return std::string(name) + " is missing";
    for (const auto& [name, value] : sizes)
        if (this->*value < needs.*value)
            return std::string(name) + " is " + std::to_string(this->*value) + ", and " + std::to_string(needs.*value) +
                   " is needed";
    return {};
}

}  // namespace insonify::gpu
