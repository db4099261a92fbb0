// insonify study error|likeness|multipath|omission|speckle|stability
#include "components/study/StudyCommand.hpp"

namespace insonify::study {

void addCommand(CLI::App& app, command::Action& action, const FindSonar& sonarAt, const FindPing& pingAt) {
    CLI::App* study = app.add_subcommand("study", "Measures the simulator itself");
    study->require_subcommand(1);
#ifdef INSONIFY_EMBREE
    addErrorStudy(*study, action, sonarAt);
    addRaysStudy(*study, action, sonarAt);
    addMultipathStudy(*study, action);
#endif
    addLikenessStudy(*study, action, pingAt);
    addOmissionStudy(*study, action, sonarAt);
    addSpeckleStudy(*study, action, sonarAt);
    addStabilityStudy(*study, action);
}

}  // namespace insonify::study
