#include "components/device/DeviceTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "components/device/micron/MicronTask.hpp"
#include "components/device/oculus/OculusTask.hpp"
#include "components/device/ping/PingDeviceTask.hpp"
#include "components/device/sonar3d/Sonar3dTask.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::device {
namespace {

constexpr double longest_wait = 0.1;  ///< Between two readings of the clock, so that a step back is noticed [s].

}  // namespace

void DeviceTask::check(types::Diagnostics& diagnostics) const {
    if (environment().lockstep)
        diagnostics.push_back(
            {"", "a driver uses the wall clock, which lockstep does not follow; set schedule: realtime"});
}

types::Notices DeviceTask::notices() const {
    if (!network_) return {};
    types::Notices all;
    for (const std::string& end : network_->names()) all.push_back("listens on " + end);
    if (const uint64_t lost = network_->dropped(); lost > 0)
        all.push_back(std::to_string(lost) + " messages dropped: replaced by newer ones, or no route to the receiver");
    if (const uint64_t failed = network_->failures(); failed > 0)
        all.push_back(std::to_string(failed) + " failures of the network's thread, which continued");
    for (std::string& line : displaced_.summary()) all.push_back(std::move(line));
    return all;
}

bool DeviceTask::configureHook() {
    displaced_.reset();
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
    warnOfDisplaced();
    follow(now());
    readPings();
    const types::Time clock = now();
    if (const auto next = tick(clock)) {
        const double wait = std::clamp((*next - clock).seconds(), 0.0, longest_wait);
        network_->wakeAt(std::chrono::steady_clock::now() +
                         std::chrono::microseconds(static_cast<int64_t>(1e6 * wait)));
    }
}

void DeviceTask::warnOfDisplaced() {
    const uint64_t displaced = network_->displaced();
    if (displaced > displaced_.count())
        displaced_.add(fmt::format("the longest silent of {} on one port, for a newer one", Network::max_clients), "",
                       displaced - displaced_.count());
    if (const std::string warning = displaced_.consumeWarning(); !warning.empty()) warn(warning);
}

void registerTasks(framework::Registry& registry) {
    registry.add<OculusTask>("device::OculusTask", "replaces a Blueprint Subsea Oculus, a forward-looking sonar");
    registry.add<Ping360Task>("device::Ping360Task", "replaces a Blue Robotics Ping360, a scanning sonar");
    registry.add<Ping1dTask>("device::Ping1dTask", "replaces a Blue Robotics Ping1D, an echo sounder");
    registry.add<MicronTask>("device::MicronTask", "replaces a Tritech Micron, by SeaNet over TCP or a serial line");
    registry.add<Sonar3dTask>("device::Sonar3dTask", "replaces a Water Linked Sonar 3D-15, by HTTP and UDP");
}

}  // namespace insonify::device
