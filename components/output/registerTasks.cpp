#include "components/output/registerTasks.hpp"

#include "components/output/PictureTask.hpp"
#include "components/output/ScanMosaicTask.hpp"

namespace insonify::output {

void registerTasks(framework::Registry& registry) {
    registry.add<FanImageTask>("output::FanImageTask", "shows the pings of a forward-looking sonar as fans");
    registry.add<DiscImageTask>("output::DiscImageTask", "shows the pings of a scanning sonar on a disc");
    registry.add<WaterfallImageTask>("output::WaterfallImageTask", "shows range against time");
    registry.add<ScanMosaicTask>("output::ScanMosaicTask",
                                 "shows the pings of a moving scanning sonar where they belong, beside the disc");
}

}  // namespace insonify::output
