#pragma once
#include <cstdint>
#include <string>

namespace insonify::gpu {

/** Limits of an OpenGL context. The same fields state what a task needs: 0 is nothing. */
struct Limits {
    int64_t draw_parameters = 0;    ///< 1 with the extension GL_ARB_shader_draw_parameters.
    int64_t texture_size = 0;       ///< Columns, and rows, of a texture [1].
    int64_t viewport_size = 0;      ///< Columns, and rows, that are drawn at once [1].
    int64_t integer_samples = 0;    ///< For each pixel of a multisampled texture: of integers [1],
    int64_t depth_samples = 0;      ///< and of depths [1].
    int64_t storage_blocks = 0;     ///< Storage buffers of a compute shader [1].
    int64_t storage_bindings = 0;   ///< Places at which storage buffers are bound [1].
    int64_t storage_bytes = 0;      ///< In one storage buffer.
    int64_t shared_bytes = 0;       ///< Memory of a work group.
    int64_t group_invocations = 0;  ///< In a work group [1],
    int64_t group_size = 0;         ///< and along its first two axes [1].
    int64_t group_count = 0;        ///< Work groups along each of the first two axes [1].

    /** Limits of the context that is current on this thread. */
    static Limits ofCurrentContext();
    /** The first limit that is below `needs`, in words, with both numbers. Empty: none is. */
    std::string shortfall(const Limits& needs) const;
};

}  // namespace insonify::gpu
