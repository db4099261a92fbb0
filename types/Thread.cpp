#include "types/Thread.hpp"

#include <stdexcept>

namespace insonify::types {

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
