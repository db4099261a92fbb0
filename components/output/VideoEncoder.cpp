#include "components/output/VideoEncoder.hpp"

#include <dlfcn.h>

#include <stdexcept>

#include "components/output/video/OpenVideo.hpp"

namespace insonify::output {
namespace {

decltype(&insonify_open_video) loadCodecs() {
    void* library = dlopen("libinsonify_video.so", RTLD_NOW | RTLD_LOCAL);
    void* open = library ? dlsym(library, "insonify_open_video") : nullptr;
    if (!open) throw std::runtime_error(std::string("cannot write videos: ") + dlerror());
    return reinterpret_cast<decltype(&insonify_open_video)>(open);
}

}  // namespace

std::unique_ptr<VideoEncoder> openVideo(const std::filesystem::path& file, double rate, cv::Size size) {
    static const auto open = loadCodecs();
    return std::unique_ptr<VideoEncoder>(open(file.c_str(), rate, size.width, size.height));
}

}  // namespace insonify::output
