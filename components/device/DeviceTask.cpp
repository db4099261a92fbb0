#include "components/device/DeviceTask.hpp"

#include <algorithm>
#include <chrono>

#include "types/ConfigError.hpp"

namespace insonify::device {

void DeviceTask::check(types::Diagnostics& diagnostics) const {
    if (environment().lockstep)
        diagnostics.push_back(
            {"", "a driver keeps the wall clock's time, for which lockstep does not wait; set schedule: realtime"});
}

std::vector<std::string> DeviceTask::notices() const {
    if (!network_) return {};
    std::vector<std::string> all;
    for (const std::string& end : network_->names()) all.push_back("listens on " + end);
    if (const uint64_t lost = network_->dropped(); lost > 0)
        all.push_back(std::to_string(lost) + " messages not sent, for newer ones or for want of a way");
    return all;
}

bool DeviceTask::configureHook() {
    network_ = std::make_unique<Network>([this] { happened_.raise(); });
    try {
        listen(*network_);
    } catch (const NetworkError& error) {
        throw types::ConfigError("", name() + "." + error.property, error.what());
    }
    return true;
}

void DeviceTask::updateHook() {
    for (const NetworkEvent& event : network_->take()) switch (event.kind) {
            case NetworkEvent::Kind::Opened: opened(event.client); break;
            case NetworkEvent::Kind::Received: received(event.client, event.bytes); break;
            case NetworkEvent::Kind::Closed: closed(event.client); break;
        }
    takePings();
    if (const auto next = tick(now())) {
        const double wait = std::max(0.0, (*next - now()).seconds());
        network_->wakeAt(std::chrono::steady_clock::now() +
                         std::chrono::microseconds(static_cast<int64_t>(1e6 * wait)));
    }
}

}  // namespace insonify::device
