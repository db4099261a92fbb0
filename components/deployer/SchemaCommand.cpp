// insonify schema
#include "components/deployer/Commands.hpp"
#include "components/deployer/Schema.hpp"
#include "components/deployer/Tasks.hpp"

namespace insonify::deployer {

void addSchemaCommand(CLI::App& app, Action& action) {
    CLI::App* command = app.add_subcommand(
        "schema", "Prints the JSON schema of deployments, with which editors complete and check them");
    command->callback([&action] {
        action = [] {
            print(deploymentSchema(builtInTasks()));
            return 0;
        };
    });
}

}  // namespace insonify::deployer
