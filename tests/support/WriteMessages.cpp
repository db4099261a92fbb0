// Writes the .msg files of a package: ros_messages insonify_msgs ros2/insonify_msgs/msg
#include <fstream>
#include <iostream>

#include "tests/support/MessageFiles.hpp"

int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "usage: ros_messages PACKAGE FOLDER\n";
        return 2;
    }
    const std::filesystem::path folder = argv[2];
    std::filesystem::create_directories(folder);
    for (const auto& [name, text] : insonify::test::messageFiles(argv[1]))
        if (!(std::ofstream(folder / name) << text).flush()) {
            std::cerr << "ros_messages: " << folder / name << " cannot be written\n";
            return 1;
        }
}
