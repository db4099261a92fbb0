#pragma once
#include <filesystem>

#include "components/dataset/Sweep.hpp"

namespace insonify::dataset {

/** Reads the sweep of a data set. Its paths are resolved against its folder. Throws types::ConfigError with all
 *  diagnostics and their places. */
Sweep readSweep(const std::filesystem::path& file);

}  // namespace insonify::dataset
