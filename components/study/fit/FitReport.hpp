#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/study/fit/RecordingFit.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::study {

/** Names of a deployment's tasks that a fit changes. */
struct FitTasks {
    std::string vehicle, scene, sonar, noise, receiver;
    double period = 0.1;      ///< Period of the vehicle's poses [s].
    types::Mount mount = {};  ///< The scene's mount of the sonar on the body.
};

/** A property of a fitted deployment: `task.property.path`, its value in YAML, and its comment. */
struct FitSetting {
    std::string path, value, comment;
};

/** Returns the properties that move a deployment's vehicle along the lines of a side-scan, one line per period. */
std::vector<FitSetting> getFoundSettings(const FitChain& chain, const FitTasks& tasks);

/** Returns the properties that turn a deployment into the fitted one. */
std::vector<FitSetting> getSettings(const RecordingFit& fit, const FitTasks& tasks);

/** Returns a page of HTML with the findings, levels over range, and a picture, by its name, of a recorded and a
 *  simulated ping. */
std::string makePage(const RecordingFit& fit, const std::vector<CodedPing>& recorded, const std::string& picture);

/** Writes the page next to a fitted deployment: its name with .html, and the picture with .png. Throws
 *  std::runtime_error if a file cannot be written. @return the page */
std::filesystem::path writePage(const RecordingFit& fit, const std::vector<CodedPing>& recorded,
                                const std::filesystem::path& deployment);

}  // namespace insonify::study
