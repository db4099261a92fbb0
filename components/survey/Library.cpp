// The component library survey: opens surveyed sea floors for scenes.
#include "components/loader/Interface.hpp"
#include "components/survey/GdalSurvey.hpp"

INSONIFY_COMPONENT_LIBRARY;

/** Returns a survey that the caller owns. */
extern "C" insonify::scene::Survey* insonify_open_survey(const std::filesystem::path& file, int band) {
    return insonify::survey::open(file, band).release();
}
