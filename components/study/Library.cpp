// The component library study: loaded by the command for `insonify study` and `insonify fit`.
#include "components/loader/Interface.hpp"
#include "components/study/commands/StudyCommand.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_add_command(CLI::App& app, insonify::console::Action& action) {
    insonify::study::addCommand(app, action);
    insonify::study::addFit(app, action);
}
