#pragma once
#include <filesystem>
#include <memory>

#include "components/scene/Bathymetry.hpp"

namespace insonify::survey {

/** Opens a survey with GDAL: GeoTIFF, BAG, netCDF, ESRI .flt, ENVI, Erdas .img, or a mosaic of them. Behaves like
 *  scene::openSurvey(). */
std::unique_ptr<scene::Survey> open(const std::filesystem::path& file, int band);

}  // namespace insonify::survey
