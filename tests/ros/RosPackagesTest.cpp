// ros2/insonify_msgs compared with the descriptions of the messages, and with the code that ROS 2's generators make
// from it.
#include <gmock/gmock.h>

#include <cstring>
#include <fstream>
#include <tuple>

#include "components/ros/Cdr.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/MessageFiles.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

namespace insonify::ros {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/** Returns one message of each type, with distinct values. */
std::tuple<SonarTruth, SonarReturns, SonarElements, SonarSettings> samples() {
    std::tuple<SonarTruth, SonarReturns, SonarElements, SonarSettings> made;
    auto& [truth, returns, elements, settings] = made;
    truth.header = {{1'700'000'000, 123'456'789}, "sonar"};
    truth.bin_duration_us = 20;
    truth.sound_speed = 1500;
    truth.bin_count = 3;
    truth.bearings = {-0.5};
    truth.objects = {"seabed", "quay wall"};
    truth.elevation = {0.1f, 0.2f, 0.3f};
    truth.object = {0, -1, 1};
    truth.share = {1, 0, 0.75f};
    truth.hits = {7, 0, 5};
    truth.grazing = {0.5f, 0.25f, 0.125f};
    truth.path = {0, 1, 2};
    truth.shadow = {0, 1, 0};
    returns.header = {{5, 6}, "a"};
    returns.bearings = {-0.25, 0.25};
    returns.first_range = {3, 4};
    returns.strongest_elevation = {0.5f, -0.5f};
    elements.header.frame_id = "array";
    elements.sample_count = 2;
    elements.positions = {0.001};
    elements.in_phase = {1, 2};
    elements.quadrature = {-3, -4};
    settings.range = 30.6;
    settings.bin_count = 500;
    settings.beam_count = 256;
    return made;
}

template <class T>
std::string getName(const T&) {
    return fs::path(T::type_name).filename();
}

/** Runs a shell command; returns its output if it failed, else an empty text. */
std::string failure(const std::string& command, const fs::path& output) {
    const int status = std::system((command + " > " + output.string() + " 2>&1").c_str());
    return status == 0 ? "" : content(output);
}

/** Makes a colcon workspace with insonify_msgs and the packages that it needs and Debian lacks. */
void makeWorkspace(const fs::path& folder) {
    const fs::path messages = test::sourceFile("ros2/insonify_msgs");
    fs::create_directories(folder / "src");
    fs::copy(messages, folder / "src/insonify_msgs", fs::copy_options::recursive);
    struct Package {
        std::string name, file, needs;
    };
    for (const auto& [package, message, needs] :
         {Package{"builtin_interfaces", "Time.msg", ""}, Package{"std_msgs", "Header.msg", "builtin_interfaces"}}) {
        const fs::path made = folder / "src" / package;
        fs::create_directories(made / "msg");
        std::ofstream(made / "msg" / message) << test::messageFiles(package).at(message);
        for (const char* file : {"CMakeLists.txt", "package.xml"}) {
            std::string text = content(messages / file);
            for (const auto& [from, to] : {std::pair<std::string, std::string>("std_msgs", needs),
                                           std::pair<std::string, std::string>("insonify_msgs", package)})
                for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
                    text.replace(at, from.size(), to);
            if (needs.empty())
                for (const char* gone : {"find_package( REQUIRED)\n", " DEPENDENCIES ", "  <depend></depend>\n"})
                    if (const size_t at = text.find(gone); at != std::string::npos) text.erase(at, std::strlen(gone));
            std::ofstream(made / file) << text;
        }
    }
    // A ROS installation lists its generators here; the stubs list those of Debian for C++ and its introspection.
    for (const char* stub : {"rosidl_default_generators", "rosidl_default_runtime"}) {
        const fs::path config = folder / "stubs/share" / stub / "cmake";
        fs::create_directories(config);
        std::ofstream(config / (std::string(stub) + "Config.cmake"))
            << "foreach(package rosidl_cmake rosidl_generator_cpp rosidl_typesupport_introspection_cpp)\n"
               "  find_package(${package} REQUIRED)\nendforeach()\n";
    }
}

}  // namespace

TEST(RosPackagesTest, MessageFilesMatchTheDescriptions) {
    const fs::path folder = test::sourceFile("ros2/insonify_msgs/msg");
    const auto files = test::messageFiles("insonify_msgs");
    EXPECT_EQ(files.size(), 4u);
    for (const auto& [name, text] : files)
        EXPECT_EQ(content(folder / name), text) << "build/bin/ros_messages insonify_msgs ros2/insonify_msgs/msg";
    for (const auto& entry : fs::directory_iterator(folder)) EXPECT_TRUE(files.contains(entry.path().filename()));
}

TEST(RosPackagesTest, RosbagsReadsTheFilesWithTheHashesOfTheTopics) {
    if (!pythonHas("rosbags"))
        GTEST_SKIP() << "SKIPPED: the Python package rosbags is missing; scripts/setup installs it";
    const Folder folder;
    std::ofstream list(folder / "list");
    std::apply(
        [&](const auto&... sample) {
            const auto add = [&]<class T>(const T& message) {
                std::vector<char> bytes;
                encode(message, bytes);
                const std::string name = getName(message);
                const std::string text = content(test::sourceFile("ros2/insonify_msgs/msg/" + name + ".msg"));
                std::ofstream(folder / (name + ".msg"))
                    << text << describeSchema<T>().substr(describeDefinition<T>().size());
                std::ofstream(folder / (name + ".cdr")).write(bytes.data(), static_cast<int64_t>(bytes.size()));
                list << name << ' ' << T::type_name << ' ' << typeHash<T>() << std::endl;
            };
            (add(sample), ...);
        },
        samples());
    EXPECT_EQ(
        pythonSays(test::sourceFile("tests/ros/read_messages.py ") + folder.path().string(), folder.path() / "answer"),
        "4 messages as announced\n");
}

TEST(RosPackagesTest, CodeGeneratedByDebiansRosidlHasTheSameFieldsAndBytes) {
    for (const char* needed : {"/usr/share/rosidl_cmake", "/usr/share/rosidl_generator_cpp", "/usr/share/ament_cmake",
                               "/usr/share/rosidl_typesupport_introspection_cpp", "/usr/bin/colcon"})
        if (!fs::exists(needed))
            GTEST_SKIP() << "NOT TESTED: " << needed << " is missing: rosidl-generator-c-cpp, ament-cmake and "
                         << "python3-colcon-ros of Debian 12 have it";
    const Folder folder;
    makeWorkspace(folder.path());
    const std::string stubs =
        "-DPython3_EXECUTABLE=/usr/bin/python3 -DCMAKE_PREFIX_PATH=" + (folder / "stubs").string();
    const std::string in_folder = "cd " + folder.path().string() + " && ";
    ASSERT_EQ(failure(in_folder + "colcon build --cmake-args -DBUILD_TESTING=OFF -DCMAKE_BUILD_TYPE=Debug " + stubs,
                      folder / "colcon.txt"),
              "");
    const std::string in_workspace = in_folder + ". install/setup.sh && ";
    fs::create_directories(folder / "peer");
    fs::copy(test::sourceFile("tests/ros/rosidl/peer.cmake"), folder / "peer/CMakeLists.txt");
    ASSERT_EQ(failure(in_workspace + "cmake -S peer -B peer/build " + stubs + " -DSOURCE=" +
                          test::sourceFile("tests/support/RosidlPeer.cpp") + " && cmake --build peer/build",
                      folder / "cmake.txt"),
              "");
    std::string expected;
    std::apply(
        [&](const auto&... sample) {
            const auto add = [&]<class T>(const T& message) {
                std::vector<char> bytes;
                encode(message, bytes);
                std::ofstream(folder / (getName(message) + ".cdr"))
                    .write(bytes.data(), static_cast<int64_t>(bytes.size()));
                expected += shortName(T::type_name) + "\n" + describeDefinition<T>();
            };
            (add(sample), ...);
        },
        samples());
    ASSERT_EQ(failure(in_workspace + "peer/build/rosidl_peer .", folder / "answer.txt"), "");
    EXPECT_EQ(content(folder / "answer.txt"), expected + "1700000000 sonar quay wall 0.75 0.25 -4 30.6 256\n");
    for (const char* name : {"SonarTruth", "SonarReturns", "SonarElements", "SonarSettings"}) {
        const std::string bytes = content(folder / (std::string(name) + ".cdr"));
        EXPECT_GT(bytes.size(), 20u);
        EXPECT_EQ(content(folder / (std::string(name) + ".again")), bytes) << name;
    }
}

}  // namespace insonify::ros
