// The component library device: its task types, `insonify device`, and the import and export of recordings.
#include "components/device/DeviceTask.hpp"
#include "components/device/commands/DeviceCommand.hpp"
#include "components/device/commands/OculusLog.hpp"
#include "components/loader/Interface.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" {

void insonify_register(insonify::framework::Registry& registry) { insonify::device::registerTasks(registry); }

void insonify_add_command(CLI::App& app, insonify::console::Action& action) {
    insonify::device::addCommand(app, action);
}

void insonify_import_oculus(const std::filesystem::path& recording,
                            std::optional<insonify::framework::DeploymentSpec> spec, const std::filesystem::path& to,
                            insonify::deployer::Imported& imported) {
    imported = insonify::device::importOculus(recording, std::move(spec), to);
}

void insonify_export_oculus(insonify::log::Reader& log, const std::string& stream, const std::filesystem::path& to) {
    insonify::device::exportOculus(log, stream, to);
}

}  // extern "C"
