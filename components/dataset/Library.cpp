// The component library dataset: the command `insonify dataset`.
#include "components/dataset/commands/DatasetRun.hpp"
#include "components/loader/Interface.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_add_command(CLI::App& app, insonify::console::Action& action) {
    insonify::dataset::addCommand(app, action);
}
