#pragma once
#include <cstdint>
#include <string>

namespace insonify::gpu {

/** Limits of an OpenGL context. The same fields state the needs of a task, where 0 means no need. */
struct Limits {
    int64_t draw_parameters = 0;    ///< 1 with the extension GL_ARB_shader_draw_parameters.
    int64_t texture_size = 0;       ///< Columns, and rows, of a texture [1].
    int64_t viewport_size = 0;      ///< Columns, and rows, of a viewport [1].
    int64_t integer_samples = 0;    ///< Samples per pixel of a multisampled texture of integers [1].
    int64_t depth_samples = 0;      ///< Samples per pixel of a multisampled texture of depths [1].
    int64_t storage_blocks = 0;     ///< Storage buffers of a compute shader [1].
    int64_t storage_bindings = 0;   ///< Binding points of storage buffers [1].
    int64_t storage_bytes = 0;      ///< Size of a storage buffer.
    int64_t shared_bytes = 0;       ///< Shared memory of a work group.
    int64_t group_invocations = 0;  ///< Invocations in a work group [1].
    int64_t group_size = 0;         ///< Invocations along each of the first two axes of a work group [1].
    int64_t group_count = 0;        ///< Work groups along each of the first two axes [1].

    /** Returns the limits of the context that is current on this thread. */
    static Limits ofCurrentContext();
    /** Returns the first limit that is below `needs`, in words, with both numbers; empty when there is none. */
    std::string shortfall(const Limits& needs) const;
};

}  // namespace insonify::gpu
