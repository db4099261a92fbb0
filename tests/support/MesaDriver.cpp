// Linked into tests that use OpenGL. If GALLIUM_DRIVER names a driver of Mesa, the tests are skipped unless that driver
// renders.
#include <gtest/gtest.h>

#include <cstdlib>

#include "components/gpu/EglContext.hpp"

namespace insonify {
namespace {

/** Returns GL_RENDERER of a software context. */
std::string rendererHere() {
    try {
        return gpu::EglContext("software").renderer();
    } catch (const gpu::GlError&) {
        return "no OpenGL 4.5";
    }
}

struct MesaDriver : testing::Environment {
    void SetUp() override {
        const char* driver = std::getenv("GALLIUM_DRIVER");
        if (!driver || !*driver) return;
        if (const std::string found = rendererHere(); !found.starts_with(driver))
            GTEST_SKIP() << "NOT TESTED: Mesa's " << driver << " does not render here (" << found
                         << "); Debian: mesa-vulkan-drivers, scripts/setup installs it";
    }
};

const auto* const registered = testing::AddGlobalTestEnvironment(new MesaDriver);

}  // namespace
}  // namespace insonify
