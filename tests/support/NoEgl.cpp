// Loaded before a program's own libraries, this library simulates a system without EGL.
#include <dlfcn.h>

#include <string_view>

extern "C" void* dlopen(const char* file, int mode) {
    static const auto system = reinterpret_cast<void* (*)(const char*, int)>(dlsym(RTLD_NEXT, "dlopen"));
    return file && std::string_view(file).starts_with("libEGL") ? nullptr : system(file, mode);
}
