// The component library survey: what a scene loads that has a surveyed floor.
#include "components/loader/Interface.hpp"
#include "components/survey/GdalSurvey.hpp"

INSONIFY_COMPONENT_LIBRARY;

/** The caller owns it. */
extern "C" insonify::scene::Survey* insonify_open_survey(const std::filesystem::path& file, int band) {
    return insonify::survey::open(file, band).release();
}
