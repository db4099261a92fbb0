#include "components/device/oculus/OculusTask.hpp"

#include <algorithm>
#include <cmath>

#include "types/text/ConfigError.hpp"

namespace insonify::device {

void OculusTask::check(types::Diagnostics& diagnostics) const {
    DeviceTask::check(diagnostics);
    const std::string &address = config->address, &reported = config->device.device_address;
    const bool has_no_host = address.find(':') != std::string::npos || ipv4(address) == Ipv4{};
    if (reported.empty() && has_no_host)
        diagnostics.push_back({"device_address", "is empty; with address " + address +
                                                     " the status needs an IPv4 address that drivers can connect to"});
    if (!reported.empty() && ipv4(reported).value_or(Ipv4{}) == Ipv4{})
        diagnostics.push_back({"device_address", "is '" + reported + "'; must be an IPv4 address, as 192.168.2.3"});
    if (config->device.gain_min_db > config->device.gain_max_db)
        diagnostics.push_back({"gain_min_db", "is above gain_max_db"});
}

types::Notices OculusTask::notices() const {
    types::Notices all = DeviceTask::notices();
    if (emulator_ && emulator_->lost() > 0)
        all.push_back(std::to_string(emulator_->lost()) + " pings of the sonar did not arrive in time");
    if (emulator_ && emulator_->refused() > 0)
        all.push_back(std::to_string(emulator_->refused()) + " messages of drivers were not valid settings");
    const std::lock_guard alone(failure_mutex_);
    if (unrecorded_ > 0)
        all.push_back(types::warning("at least " + std::to_string(unrecorded_) + " pings are not in " +
                                     *config->record + ": " + record_failure_));
    return all;
}

void OculusTask::listen(Network& network) {
    network.listenTcp(config->address, static_cast<uint16_t>(config->port));
    OculusConfig device = config->device;
    if (device.device_address.empty()) device.device_address = config->address;
    emulator_.emplace(device, now());
    clients_.clear();
    recorded_.reset();  // opened at the start: a run that fails before leaves the file as it is
    if (config->record && !std::filesystem::is_directory(outputPath(*config->record).parent_path()))
        throw NetworkError("record", "is " + outputPath(*config->record).string() + ", which cannot be written");
    no_codes_ = {};
    try {
        sendStatus(emulator_->tick(now()).status, network);
    } catch (const NetworkError& error) {
        throw NetworkError("status_address", error.what());
    }
}

void OculusTask::openRecord() {
    recorded_.reset();
    {
        const std::lock_guard alone(failure_mutex_);
        unrecorded_ = 0;
        record_failure_.clear();
    }
    if (!config->record) return;
    const std::filesystem::path file = outputPath(*config->record);
    try {
        if (!std::filesystem::is_directory(file.parent_path())) throw types::ConfigError("", "", "no folder");
        recorded_ = std::make_unique<output::ByteFile>(file);
    } catch (const types::ConfigError&) {
        throw NetworkError("record", "is " + file.string() + ", which cannot be written");
    }
    const Bytes header = toBytes(OculusFileHeader{.time = now().seconds()});
    recorded_->append({header.begin(), header.end()});
}

bool OculusTask::startHook() {
    try {
        openRecord();
    } catch (const NetworkError& error) {
        throw types::ConfigError("", name() + "." + error.property, error.what());
    }
    return true;
}

void OculusTask::stopHook() {
    if (!recorded_) return;
    try {
        recorded_->close();
    } catch (const std::exception& failure) {
        endRecord(failure);
    }
    recorded_.reset();
}

void OculusTask::record(const Bytes& message) {
    if (!config->record || message.empty()) return;
    if (!recorded_) return countUnrecorded("");
    try {
        const Bytes item = toBytes(getItem(now().seconds(), message));
        const std::vector<char> bytes(item.begin(), item.end());
        if (!environment().mayLose()) return recorded_->append(bytes);
        if (recorded_->tryAppend(bytes)) return;
        countUnrecorded("the disk is slower than the pings");
    } catch (const std::exception& failure) {
        endRecord(failure);
    }
}

void OculusTask::countUnrecorded(const std::string& why) {
    const std::lock_guard alone(failure_mutex_);
    ++unrecorded_;
    if (!why.empty()) record_failure_ = why;
}

void OculusTask::endRecord(const std::exception& failure) {
    if (!environment().mayLose()) throw;
    countUnrecorded(failure.what());
    recorded_.reset();
    error(failure.what() + std::string("; the recording ends here, and further pings are not in it"));
}

void OculusTask::sendStatus(const Bytes& status, Network& network) const {
    if (!status.empty()) network.sendTo(config->status_address, static_cast<uint16_t>(config->status_port), status);
}

void OculusTask::opened(Client client) {
    clients_.insert(client);
    emulator_->opened(client.number);
}

void OculusTask::received(Client client, std::span<const uint8_t> bytes) { emulator_->received(client.number, bytes); }

void OculusTask::closed(Client client) {
    clients_.erase(client);
    emulator_->closed(client.number);
}

void OculusTask::readPings() {
    types::SonarPtr sample;
    while (ping.readNew(sample)) {
        checkCodes(*sample);
        const Bytes message = emulator_->ping(*sample);
        sendToAll(message);
        record(message);
    }
}

void OculusTask::checkCodes(const types::Sonar& codes) {
    const auto is_no_code = [](float bin) { return bin != std::floor(bin); };
    if (no_codes_.isDue(std::ranges::any_of(codes.bins, is_no_code)))
        warn("ping: bins are no whole numbers; give the receiver output: code");
}

void OculusTask::sendToAll(const Bytes& message) {
    if (message.empty()) return;
    for (const Client& client : clients_) network().send(client, message, Network::Kind::Stream);
}

std::optional<types::Time> OculusTask::tick(types::Time now) {
    const OculusEmulator::Due due = emulator_->tick(now);
    sendStatus(due.status, network());
    sendToAll(due.dummy);
    if (due.ask) settings.write(*due.ask);
    return due.next;
}

}  // namespace insonify::device
