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

/** An error of OpenGL or EGL. The message names what to install or set where that helps. */
struct GlError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Programs;

/** Returns whether a GL_RENDERER rasterises on the processor, also through Vulkan: "zink (llvmpipe ...)". */
bool isSoftwareRenderer(std::string_view renderer);

/** Returns the position of the renderer that "auto" takes: the first graphics card, otherwise the first renderer on the
 *  processor. `renderers` are the GL_RENDERER of all devices, empty for a device without OpenGL 4.5. */
std::optional<size_t> preferredRenderer(std::span<const std::string> renderers);

/** A headless OpenGL 4.5 core context, current on the thread that made it and usable only there.
 *
 *  Needs no X server: uses devices by EGL_EXT_platform_device, else Mesa's surfaceless platform. `device` is "software"
 *  (Mesa llvmpipe), a number (position in EGL's device list) or "auto" (preferredRenderer() of all devices). Empty
 *  means the environment variable INSONIFY_EGL_DEVICE, else "auto".
 *
 *  With INSONIFY_GL_DEBUG=1, and in debug builds unless it is 0, GL reports errors at once and in words. */
class EglContext {
public:
    explicit EglContext(const std::string& device = {});
    /** Throws GlError when EGL lists no such device; makes no context. */
    static void requireDevice(const std::string& device);
    /** Returns whether `device` or the environment names a device, including "auto". */
    static bool isAskedFor(const std::string& device);
    /** Returns whether "auto" takes a graphics card. The first call makes a context on each device that may be a card.
     *  Must not be called while EglContext::making() is held. */
    static bool hasCard();
    struct Sharing {
        const EglContext& other;
    };
    /** Makes a context for this thread on the device of another context. The two share buffers, textures and programs;
     *  vertex arrays and framebuffers belong to one context. The other context may be current on another thread. */
    explicit EglContext(Sharing with);
    EglContext(const EglContext&) = delete;
    ~EglContext();
    EglContext& operator=(const EglContext&) = delete;

    /** Throws GlError on a thread other than that of the constructor, where GL would silently do nothing. Also throws
     *  when another context has become current on this thread since, which GL would silently use. */
    void requireThread() const;
    /** Throws GlError with the first error that GL has reported since the last call, or when the context is lost. */
    void check();

    /** Return locks. Hold drawing() while rasterising; several contexts may hold it at the same time. Hold
     *  transferring() while transferring data or making or destroying objects; then no context of this process may
     *  rasterise. At each transfer, Mesa's software renderer (22.3) reads the pending work of all contexts without a
     *  lock, and crashes. Both locks are empty on a graphics card. A thread must not hold them twice. */
    [[nodiscard]] std::shared_lock<std::shared_mutex> drawing() const;
    [[nodiscard]] std::unique_lock<std::shared_mutex> transferring() const;
    /** Returns the lock of transferring() for use before there is a context, which may be on the software renderer. */
    [[nodiscard]] static std::unique_lock<std::shared_mutex> making();

    const std::string& renderer() const { return renderer_; }  ///< "llvmpipe (LLVM 15.0.6, 256 bits)".
    const std::string& driver() const { return driver_; }      ///< "4.5 (Core Profile) Mesa 22.3.6".
    const Limits& limits() const { return limits_; }
    bool isSoftware() const { return software_; }
    /** Returns why it rasterises in software without a request for it; empty otherwise. */
    std::string fallback() const;
    /** Returns whether it rasterises in software although the system has a graphics card, which is worth a warning. */
    bool missesCard() const;
    /** Return the programs of this context. */
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
