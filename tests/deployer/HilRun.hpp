#pragma once
// A deployment with a device, run by the command, and the address of its device.
#include <regex>
#include <string>

#include "tests/deployer/Command.hpp"

namespace insonify::device {

using deployer::insonifyWords;
using deployer::Outcome;
using deployer::Process;
using deployer::readFile;
using deployer::TestFolder;
using deployer::writeFile;

/** A deployment that runs in its own folder until the end of the test; its `device` gets a free port. */
class HilRun {
public:
    HilRun(const std::string& deployment, std::vector<std::string> sets)
        : process_(words(deployment, sets), folder_.path()) {}
    ~HilRun() {
        if (running_) stop();
    }
    HilRun(const HilRun&) = delete;
    HilRun& operator=(const HilRun&) = delete;

    /** Returns the port in its notice; 0 if it has ended, or prints nothing for long. */
    int port() const {
        std::smatch found;
        std::string text;
        const bool reported = test::becomesTrue([&] {
            text = readFile(folder_ / "stderr.txt");
            return std::regex_search(text, found, std::regex(R"(listens on TCP [^ ]*:(\d+))"));
        });
        return reported ? std::stoi(found[1]) : 0;
    }
    Outcome stop() {
        running_ = false;
        process_.signal(SIGINT);
        return process_.wait();
    }
    void signal(int number) const { process_.signal(number); }
    const TestFolder& folder() const { return folder_; }

private:
    static std::vector<std::string> words(const std::string& deployment, const std::vector<std::string>& sets) {
        std::vector<std::string> all = {"run",   deployment,      "--out", "out",
                                        "--set", "device.port=0", "--set", "scene.pose_timeout=60"};
        for (const std::string& set : sets) all.insert(all.end(), {"--set", set});
        return insonifyWords(all);
    }

    TestFolder folder_;
    Process process_;
    bool running_ = true;
};

/** A wall across the way, 40 m wide and high, at a distance in metres north, and a ball in front of it. */
inline std::string wallAndBall(double wall, const std::string& ball_at, double radius) {
    const auto model = [](const std::string& name, const std::string& pose, const std::string& geometry) {
        return "<model name='" + name + "'><static>true</static><pose>" + pose +
               " 0 0 0</pose><link name='l'><visual "
               "name='v'><geometry>" +
               geometry + "</geometry></visual></link></model>";
    };
    return "<sdf version='1.9'><world name='w'>" +
           model("wall", std::to_string(wall + 0.5) + " 0 0", "<box><size>1 40 40</size></box>") +
           model("ball", ball_at, "<sphere><radius>" + std::to_string(radius) + "</radius></sphere>") +
           "</world></sdf>";
}

}  // namespace insonify::device
