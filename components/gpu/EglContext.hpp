#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include "components/gpu/Limits.hpp"

namespace insonify::gpu {

/** OpenGL or EGL said no; the message says what to install or set where that helps. */
struct GlError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Programs;

/** Whether a GL_RENDERER draws on the processor, through Vulkan too: "zink (llvmpipe ...)". */
bool isSoftwareRenderer(std::string_view renderer);

/** Position of the renderer that "auto" takes: the first graphics card, otherwise the first that draws on the
 *  processor. `renderers` are the GL_RENDERER of all devices, empty for a device without OpenGL 4.5. */
std::optional<size_t> preferredRenderer(std::span<const std::string> renderers);

/** A headless OpenGL 4.5 core context, current on the thread that made it and usable only there.
 *
 *  Needs no X server: devices by EGL_EXT_platform_device, else Mesa's surfaceless platform. `device` chooses:
 *  "software" (Mesa llvmpipe), a number (position in EGL's device list), "auto" (preferredRenderer() of all devices);
 *  empty: the environment variable INSONIFY_EGL_DEVICE, else "auto".
 *
 *  With INSONIFY_GL_DEBUG=1, and in debug builds unless it is 0, GL tells at once and in words what it refuses. */
class EglContext {
public:
    explicit EglContext(const std::string& device = {});
    /** Throws GlError when EGL lists no such device; makes no context. */
    static void requireDevice(const std::string& device);
    /** Whether `device` or the environment names one, be it "auto". */
    static bool isAskedFor(const std::string& device);
    /** Whether "auto" takes a graphics card. The first call makes a context on each device that may be one. Not to be
     *  called while EglContext::making() is held. */
    static bool hasCard();
    struct Sharing {
        const EglContext& other;
    };
    /** A context for this thread on the device of another one, with which it shares buffers, textures and programs;
     *  vertex arrays and framebuffers belong to one context. The other one may be current on another thread. */
    explicit EglContext(Sharing with);
    EglContext(const EglContext&) = delete;
    ~EglContext();
    EglContext& operator=(const EglContext&) = delete;

    /** Throws GlError on another thread than the one that made the context, where GL would silently do nothing, and
     *  when a later context has taken its place on this one, where GL would silently serve that. */
    void requireThread() const;
    /** Throws GlError with the first error that GL has reported since the last call, or when the context is lost. */
    void check();

    /** Held while something is drawn, side by side with other contexts; and while data goes to the device or comes from
     *  it, or objects are made or destroyed: then nothing may be drawn in any context of this process. Mesa's software
     *  renderer (22.3) looks, at each transfer, through what all of them are drawing, without a lock, and crashes. Both
     *  are empty on a graphics card. Not to be held twice by a thread. */
    [[nodiscard]] std::shared_lock<std::shared_mutex> drawing() const;
    [[nodiscard]] std::unique_lock<std::shared_mutex> transferring() const;
    /** The same before there is a context, which may be one of the software renderer. */
    [[nodiscard]] static std::unique_lock<std::shared_mutex> making();

    const std::string& renderer() const { return renderer_; }  ///< "llvmpipe (LLVM 15.0.6, 256 bits)".
    const std::string& driver() const { return driver_; }      ///< "4.5 (Core Profile) Mesa 22.3.6".
    const Limits& limits() const { return limits_; }
    bool isSoftware() const { return software_; }
    /** Why it is drawn in software though nobody asked for that, a sentence that may begin with "Warning: "; empty when
     *  it is not. */
    std::string fallback() const;
    /** The programs of this context. */
    Programs& programs() { return *programs_; }
    const Programs& programs() const { return *programs_; }

private:
    void create(const std::string& device);
    void destroy();
    bool createOn(void* display, bool robust, void* shared);
    void watch();

    void* display_ = nullptr;
    void* context_ = nullptr;
    std::thread::id thread_ = std::this_thread::get_id();
    std::string wanted_, renderer_, driver_;
    std::string error_;
    Limits limits_;
    std::unique_ptr<Programs> programs_;
    bool software_ = false;
    bool robust_ = false;
};

}  // namespace insonify::gpu
