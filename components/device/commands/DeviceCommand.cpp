// insonify device list, and insonify device probe ADDRESS
#include "components/device/commands/DeviceCommand.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <tuple>

#include "components/console/Console.hpp"
#include "components/console/Json.hpp"
#include "components/device/DeviceTask.hpp"
#include "components/device/Probe.hpp"
#include "components/framework/Properties.hpp"
#include "components/loader/ComponentLibrary.hpp"

namespace insonify::device {
namespace {

constexpr int answered = 0, silent = 1;

using console::Action, console::Json, console::print;

/** Returns the properties of a task that are ports, with their defaults: "port 12345, discovery.port 30303". */
Json describePorts(const framework::TaskContext& task) {
    Json ports = Json::object();
    for (const auto* properties : task.properties())
        for (const framework::PropertyInfo& property : properties->list())
            if (property.name.ends_with("port")) ports[property.name] = Json::parse(property.default_value);
    return ports;
}

std::string toText(const Json& ports) {
    std::string text;
    for (const auto& [name, port] : ports.items())
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, port.dump());
    return text;
}

int listDevices(bool json) {
    Json devices = Json::array();
    framework::Registry registry;
    registerTasks(registry);
    for (const auto& entry : registry.list())
        devices.push_back({{"type", entry.type}, {"doc", entry.doc}, {"ports", describePorts(*entry.make("device"))}});
    if (json) {
        print(devices);
        return 0;
    }
    for (const Json& device : devices)
        console::printResult("{:22} {}\n{:22} {}\n", device["type"].get<std::string>(),
                             device["doc"].get<std::string>(), "", toText(device["ports"]));
    console::printResult("\nproperties: insonify describe TYPE; how to start and connect each: {}\n",
                         loader::locatePages("components/device/README.md"));
    return 0;
}

Json makeJson(const ProbeOutcome& outcome) {
    return {{"protocol", outcome.protocol},
            {"asked", outcome.request},
            {"device", outcome.device},
            {"failure", outcome.failure},
            {"advice", outcome.advice}};
}

void printDevices(const std::vector<ProbeOutcome>& outcomes) {
    for (const ProbeOutcome& outcome : outcomes)
        if (!outcome.device.empty()) console::printResult("{}: {}\n", outcome.request, outcome.device);
}

/** Groups lines that failed for the same reason before the reason and its remedy. */
void printFailures(std::vector<ProbeOutcome> outcomes) {
    const auto reason = [](const ProbeOutcome& outcome) { return std::tie(outcome.failure, outcome.advice); };
    while (!outcomes.empty()) {
        const ProbeOutcome first = outcomes.front();
        const auto others = std::stable_partition(outcomes.begin(), outcomes.end(), [&](const ProbeOutcome& outcome) {
            return reason(outcome) == reason(first);
        });
        for (auto outcome = outcomes.begin(); outcome != others; ++outcome)
            console::printResult("{}: {}\n", outcome->request, outcome->protocol);
        console::printResult("  {}: {}\n", first.failure, first.advice);
        outcomes.erase(outcomes.begin(), others);
    }
}

int probeDevice(const std::string& address, double timeout, bool json) {
    const std::chrono::milliseconds patience(std::lround(1e3 * timeout));
    const auto outcomes = probe(probeAddress(address), patience);
    const auto answers = [](const ProbeOutcome& outcome) { return !outcome.device.empty(); };
    const bool any = std::ranges::any_of(outcomes, answers);
    if (json) {
        Json all = Json::array();
        for (const ProbeOutcome& outcome : outcomes) all.push_back(makeJson(outcome));
        print(all);
    } else if (any) {
        printDevices(outcomes);
    } else {
        printFailures(outcomes);
    }
    const bool is_silent = std::ranges::count(outcomes, "no answer", &ProbeOutcome::failure) > 0;
    const std::string longer =
        fmt::format(" within {:g} s; a slow machine may take longer: --timeout {:g}", timeout, 5 * timeout);
    if (!any) console::printDiagnostic("insonify: nothing answers at {}{}\n", address, is_silent ? longer : "");
    return any ? answered : silent;
}

void addList(CLI::App& app, Action& action) {
    const auto json = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand("list", "Lists the devices that tasks replace, and their usual ports");
    command->add_flag("--json", *json, "for machines");
    command->callback([json, &action] { action = [json] { return listDevices(*json); }; });
}

void addProbe(CLI::App& app, Action& action) {
    struct Options {
        std::string address;
        double timeout = 1;
        bool json = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "probe", "Identifies the device at an address, real or simulated, or prints why a driver may wait");
    command->add_option("ADDRESS", options->address, "a host, host:port, or the path of a serial line")->required();
    command->add_option("--timeout", options->timeout, "for each question [s]")
        ->capture_default_str()
        ->check(CLI::Range(0.01, 60.0));
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] {
        action = [options] { return probeDevice(options->address, options->timeout, options->json); };
    });
}

}  // namespace

void addCommand(CLI::App& app, Action& action) {
    CLI::App* command =
        app.add_subcommand("device", "Devices on the wire: simulated devices, and the device at an address");
    command->require_subcommand(1);
    addList(*command, action);
    addProbe(*command, action);
}

}  // namespace insonify::device
