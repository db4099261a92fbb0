// The component library study: what the command loads for `insonify study`.
#include "components/deployer/Pipeline.hpp"
#include "components/loader/Interface.hpp"
#include "components/study/commands/StudyCommand.hpp"

INSONIFY_COMPONENT_LIBRARY;

namespace insonify::study {
namespace {

SonarAt sonarAt(const std::string& deployment, uint64_t ping) {
    deployer::SonarAt at = deployer::sonarAt(deployment, ping);
    return {std::move(at.config), std::move(at.snapshot)};
}

PingAt codedPingAt(const std::string& deployment, uint64_t ping) {
    deployer::PingAt at = deployer::codedPingAt(deployment, ping);
    return {std::move(at.ping), std::move(at.code)};
}

}  // namespace
}  // namespace insonify::study

extern "C" void insonify_add_command(CLI::App& app, insonify::command::Action& action) {
    insonify::study::addCommand(app, action, insonify::study::sonarAt, insonify::study::codedPingAt);
}
