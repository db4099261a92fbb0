#pragma once
// The .msg files of a package of ROS 2, from the descriptions of our messages.
#include <filesystem>
#include <map>
#include <string>

#include "components/ros/Samples.hpp"
#include "components/ros/Schema.hpp"

namespace insonify::test {

/** Texts of the files of a package, by name: "SonarTruth.msg". */
inline std::map<std::string, std::string> messageFiles(const std::string& package) {
    std::map<std::string, std::string> files;
    ros::forEachMessage([&]<class T>(std::type_identity<T>) {
        const std::filesystem::path name = T::type_name;
        if (*name.begin() != package) return;
        if constexpr (requires { T::summary; })
            files[name.filename().string() + ".msg"] = ros::getFile<T>();
        else
            files[name.filename().string() + ".msg"] = ros::describeDefinition<T>();
    });
    return files;
}

}  // namespace insonify::test
