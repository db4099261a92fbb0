#include "components/sonar/registerTasks.hpp"

#include "components/sonar/ScanningSonarTask.hpp"
#include "components/sonar/SonarTask.hpp"

namespace insonify::sonar {

void registerTasks(framework::Registry& registry) {
    registry.add<SonarTask>("sonar::SonarTask", "forward-looking imaging sonar, a fan of beams per ping");
    registry.add<ScanningSonarTask>("sonar::ScanningSonarTask", "mechanically scanning sonar, one beam per ping");
}

}  // namespace insonify::sonar
