#include "components/viewer/registerTasks.hpp"

#include "components/viewer/ViewerTask.hpp"

namespace insonify::viewer {

void registerTasks(framework::Registry& registry) {
    registry.add<ViewerTask>("viewer::ViewerTask", "shows what runs: a page in the browser, and data for Foxglove");
}

}  // namespace insonify::viewer
