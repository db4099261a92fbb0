#include "tests/support/Allocations.hpp"

#include <dlfcn.h>
#include <execinfo.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <sstream>
#include <string_view>

namespace {

thread_local bool counted_here = false;
std::atomic<size_t> count{0};
std::array<std::atomic<void*>, 64> callers;

/** Drivers may allocate, and compile shaders for a device state that first occurs late. */
bool calledByDriver() {
    std::array<void*, 24> frames{};
    const int depth = backtrace(frames.data(), static_cast<int>(frames.size()));
    return std::any_of(frames.begin(), frames.begin() + depth, [](void* frame) {
        Dl_info info;
        if (dladdr(frame, &info) == 0) return false;
        const std::string_view file = info.dli_fname;
        return file.find("_dri.so") != file.npos || file.find("libLLVM") != file.npos;
    });
}

void note(void* caller) {
    if (!counted_here || calledByDriver()) return;
    const size_t index = count++;
    if (index < callers.size()) callers[index] = caller;
}

std::string getPlace(void* address) {
    Dl_info info;
    std::ostringstream text;
    if (dladdr(address, &info) == 0) return "an unknown place";
    text << std::filesystem::path(info.dli_fname).filename().string() << "+0x" << std::hex
         << reinterpret_cast<uintptr_t>(address) - reinterpret_cast<uintptr_t>(info.dli_fbase);
    return text.str();
}

}  // namespace

// Not inlined: g++ would split the pairs and warn that they do not match. The non-throwing new is replaced as well,
// because the sanitizers' version does not match this delete.
[[gnu::noinline]] void* operator new(size_t size) {
    note(__builtin_return_address(0));
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(size_t size, const std::nothrow_t&) noexcept {
    note(__builtin_return_address(0));
    return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace insonify::test {

void countHere(bool on) { counted_here = on; }

std::vector<std::string> takeCounted() {
    std::vector<std::string> places;
    const size_t taken = std::min(count.exchange(0), callers.size());
    for (size_t i = 0; i < taken; ++i) places.push_back(getPlace(callers[i]));
    return places;
}

}  // namespace insonify::test
