#pragma once
#include "components/device/ping/Ping1dEmulator.hpp"
#include "components/device/ping/PingDeviceTask.hpp"
#include "components/framework/Graph.hpp"
#include "components/framework/Properties.hpp"

namespace insonify::device {

struct Ping1dTaskConfig {
    PingEnds ends{9090};
    Ping1dConfig device;

    static void describe(auto& self, auto& visit) {
        PingEnds::describe(self.ends, visit);
        Ping1dConfig::describe(self.device, visit);
    }
    void check(types::Diagnostics& diagnostics) const { ends.check(diagnostics); }
};

/** Replaces a Blue Robotics Ping1D for drivers, viewers and autopilots, over UDP, TCP or a serial line. Ping1dEmulator
 *  has the device's behaviour. Connect `settings` to a sonar::AltimeterTask, and for the gain to its receiver. */
class Ping1dTask final : public PingDeviceTask {
public:
    using PingDeviceTask::PingDeviceTask;
    framework::Properties<Ping1dTaskConfig> config{this};

private:
    const PingEnds& ends() const override { return config->ends; }
    std::unique_ptr<PingDevice> makeDevice() const override {
        Ping1dConfig device = config->device;
        device.nearest = framework::upstreamReturnRules(ping, types::left_receiver).range_min;
        return std::make_unique<Ping1dEmulator>(device);
    }
};

}  // namespace insonify::device
