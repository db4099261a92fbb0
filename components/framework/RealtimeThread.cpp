#include "components/framework/RealtimeThread.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>

namespace insonify::framework {
namespace {

std::string useFifo(int priority) {
    const sched_param wanted{priority};
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
    if (error == 0) return {};
    if (error != EPERM) return fmt::format("no SCHED_FIFO: {}", std::strerror(error));
    return fmt::format("no SCHED_FIFO: priority {} is not permitted (LimitRTPRIO or ulimit -r, or CAP_SYS_NICE)",
                       priority);
}

std::string useProcessors(const std::vector<uint32_t>& cpus) {
    cpu_set_t wanted;
    CPU_ZERO(&wanted);
    for (const uint32_t cpu : cpus) CPU_SET(cpu, &wanted);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof wanted, &wanted);
    if (error == 0) return {};
    return fmt::format("does not keep to the CPUs {}: {}", fmt::join(cpus, ", "),
                       error == EINVAL ? "there are none of these, or none that this process may use"
                                            : std::strerror(error));
}

}  // namespace

std::vector<std::string> applyToThread(const ActivitySettings& settings) {
    std::vector<std::string> refused;
    if (settings.fifo) refused.push_back(useFifo(settings.priority));
    if (!settings.cpus.empty()) refused.push_back(useProcessors(settings.cpus));
    std::erase(refused, "");
    return refused;
}

std::string lockMemory() {
    // Under a limit the locking of what is there may work, and then allocating fails: so only without one.
    rlimit limit{RLIM_INFINITY, RLIM_INFINITY};
    if (setrlimit(RLIMIT_MEMLOCK, &limit) != 0) {
        getrlimit(RLIMIT_MEMLOCK, &limit);
        if (limit.rlim_cur != RLIM_INFINITY)
            return fmt::format(
                "memory is not locked: {} bytes are permitted, must be unlimited (LimitMEMLOCK or ulimit -l)",
                limit.rlim_cur);
    }
    if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
    return fmt::format("memory is not locked: {}", std::strerror(errno));
}

void unlockMemory() { munlockall(); }

}  // namespace insonify::framework
