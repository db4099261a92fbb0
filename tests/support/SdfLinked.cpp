// Programs that are linked with the reader need no component library.
#include "components/sdf/Sdf.hpp"

namespace {

[[maybe_unused]] const bool linked = [] {
    for (const char* extension : {".sdf", ".world", ".urdf"}) insonify::scene::addFormat(extension, insonify::sdf::readSdf);
    return true;
}();

}  // namespace
