#include "components/logger/registerTasks.hpp"

#include "components/logger/LoggerTask.hpp"

namespace insonify::logger {

void registerTasks(framework::Registry& registry) {
    registry.add<LoggerTask>("logger::LoggerTask", "writes what it is connected to into a pocolog or MCAP file");
}

}  // namespace insonify::logger
