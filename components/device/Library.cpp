// The component library device: its task types, `insonify device`, and recordings of an Oculus and of Ping Viewer.
#include "components/device/DeviceTask.hpp"
#include "components/device/OculusRecording.hpp"
#include "components/device/PingViewerLog.hpp"
#include "components/device/commands/DeviceCommand.hpp"
#include "components/loader/Interface.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" {

void insonify_register(insonify::framework::Registry& registry) { insonify::device::registerTasks(registry); }

void insonify_add_command(CLI::App& app, insonify::console::Action& action) {
    insonify::device::addCommand(app, action);
}

void insonify_open_recording(const std::filesystem::path& file,
                             std::unique_ptr<insonify::recordings::RecordingReader>& reader) {
    if (insonify::recordings::recognisedFormat(file).shape == insonify::recordings::RecordedShape::Scan)
        reader = std::make_unique<insonify::device::PingViewerReader>(file);
    else
        reader = std::make_unique<insonify::device::OculusReader>(file);
}

void insonify_export_oculus(insonify::log::Reader& log, const std::string& stream, const std::filesystem::path& to) {
    insonify::device::exportOculus(log, stream, to);
}

}  // extern "C"
