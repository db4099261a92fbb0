#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/study/RecordingFit.hpp"
#include "types/Image.hpp"
#include "types/Mount.hpp"

namespace insonify::study {

/** Names of the tasks of a deployment that a fit changes. */
struct FitTasks {
    std::string vehicle, scene, sonar, noise, receiver;
    double period = 0.1;      ///< Between the vehicle's poses [s].
    types::Mount mount = {};  ///< The sonar in the body, as the scene has it.
};

/** A property of a fitted deployment: `task.property.path`, its value in YAML, and what is said of it there. */
struct FitSetting {
    std::string path, value, comment;
};

/** The properties that move a deployment's vehicle along the lines of a side-scan, a line in each of its periods. */
std::vector<FitSetting> wayOf(const FitChain& chain, const FitTasks& tasks);

/** The properties that make a deployment the fitted one. */
std::vector<FitSetting> settingsOf(const RecordingFit& fit, const FitTasks& tasks);

/** A page of HTML: what was found, levels over range, and a picture, by its name, of a recorded and a simulated ping.
 */
std::string pageOf(const RecordingFit& fit, const std::vector<CodedPing>& recorded, const std::string& picture);

/** Writes the page next to a fitted deployment: its name with .html, and the picture with .png.
 *  Throws std::runtime_error where one cannot be written. @return the page */
std::filesystem::path writePage(const RecordingFit& fit, const std::vector<CodedPing>& recorded,
                                const std::filesystem::path& deployment);

}  // namespace insonify::study
