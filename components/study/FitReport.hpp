#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/study/RecordingFit.hpp"
#include "types/Image.hpp"

namespace insonify::study {

/** Names of the tasks of a deployment that a fit changes. */
struct FitTasks {
    std::string vehicle, scene, sonar, noise, receiver;
    double period = 0.1;           ///< Of the vehicle's poses [s].
    double mount_pitch_deg = 0;    ///< Of the sonar in the body, as the scene has it [deg].
    glm::dvec3 mount_position{0};  ///< Of the sonar in the body [m].
};

/** A property of a fitted deployment: `task.property.path`, its value in YAML, and what is said of it there. */
struct FitSetting {
    std::string path, value, comment;
};

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
