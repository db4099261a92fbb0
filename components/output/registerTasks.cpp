#include "components/output/registerTasks.hpp"

#include "components/output/PictureTask.hpp"

namespace insonify::output {

void registerTasks(framework::Registry& registry) {
    registry.add<FanImageTask>("output::FanImageTask", "shows the pings of a forward-looking sonar as fans");
    registry.add<DiscImageTask>("output::DiscImageTask", "shows the pings of a scanning sonar on a disc");
    registry.add<WaterfallImageTask>("output::WaterfallImageTask", "shows range against time");
}

}  // namespace insonify::output
