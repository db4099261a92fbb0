#include "components/scene/Survey.hpp"

#include <atomic>

#include "components/loader/ComponentLibrary.hpp"
#include "types/ConfigError.hpp"

namespace insonify::scene {
namespace {

std::atomic<SurveyOpener>& opener() {
    static std::atomic<SurveyOpener> opener = nullptr;
    return opener;
}

/** Returns the opener of the component library. */
auto* libraryOpener(const std::filesystem::path& file) try {
    return loader::load("survey").entry<Survey*(const std::filesystem::path&, int)>("insonify_open_survey");
} catch (const types::ConfigError& error) {
    throw types::ConfigError(file.string(), "", error.diagnostics().front().text());
}

}  // namespace

std::unique_ptr<Survey> openSurvey(const std::filesystem::path& file, int band) {
    if (const SurveyOpener given = opener()) return given(file, band);
    return std::unique_ptr<Survey>(libraryOpener(file)(file, band));
}

void setSurveyOpener(SurveyOpener given) { opener() = given; }

}  // namespace insonify::scene
