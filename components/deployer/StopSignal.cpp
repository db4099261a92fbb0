#include "components/deployer/StopSignal.hpp"

#include <csignal>

namespace insonify::deployer {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

extern "C" void raiseStop(int) { stop = true; }

}  // namespace

const std::atomic<bool>& stopOnSignals() {
    struct sigaction action {};
    action.sa_handler = raiseStop;
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    struct sigaction before {};
    sigaction(SIGHUP, nullptr, &before);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup ignores it
    return stop;
}

}  // namespace insonify::deployer
