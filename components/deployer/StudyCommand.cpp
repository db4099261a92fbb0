// insonify study error|omission|stability
#include "components/deployer/StudyCommand.hpp"

#include "components/deployer/Commands.hpp"

namespace insonify::deployer {

void addStudyCommand(CLI::App& app, Action& action) {
    CLI::App* study = app.add_subcommand("study", "Measures the simulator itself");
    study->require_subcommand(1);
#ifdef INSONIFY_EMBREE
    addErrorStudy(*study, action);
    addRaysStudy(*study, action);
#endif
    addOmissionStudy(*study, action);
    addStabilityStudy(*study, action);
}

}  // namespace insonify::deployer
