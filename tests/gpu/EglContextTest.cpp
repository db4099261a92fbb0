#include <epoxy/gl.h>
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "components/gpu/EglContext.hpp"
#include "components/gpu/Objects.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Variable.hpp"

namespace insonify::gpu {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/** Calls computeError() on a separate thread. */
std::string errorElsewhere(const auto& job) {
    std::string text;
    std::thread([&] { text = test::computeError<GlError>(job); }).join();
    return text;
}

struct DeviceVariable : test::Variable {
    explicit DeviceVariable(const char* value) : Variable("INSONIFY_EGL_DEVICE", value) {}
};

struct DebugVariable : test::Variable {
    explicit DebugVariable(const char* value) : Variable("INSONIFY_GL_DEBUG", value) {}
};

TEST(EglContextTest, TheSoftwareDeviceIsLlvmpipeWithOpenGl45) {
    EglContext context("software");
    EXPECT_TRUE(context.isSoftware());
    EXPECT_THAT(context.renderer(), HasSubstr("llvmpipe"));
    GLint major = 0, minor = 0, profile = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    EXPECT_GE(10 * major + minor, 45);
    EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
    EXPECT_NO_THROW(context.check());
}

TEST(EglContextTest, WithoutADeviceTheVariableChooses) {
    const DeviceVariable variable("software");
    EXPECT_TRUE(EglContext().isSoftware());
}

TEST(EglContextTest, AnUnknownDeviceIsReportedWithTheAllowedNames) {
    for (const char* device : {"quantum", "4000000000", "99999999999999999999", "-1", "0x", "1.5", " software", "Auto"})
        EXPECT_THAT(test::computeError<GlError>([&] { EglContext context(device); }),
                    AllOf(HasSubstr("'" + std::string(device) + "'"), HasSubstr("auto, software or a number below ")));
}

TEST(EglContextTest, AnUnknownDeviceInTheVariableIsReportedToo) {
    for (const char* device : {"quantum", "4000000000"}) {
        const DeviceVariable variable(device);
        EXPECT_THAT(test::computeError<GlError>([] { EglContext context; }),
                    AllOf(HasSubstr("'" + std::string(device) + "'"), HasSubstr("auto, software or a number below ")));
    }
}

TEST(EglContextTest, AGivenDeviceHasPrecedenceOverTheVariable) {
    const DeviceVariable variable("quantum");
    EXPECT_TRUE(EglContext("software").isSoftware());
}

TEST(EglContextTest, AnEmptyVariableIsIgnored) {
    const DeviceVariable variable("");
    EXPECT_THAT(EglContext().renderer(), Not(IsEmpty()));
}

TEST(EglContextTest, RejectsUseOnAnotherThread) {
    EglContext context("software");
    EXPECT_THAT(errorElsewhere([&] { context.requireThread(); }), HasSubstr("made on another thread"));
    EXPECT_THAT(errorElsewhere([&] { context.check(); }), HasSubstr("made on another thread"));
    EXPECT_EQ(test::computeError<GlError>([&] { context.check(); }), "") << "its own thread may go on";
}

TEST(EglContextTest, RejectsAContextThatIsNoLongerCurrent) {
    EglContext first("software");
    {
        EglContext second("software");
        EXPECT_THAT(test::computeError<GlError>([&] { first.requireThread(); }), HasSubstr("one at a time"));
        EXPECT_EQ(test::computeError<GlError>([&] { second.check(); }), "");
    }
    EXPECT_THAT(test::computeError<GlError>([&] { first.check(); }), HasSubstr("one at a time"));
}

TEST(EglContextTest, TheNextCheckThrowsAnErrorOnceWithGlsTextIfTheVariableIsSet) {
    const DebugVariable debug("1");
    EglContext context("software");
    glEnable(GL_TEXTURE_2D);  // not in the core profile
    EXPECT_THAT(test::computeError<GlError>([&] { context.check(); }),
                AllOf(HasSubstr("OpenGL: "), HasSubstr("glEnable")));
    EXPECT_EQ(test::computeError<GlError>([&] { context.check(); }), "");
}

TEST(EglContextTest, WithoutTheVariableAnErrorIsThrownWithItsNumberAndARemedy) {
    const DebugVariable debug("0");
    EglContext context("software");
    glEnable(GL_TEXTURE_2D);
    EXPECT_THAT(test::computeError<GlError>([&] { context.check(); }),
                AllOf(HasSubstr("OpenGL: error 1280"), HasSubstr("INSONIFY_GL_DEBUG=1")));
    EXPECT_EQ(test::computeError<GlError>([&] { context.check(); }), "");
}

TEST(EglContextTest, NamesTheDriver) { EXPECT_THAT(EglContext("software").driver(), HasSubstr("Mesa")); }

TEST(EglContextTest, ReportsSoftwareRasterisingWithoutARequest) {
    EXPECT_EQ(EglContext("software").fallback(), "");
    const DeviceVariable variable("auto");
    const EglContext context;
    const std::string expected = context.isSoftware() ? "rasterised in software by " + context.renderer() : "";
    EXPECT_THAT(context.fallback(), HasSubstr(expected));
    EXPECT_EQ(context.fallback().empty(), expected.empty());
}

TEST(EglContextTest, ReportsTheFirstOfTwoErrors) {
    const DebugVariable debug("1");
    EglContext context("software");
    glEnable(GL_TEXTURE_2D);
    glBindFramebuffer(GL_FRAMEBUFFER, 4711);
    EXPECT_THAT(test::computeError<GlError>([&] { context.check(); }), HasSubstr("glEnable"));
}

TEST(EglContextTest, RecognisesSoftwareRenderersByTheirNames) {
    for (const char* renderer : {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "Software Rasterizer",
                                 "Google SwiftShader", "zink (llvmpipe (LLVM 15.0.6, 256 bits))",
                                 "zink Vulkan 1.3(llvmpipe (LLVM 19.1.7, 256 bits) (MESA_LLVMPIPE))",
                                 "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero)), SwiftShader driver)",
                                 "D3D12 (Microsoft Basic Render Driver)"})
        EXPECT_TRUE(isSoftwareRenderer(renderer)) << renderer;
    for (const char* renderer : {"NVIDIA H100 80GB HBM3/PCIe", "NVIDIA GeForce RTX 4090/PCIe/SSE2",
                                 "AMD Radeon RX 6800 (radeonsi, navi21, LLVM 15.0.6, DRM 3.49, 6.1.0)",
                                 "Mesa Intel(R) UHD Graphics 620 (KBL GT2)", "zink (NVIDIA GeForce RTX 3080)"})
        EXPECT_FALSE(isSoftwareRenderer(renderer)) << renderer;
}

TEST(EglContextTest, PrefersACardToADisplayChipOnTheProcessor) {
    const std::string chip = "llvmpipe (LLVM 15.0.6, 256 bits)", card = "NVIDIA L40S/PCIe/SSE2",
                      other = "Mesa Intel(R) UHD Graphics 620 (KBL GT2)", none;
    const auto preferred = [](const std::vector<std::string>& renderers) { return preferredRenderer(renderers); };
    EXPECT_EQ(preferred({chip, card}), 1u);
    EXPECT_EQ(preferred({card, chip}), 0u);
    EXPECT_EQ(preferred({none, chip, "softpipe", other, card}), 3u) << "the first card of EGL's list";
    EXPECT_EQ(preferred({none, chip, "softpipe"}), 1u) << "no card";
    EXPECT_EQ(preferred({none, none}), std::nullopt);
    EXPECT_EQ(preferred({}), std::nullopt);
}

TEST(EglContextTest, TheSearchForACardLeavesTheContextCurrent) {
    EglContext context("software");
    EglContext::hasCard();
    EXPECT_EQ(test::computeError<GlError>([&] { context.check(); }), "");
}

TEST(EglContextTest, ASecondContextOnAnotherThreadSharesTheBuffersOfTheFirst) {
    const std::vector<uint32_t> written = {1, 2, 3, 4, 5};
    EglContext context("software");
    Buffer buffer = Buffer::of(std::span(written));
    glFinish();
    std::vector<uint32_t> seen(written.size());
    std::string renderer;
    const std::string error = errorElsewhere([&] {
        EglContext other(EglContext::Sharing{context});
        renderer = other.renderer();
        buffer.read(seen.data(), seen.size() * sizeof(uint32_t));
        const uint32_t last = 50;
        buffer.write(&last, sizeof last, 4 * sizeof(uint32_t));
        glFinish();
        other.check();
    });
    EXPECT_EQ(error, "");
    EXPECT_EQ(renderer, context.renderer());
    EXPECT_EQ(seen, written);
    buffer.read(seen.data(), seen.size() * sizeof(uint32_t));
    EXPECT_EQ(seen.back(), 50u) << "and the first sees what the second wrote";
    EXPECT_NO_THROW(context.check());
}

TEST(EglContextTest, UnrelatedContextsShareNothing) {
    EglContext context("software");
    const Buffer buffer(64);
    bool known = true;
    std::thread([&] {
        EglContext other("software");
        known = glIsBuffer(buffer.id());
    }).join();
    EXPECT_TRUE(glIsBuffer(buffer.id()));
    EXPECT_FALSE(known);
}

TEST(EglContextTest, TheSoftwareRendererRasterisesConcurrentlyAndTransfersExclusively) {
    const EglContext context("software");
    auto drawing = context.drawing();
    std::atomic<bool> rasterised = false, transferred = false;
    std::thread other([&] {
        const auto another = context.drawing();
        rasterised = true;
    });
    other.join();
    EXPECT_TRUE(rasterised);
    std::thread alone([&] {
        const auto transfer = context.transferring();
        transferred = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(transferred);
    drawing.unlock();
    alone.join();
    EXPECT_TRUE(transferred);
}

}  // namespace
}  // namespace insonify::gpu
