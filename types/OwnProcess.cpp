#include "types/OwnProcess.hpp"

#include <pthread.h>

#include <atomic>
#include <stdexcept>
#include <string>

namespace insonify::types {
namespace {

/** How many forks led from the first process to this one. */
std::atomic<unsigned>& generation() {
    static std::atomic<unsigned> forks{0};
    static const int registered = pthread_atfork(nullptr, nullptr, [] { ++generation(); });
    static_cast<void>(registered);
    return forks;
}

}  // namespace

OwnProcess::OwnProcess() : generation_(generation()) {}

bool OwnProcess::isForked() const { return generation_ != generation(); }

void OwnProcess::require(const char* what) const {
    if (isForked())
        throw std::runtime_error(std::string(what) +
                                 " was made in a process from which this one was forked, and its threads stayed there; "
                                 "make one in each process, "
                                 "after the fork (in the initializer of a pool, in worker_init_fn of a data loader), "
                                 "or start processes with "
                                 "spawn");
}

}  // namespace insonify::types
