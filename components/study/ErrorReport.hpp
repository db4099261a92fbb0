#pragma once
#include <filesystem>

#include "components/study/ErrorAnalysis.hpp"

namespace insonify::study {

/** `error_time.csv`: one line for each point. */
std::string csvOf(const ErrorResult& result);
/** `error_time.json`: points, references, slopes, times to 10, 1 and 0.1 % and how they were found, verdicts, device.
 */
std::string jsonOf(const ErrorResult& result);
/** One diagram of a scene, rel_l2 over median time. */
std::string diagramOf(const ErrorResult& result, const std::string& scene);
/** A page that holds it all and needs nothing else. */
std::string pageOf(const ErrorResult& result);

/** Writes error_time.csv, error_time.json, SCENE.svg and index.html. Throws std::runtime_error when it cannot. */
void writeReport(const ErrorResult& result, const std::filesystem::path& folder);

}  // namespace insonify::study
