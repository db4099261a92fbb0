#include "types/Thread.hpp"

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

void throwNoThread(const std::string& what, const std::system_error& refused) {
    throw std::runtime_error("no thread for " + what + ": " + refused.code().message() +
                             "; the system limits threads (ulimit -u, TasksMax of systemd, pids of a container)");
}

void useDefaultScheduling() {
    const sched_param none{};
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);
}

LentScheduling::LentScheduling(std::thread& other) : other_(other) {
    int policy = SCHED_OTHER;
    sched_param own{};
    if (pthread_getschedparam(pthread_self(), &policy, &own) != 0 || policy == SCHED_OTHER) return;
    is_lent_ = pthread_setschedparam(other_.native_handle(), policy, &own) == 0;
}

LentScheduling::~LentScheduling() {
    const sched_param none{};
    if (is_lent_) pthread_setschedparam(other_.native_handle(), SCHED_OTHER, &none);
}

PriorityMutex::PriorityMutex() {
    pthread_mutexattr_t inherits;
    if (pthread_mutexattr_init(&inherits) != 0) return;  // an ordinary mutex, as where the system has no other
    pthread_mutexattr_setprotocol(&inherits, PTHREAD_PRIO_INHERIT);
    pthread_mutex_destroy(native_handle());
    if (pthread_mutex_init(native_handle(), &inherits) != 0) pthread_mutex_init(native_handle(), nullptr);
    pthread_mutexattr_destroy(&inherits);
}

}  // namespace insonify::types
