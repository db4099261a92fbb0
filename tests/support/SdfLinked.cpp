// Programs that are linked with the reader need no component library.
#include "components/sdf/Sdf.hpp"

namespace {

[[maybe_unused]] const bool linked = [] {
    for (const insonify::scene::SceneFormat& format : insonify::scene::sceneFormats())
        if (format.component == "sdf") insonify::scene::addFormat(std::string(format.ending), insonify::sdf::readSdf);
    return true;
}();

}  // namespace
