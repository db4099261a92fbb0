#include "components/gpu/EglContext.hpp"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <system_error>
#include <utility>
#include <vector>

#include "components/gpu/Program.hpp"
#include "types/Thread.hpp"

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

int64_t getSize(GLenum name) {
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

constexpr const char* hint =
    "install Mesa's software renderer (Debian: libegl1 libegl-mesa0 libgl1-mesa-dri) or a graphics driver with EGL, "
    "and set the property `device` or INSONIFY_EGL_DEVICE to auto, software or a device number";

/** Returns whether the system has EGL. Without EGL, libepoxy would end the process. */
bool hasEgl() {
    static const bool has = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL) != nullptr;
    return has;
}

/** Returns whether the kernel has a node of a graphics card, by the names of drivers for Linux. Without a node EGL,
 *  which loads about twenty libraries, is not needed. */
bool hasNode() {
    constexpr std::string_view drivers[] = {"dri", "nvidia", "nvhost", "nvmap", "dxg", "mali", "kgsl", "pvr"};
    std::error_code none;
    return std::ranges::any_of(std::filesystem::directory_iterator("/dev", none), [&](const auto& node) {
        const std::string name = node.path().filename().string();
        return std::ranges::any_of(drivers, [&](std::string_view driver) { return name.starts_with(driver); });
    });
}

/** OpenGL's libraries have threads and displays of their own, which a forked child lacks. */
void requireOwnProcess() {
    static const types::OwnProcess first;
    if (first.isForked())
        throw GlError(
            "OpenGL was used before this process was forked from another; start processes with spawn, or fork "
            "before the first sonar that rasterises");
}

bool clientHas(const char* extension) { return hasEgl() && epoxy_has_egl_extension(EGL_NO_DISPLAY, extension); }

std::vector<EGLDeviceEXT> devices() {
    if (!clientHas("EGL_EXT_device_base") && !clientHas("EGL_EXT_device_enumeration")) return {};
    EGLint count = 0;
    if (!eglQueryDevicesEXT(0, nullptr, &count)) return {};
    std::vector<EGLDeviceEXT> all(static_cast<size_t>(count));
    eglQueryDevicesEXT(count, all.data(), &count);
    return all;
}

bool isSoftwareDevice(EGLDeviceEXT device) {
    const char* of_device = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
    return of_device && std::string(of_device).find("EGL_MESA_device_software") != std::string::npos;
}

EGLDisplay initialised(EGLDisplay display) {
    return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) ? display : EGL_NO_DISPLAY;
}

EGLDisplay deviceDisplay(EGLDeviceEXT device) {
    return initialised(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
}

EGLDisplay surfacelessDisplay() {
    if (!clientHas("EGL_MESA_platform_surfaceless")) return EGL_NO_DISPLAY;
    return initialised(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr));
}

/** Makes a context of OpenGL 4.5 core, current on this thread; null when this display has none. */
EGLContext contextOn(EGLDisplay display, bool robust, EGLContext shared) {
    if (!eglBindAPI(EGL_OPENGL_API)) return EGL_NO_CONTEXT;
    std::vector<EGLint> wish = {EGL_CONTEXT_MAJOR_VERSION,       4,
                                EGL_CONTEXT_MINOR_VERSION,       5,
                                EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    if (robust)
        wish.insert(wish.end(), {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE,
                                 EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
    wish.push_back(EGL_NONE);
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, shared, wish.data());
    if (context == EGL_NO_CONTEXT) return context;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return context;
    eglDestroyContext(display, context);
    return EGL_NO_CONTEXT;
}

/** Returns the property, else the environment variable, else "auto". */
std::string chosen(const std::string& device) {
    const char* variable = std::getenv("INSONIFY_EGL_DEVICE");
    return !device.empty() ? device : variable && *variable ? variable : "auto";
}

bool isWord(const std::string& device) { return device == "auto" || device == "software"; }

/** Returns the position in EGL's list; throws GlError when the list has no such device. */
size_t findIndex(const std::string& device, size_t count) {
    size_t index = 0;
    const auto [end, diagnostic] = std::from_chars(device.data(), device.data() + device.size(), index);
    if (diagnostic != std::errc{} || end != device.data() + device.size() || index >= count)
        throw GlError("EGL device '" + device + "': must be auto, software or a number below " + std::to_string(count) +
                      ", the devices that EGL lists here");
    return index;
}

/** A display that is initialised only when needed, because this may wake a card and load its driver. */
struct Candidate {
    std::function<EGLDisplay()> display;
    bool may_be_card = false;  ///< The GL_RENDERER decides: that of a display chip may be llvmpipe.
};

/** Returns the displays that a choice of device allows, best first. */
std::vector<Candidate> candidates(const std::string& device) {
    std::vector<Candidate> displays;
    const auto all = devices();
    const auto add = [&](EGLDeviceEXT one, bool may_be_card) {
        displays.push_back({[one] { return deviceDisplay(one); }, may_be_card});
    };
    if (!isWord(device)) {
        add(all[findIndex(device, all.size())], false);
        return displays;
    }
    for (bool software : {false, true})
        for (EGLDeviceEXT candidate : all)
            if (isSoftwareDevice(candidate) == software && (software || device == "auto")) add(candidate, !software);
    displays.push_back({surfacelessDisplay, device == "auto" && all.empty()});
    return displays;
}

/** Returns whether GL shall report errors at once, which keeps drivers from working ahead. */
bool wantsDebug() {
    const char* variable = std::getenv("INSONIFY_GL_DEBUG");
    if (variable && *variable) return std::string(variable) != "0";
#ifdef NDEBUG
    return false;
#else
    return true;
#endif
}

/** Returns the node of the system's graphics card; empty when there is none. */
std::string cardOfSystem() {
    for (const char* device : {"/dev/nvidiactl", "/dev/dri/renderD128"})
        if (std::error_code none; std::filesystem::exists(device, none)) return device;
    return {};
}

std::string toText(GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); }

/** Returns whether a display gives a context on a graphics card. Leaves no context current on this thread. */
bool isCard(EGLDisplay display) {
    const EGLContext context = display == EGL_NO_DISPLAY ? EGL_NO_CONTEXT : contextOn(display, false, EGL_NO_CONTEXT);
    if (context == EGL_NO_CONTEXT) return false;
    const bool is_card = !isSoftwareRenderer(toText(GL_RENDERER));
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    return is_card;
}

void GLAPIENTRY remember(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* message, const void* first) {
    auto& text = *static_cast<std::string*>(const_cast<void*>(first));
    if (type == GL_DEBUG_TYPE_ERROR && text.empty()) text = message;
}

}  // namespace

Limits Limits::ofCurrentContext() {
    Limits limits;
    for (const Field& extension : extensions) limits.*extension.value = epoxy_has_gl_extension(extension.name);
    limits.texture_size = getSize(GL_MAX_TEXTURE_SIZE);
    limits.viewport_size = getSize(GL_MAX_VIEWPORT_DIMS);
    limits.integer_samples = getSize(GL_MAX_INTEGER_SAMPLES);
    limits.depth_samples = getSize(GL_MAX_DEPTH_TEXTURE_SAMPLES);
    limits.storage_blocks = getSize(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS);
    limits.storage_bindings = getSize(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
    limits.storage_bytes = getSize(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
    limits.shared_bytes = getSize(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE);
    limits.group_invocations = getSize(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
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

bool isSoftwareRenderer(std::string_view renderer) {
    constexpr std::string_view words[] = {"llvmpipe", "lavapipe",    "softpipe",    "software",
                                          "swrast",   "swiftshader", "basic render"};
    std::string name(renderer);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::ranges::any_of(words, [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

std::optional<size_t> preferredRenderer(std::span<const std::string> renderers) {
    std::optional<size_t> software;
    for (size_t i = 0; i < renderers.size(); ++i) {
        if (renderers[i].empty()) continue;
        if (!isSoftwareRenderer(renderers[i])) return i;
        if (!software) software = i;
    }
    return software;
}

EglContext::EglContext(const std::string& device) : wanted_(chosen(device)) {
    create(wanted_);
    watch();
}

void EglContext::requireDevice(const std::string& device) {
    if (const std::string name = chosen(device); !isWord(name)) findIndex(name, devices().size());
}

bool EglContext::isAskedFor(const std::string& device) {
    const char* variable = std::getenv("INSONIFY_EGL_DEVICE");
    return !device.empty() || (variable && *variable);
}

bool EglContext::hasCard() {
    static const bool has = [] {
        if (!hasNode()) return false;
        std::vector<Candidate> all = candidates("auto");
        std::erase_if(all, [](const Candidate& candidate) { return !candidate.may_be_card; });
        if (all.empty()) return false;
        requireOwnProcess();
        const auto alone = making();
        bool found = false;
        const auto look = [&] {
            found = std::ranges::any_of(all, isCard, [](const auto& one) { return one.display(); });
        };
        // A thread of its own, so that the caller's context stays current.
        types::startThread("the search for a graphics card", look).join();
        return found;
    }();
    return has;
}

EglContext::EglContext(Sharing with) : wanted_(with.other.wanted_) {
    const EglContext& other = with.other;
    if (!createOn(other.display_, other.robust_, other.context_))
        throw GlError("no second OpenGL context next to that of " + other.renderer_);
    watch();
}

EglContext::~EglContext() {
    programs_.reset();
    destroy();
}

void EglContext::destroy() {
    if (std::this_thread::get_id() == thread_) eglMakeCurrent(display_, nullptr, nullptr, nullptr);
    eglDestroyContext(display_, context_);  // the display is shared by all contexts of this process and stays
}

void EglContext::create(const std::string& device) {
    requireOwnProcess();
    const std::vector<Candidate> all = candidates(device);
    const auto opens = [&](const Candidate& candidate) {
        const EGLDisplay display = candidate.display();
        return display != EGL_NO_DISPLAY &&
               (createOn(display, true, EGL_NO_CONTEXT) || createOn(display, false, EGL_NO_CONTEXT));
    };
    std::vector<std::string> renderers(all.size());
    for (size_t i = 0; i < all.size(); ++i) {
        if (!all[i].may_be_card && preferredRenderer(renderers)) break;  // the remaining candidates are no cards
        if (!opens(all[i])) continue;
        renderers[i] = toText(GL_RENDERER);
        if (!all[i].may_be_card || !isSoftwareRenderer(renderers[i])) return;
        destroy();
    }
    if (const auto best = preferredRenderer(renderers); best && opens(all[*best])) return;
    throw GlError("no OpenGL 4.5 core context from EGL device '" + device + "': " + hint);
}

bool EglContext::createOn(void* display, bool robust, void* shared) {
    display_ = display;
    robust_ = robust;
    context_ = contextOn(display, robust, shared);
    return context_ != EGL_NO_CONTEXT;
}

void EglContext::watch() {
    renderer_ = toText(GL_RENDERER);
    driver_ = toText(GL_VERSION);
    software_ = isSoftwareRenderer(renderer_);
    limits_ = Limits::ofCurrentContext();
    programs_ = std::make_unique<Programs>();
    if (!wantsDebug()) return;
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    glDebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_ERROR, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    glDebugMessageCallback(remember, &error_);
}

void EglContext::requireThread() const {
    if (std::this_thread::get_id() != thread_)
        throw GlError("the OpenGL context was made on another thread: make, use and destroy it on one task's thread");
    if (eglGetCurrentContext() != context_)
        throw GlError("another OpenGL context has been current on this thread since: use one at a time on a thread");
}

bool EglContext::missesCard() const { return software_ && wanted_ == "auto" && !cardOfSystem().empty(); }

std::string EglContext::fallback() const {
    if (!software_ || wanted_ != "auto") return {};
    const std::string card = cardOfSystem();
    if (card.empty()) return "rasterised in software by " + renderer_ + ": there is no graphics card";
    return "rasterised in software by " + renderer_ + ": the system has a graphics card (" + card +
           "), but EGL gives no OpenGL 4.5 on it; install its driver's EGL (NVIDIA: libegl-nvidia0, in a container "
           "NVIDIA_DRIVER_CAPABILITIES=graphics), or set device: software";
}

namespace {

std::shared_mutex& software() {
    static std::shared_mutex of_all_contexts;
    return of_all_contexts;
}

}  // namespace

std::shared_lock<std::shared_mutex> EglContext::drawing() const {
    return software_ ? std::shared_lock(software()) : std::shared_lock<std::shared_mutex>();
}

std::unique_lock<std::shared_mutex> EglContext::transferring() const {
    return software_ ? making() : std::unique_lock<std::shared_mutex>();
}

std::unique_lock<std::shared_mutex> EglContext::making() { return std::unique_lock(software()); }

void EglContext::check() {
    requireThread();
    if (robust_ && glGetGraphicsResetStatus() != GL_NO_ERROR)
        throw GlError("the OpenGL context was lost (" + renderer_ + "): restart the task; " + hint);
    if (const GLenum code = glGetError(); code != GL_NO_ERROR && error_.empty())
        error_ = "error " + std::to_string(code) + "; set INSONIFY_GL_DEBUG=1 to see where and why";
    if (!error_.empty()) throw GlError("OpenGL: " + std::exchange(error_, {}));
}

}  // namespace insonify::gpu
