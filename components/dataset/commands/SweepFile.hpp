#pragma once
#include <filesystem>

#include "components/dataset/Sweep.hpp"

namespace insonify::dataset {

/** Reads the sweep of a data set; paths in it become relative to where it stands. Throws types::ConfigError with every
 *  diagnostic of it, each at its place. */
Sweep readSweep(const std::filesystem::path& file);

}  // namespace insonify::dataset
