// Programs that are linked with the reader need no component library.
#include "components/survey/GdalSurvey.hpp"

namespace {

[[maybe_unused]] const bool linked = [] {
    insonify::scene::setSurveyOpener(insonify::survey::open);
    return true;
}();

}  // namespace
