#pragma once
#include "components/gpu/EglContext.hpp"

namespace insonify::test {

/** The limits that OpenGL 4.5 promises, with the extension that sonars use. */
inline gpu::Limits promisedLimits() {
    return {.draw_parameters = 1,
            .texture_size = 16384,
            .viewport_size = 16384,
            .integer_samples = 1,
            .depth_samples = 1,
            .storage_blocks = 8,
            .storage_bindings = 8,
            .storage_bytes = 1 << 27,
            .shared_bytes = 32768,
            .group_invocations = 1024,
            .group_size = 1024,
            .group_count = 65535};
}

}  // namespace insonify::test
