// Pings of 1 MB, 40 a second, from one process to another by DDS; times as JSON.
//
//     dds_bench listen SECONDS       "ready", then the number of pings, and their delay after the stamp
//     dds_bench send SECONDS WAIT    waits for WAIT seconds, then sends; the duration of sending
#include <algorithm>
#include <chrono>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "components/dds/Endpoints.hpp"
#include "components/dds/PublisherTask.hpp"
#include "components/framework/Port.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Stamps.hpp"
#include "types/samples/Sonar.hpp"

using namespace insonify;
using Clock = std::chrono::steady_clock;

namespace {

constexpr const char* topic = "/bench/sonar";

void report(std::vector<double> milliseconds) {
    std::ranges::sort(milliseconds);
    const auto at = [&](double share) {
        return milliseconds.empty() ? 0 : milliseconds[static_cast<size_t>(share * double(milliseconds.size() - 1))];
    };
    std::cout << "{\"count\": " << milliseconds.size() << ", \"median_ms\": " << at(0.5) << ", \"p99_ms\": " << at(0.99)
              << ", \"max_ms\": " << at(1) << "}" << std::endl;
}

void listen(double seconds) {
    dds::Node node(dds::domainId({}), "listener", 16);
    std::vector<double> latencies;
    dds::Reader reader(node, dds::ddsTopic(topic), ros::ProjectedSonarImage::type_name, "", {}, {});
    std::cout << "ready" << std::endl;
    dds::Bytes bytes;
    ros::ProjectedSonarImage image;
    uint64_t sender = 0;
    for (const auto end = Clock::now() + std::chrono::duration<double>(seconds); Clock::now() < end;) {
        while (reader.take(bytes, sender)) {
            ros::decode(std::span<const char>(bytes), image);
            latencies.push_back((framework::wallClock() - ros::fromRos(image.header.stamp)).seconds() * 1e3);
        }
        std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    report(std::move(latencies));
}

types::Sonar ping() {
    types::Sonar made;
    made.resize(1000, 256);
    made.bin_duration = {20};
    made.setRegularBearings(types::Angle{-1}, types::Angle{2.0 / 256});
    std::fill(made.bins.begin(), made.bins.end(), 0.5f);
    return made;
}

struct Source : framework::TaskContext {
    Source() : TaskContext("source") {}
    framework::OutputPort<types::SonarPtr> ping{this, "ping", "a ping of 1 MB"};
};

void send(double seconds, double wait) {
    Source source;
    dds::PublisherTask task("publisher");
    dds::PublisherConfig config;
    config.topics.resize(1);
    config.topics[0].port = "ping";
    config.topics[0].topic = topic;
    config.topics[0].sonar.dtype = ros::ImageType::Float32;
    task.config.set(config);
    source.ping.connectTo(*task.makeInput("ping", source.ping), framework::ConnPolicy::buffer(4));
    if (const auto done = task.configure(); !done) throw std::runtime_error(done.reason);
    task.start();
    std::this_thread::sleep_for(std::chrono::duration<double>(wait));
    const auto sample = std::make_shared<types::Sonar>(ping());
    std::vector<double> times;
    auto due = Clock::now();
    for (int i = 0; i < static_cast<int>(40 * seconds); ++i, due += std::chrono::milliseconds(25)) {
        std::this_thread::sleep_until(due);
        const auto start = Clock::now();
        sample->time = framework::wallClock();
        source.ping.write(sample);
        task.update();
        times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    report(std::move(times));
    std::this_thread::sleep_for(std::chrono::seconds(1));
}

}  // namespace

int main(int count, char** words) {
    try {
        if (count == 3 && std::string(words[1]) == "listen") return listen(std::atof(words[2])), 0;
        if (count == 4 && std::string(words[1]) == "send") return send(std::atof(words[2]), std::atof(words[3])), 0;
        std::cerr << "dds_bench: listen SECONDS, or send SECONDS WAIT\n";
    } catch (const std::exception& error) {
        std::cerr << "dds_bench: " << error.what() << "\n";
        return 1;
    }
    return 2;
}
