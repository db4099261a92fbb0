// Replaces pthread_create, in a test or, preloaded, in a program: INSONIFY_THREADS is the number of its threads then.
#include "tests/support/ThreadLimit.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <limits>

namespace {

constexpr int any = std::numeric_limits<int>::max() / 2;

int fromEnvironment() {
    const char* const given = std::getenv("INSONIFY_THREADS");
    return given ? std::atoi(given) : any;
}

std::atomic<int> permitted{fromEnvironment()};

}  // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*), void* with) {
    using Create = decltype(&pthread_create);
    static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
    if (--permitted < 0) return EAGAIN;
    return create(thread, attributes, start, with);
}

namespace insonify::test {

ThreadLimit::ThreadLimit(int count) { permitted = count; }
ThreadLimit::~ThreadLimit() { permitted = any; }

}  // namespace insonify::test
