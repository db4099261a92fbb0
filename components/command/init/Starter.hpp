#pragma once
#include <string>
#include <vector>

#include "components/sonars/Sonars.hpp"

namespace insonify::command {

/** Returns the sonars of `init`, those with a starter; the first is its default. */
std::vector<const sonars::SonarFigures*> starterSonars();
/** Throws types::ConfigError when `init` has no sonar of that name. */
const sonars::SonarFigures& starterSonar(const std::string& name);

/** Returns the range of the bins in the starter's water [m]. */
double starterRange(const sonars::SonarFigures& sonar);
/** Returns the deployment for a sonar in the starter's scene, with comments. */
std::string starterDeployment(const sonars::SonarFigures& sonar);

/** A file next to the deployment: scene.glb, make_scene.py, pass.csv, hover.csv or sweep.yml. */
struct StarterFile {
    const char* name;
    std::string bytes;
};
/** Returns the files next to a sonar's deployment. A sweep for data sets belongs to fans alone. */
std::vector<StarterFile> starterFiles(const sonars::SonarFigures& sonar);

}  // namespace insonify::command
