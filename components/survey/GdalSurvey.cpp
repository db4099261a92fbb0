#include "components/survey/GdalSurvey.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <limits>
#include <mutex>

#include "components/scene/Scene.hpp"
#include "types/NamedFile.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::survey {
namespace {

/** Memory of GDAL's cache of file blocks, independent of the machine [bytes]. */
constexpr int64_t cache_size = int64_t{64} << 20;

/** Formats that are read by blocks. Other formats of GDAL are excluded: in a truncated text grid it seeks the missing
 *  lines for hours. */
void prepareGdal() {
    static std::once_flag once;
    std::call_once(once, [] {
        if (!CPLGetConfigOption("GDAL_CACHEMAX", nullptr)) GDALSetCacheMax64(cache_size);
        for (const auto add : {GDALRegister_VRT, GDALRegister_GTiff, GDALRegister_BAG, GDALRegister_netCDF,
                               GDALRegister_HFA, GDALRegister_EHdr, GDALRegister_ENVI})
            add();
    });
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
    throw types::ConfigError(file.string(), "", why);
}

std::string reason() {
    const std::string text = CPLGetLastErrorMsg();
    return text.empty() ? "GDAL gives no reason" : "GDAL: " + text;
}

/** Returns the metres per unit of the map. A file without a map is assumed to be in metres; degrees count as such. */
double getMetres(const OGRSpatialReference* map) { return map && !map->IsGeographic() ? map->GetLinearUnits() : 1; }

/** Checks the size of raw binary files. GDAL reads missing values of a truncated file as 0, and would interpret a short
 *  .flt as bytes. */
void checkSize(GDALDataset& dataset, const std::filesystem::path& file) {
    const std::string format = dataset.GetDriverName();
    if (format != "EHdr" && format != "ENVI") return;
    if (dataset.GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE")) return;
    uint64_t expected = 0;
    for (int band = 1; band <= dataset.GetRasterCount(); ++band) {
        const GDALDataType type = dataset.GetRasterBand(band)->GetRasterDataType();
        expected += uint64_t(dataset.GetRasterXSize()) * uint64_t(dataset.GetRasterYSize()) *
                    uint64_t(GDALGetDataTypeSizeBytes(scene::getExtension(file) == ".flt" ? GDT_Float32 : type));
    }
    const uint64_t size = std::filesystem::file_size(file);
    if (size < expected) refuse(file, fmt::format("ends too early: has {} of {} bytes", size, expected));
}

/** Refuses a mosaic whose tiles are elsewhere on the machine or in the network: it could name any file. */
void refuseForeignTiles(GDALDataset& dataset, const std::filesystem::path& file) {
    const std::unique_ptr<char*, decltype(&CSLDestroy)> names(dataset.GetFileList(), CSLDestroy);
    for (char** name = names.get(); name && *name; ++name)
        if (!types::belongsTo(*name, file))
            refuse(file, fmt::format("names {}, which is outside of its folder (links resolved), and is not read; put "
                                     "the mosaic next to its tiles or above them",
                                     *name));
}

struct Close {
    void operator()(GDALDataset* dataset) const { GDALClose(GDALDataset::ToHandle(dataset)); }
};

class GdalSurvey final : public scene::Survey {
public:
    GdalSurvey(const std::filesystem::path& file, int band);
    std::vector<float> read(const scene::PostWindow& window) const override;
    Conversion toMap() const override { return conversion(true); }
    Conversion toEarth() const override { return conversion(false); }

private:
    Conversion conversion(bool to_map) const;

    std::unique_ptr<GDALDataset, Close> dataset_;
    std::string file_;
    int band_;
};

GdalSurvey::GdalSurvey(const std::filesystem::path& file, int band) : file_(file), band_(band) {
    prepareGdal();
    const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
    std::error_code error;
    if (!std::filesystem::exists(file, error)) refuse(file, "is not there");
    CPLErrorReset();
    dataset_.reset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
    if (!dataset_)
        refuse(file, "is no survey (" + reason() +
                         "); may be GeoTIFF, BAG, netCDF, ESRI .flt, ENVI, Erdas .img or a mosaic of them, .vrt; "
                         "gdal_translate IN OUT.tif makes one of others");
    refuseForeignTiles(*dataset_, file);
    checkSize(*dataset_, file);
    if (band > dataset_->GetRasterCount())
        refuse(file, fmt::format("has {} bands, but no band {}", dataset_->GetRasterCount(), band));
    columns_ = dataset_->GetRasterXSize();
    rows_ = dataset_->GetRasterYSize();
    double map[6];
    if (dataset_->GetGeoTransform(map) != CE_None)
        refuse(file,
               "has no place on the map; give it one: gdal_translate -a_ullr WEST NORTH EAST SOUTH "
               "IN OUT");
    if (map[2] != 0 || map[4] != 0) refuse(file, "is rotated against north; rotate it: gdalwarp IN OUT");
    unit_ = dataset_->GetRasterBand(band)->GetUnitType();
    const OGRSpatialReference* const named = dataset_->GetSpatialRef();
    is_in_degrees_ = named && named->IsGeographic();
    const double metres = getMetres(named);
    spacing_ = metres * glm::dvec2(map[1], map[5]);
    first_ = metres * glm::dvec2(map[0], map[3]) + 0.5 * spacing_;
    if (!(std::abs(spacing_.x) > 0 && std::abs(spacing_.y) > 0 && std::isfinite(first_.x + first_.y)))
        refuse(file, fmt::format("has posts {} m and {} m apart", spacing_.x, spacing_.y));
}

scene::Survey::Conversion GdalSurvey::conversion(bool to_map) const {
    const OGRSpatialReference* const named = dataset_->GetSpatialRef();
    if (!named)
        refuse(file_,
               "does not name its map, which a datum needs; name it: gdal_edit.py -a_srs EPSG:32632 FILE, with the "
               "code of "
               "yours, or give easting and northing, and no datum");
    const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
    CPLErrorReset();
    OGRSpatialReference map(*named), earth;
    map.StripVertical();
    earth.importFromEPSG(4326);
    for (OGRSpatialReference* each : {&map, &earth}) each->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::shared_ptr<OGRCoordinateTransformation> made(
        to_map ? OGRCreateCoordinateTransformation(&earth, &map) : OGRCreateCoordinateTransformation(&map, &earth),
        OGRCoordinateTransformation::DestroyCT);
    if (!made)
        refuse(file_, std::string("is on the map ") + map.GetName() + ", which has no place on the earth; " + reason());
    const double metres = getMetres(named), middle = place((columns_ - 1) / 2.0, 0).x;
    return [made, to_map, metres, middle, in_degrees = is_in_degrees_](std::vector<glm::dvec2>& places) {
        const CPLErrorHandlerPusher silent(CPLQuietErrorHandler);
        std::vector<double> x, y;
        for (const glm::dvec2& at : places) {
            x.push_back(to_map ? at.x : at.x / metres);
            y.push_back(to_map ? at.y : at.y / metres);
        }
        std::vector<int> done(places.size());
        made->Transform(static_cast<int>(places.size()), x.data(), y.data(), nullptr, done.data());
        for (size_t i = 0; i < places.size(); ++i) {
            if (to_map) x[i] *= metres, y[i] *= metres;
            if (to_map && in_degrees) x[i] += 360 * std::round((middle - x[i]) / 360);
            places[i] = done[i] != 0 ? glm::dvec2(x[i], y[i]) : glm::dvec2(HUGE_VAL);
        }
    };
}

std::vector<float> GdalSurvey::read(const scene::PostWindow& window) const {
    std::vector<float> values(static_cast<size_t>(window.columns) * static_cast<size_t>(window.rows));
    GDALRasterBand& band = *dataset_->GetRasterBand(band_);
    const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
    CPLErrorReset();
    if (band.RasterIO(GF_Read, window.column, window.row, window.columns, window.rows, values.data(), window.columns,
                      window.rows, GDT_Float32, 0, 0) != CE_None)
        throw scene::SurveyError(file_ + " cannot be read any further; " + reason());
    int has_scale = 0, has_offset = 0, has_none = 0;
    const double scale = band.GetScale(&has_scale), offset = band.GetOffset(&has_offset);
    const auto none = static_cast<float>(band.GetNoDataValue(&has_none));
    for (float& value : values)
        value = has_none != 0 && value == none
                    ? std::numeric_limits<float>::quiet_NaN()
                    : static_cast<float>(value * (has_scale != 0 ? scale : 1) + (has_offset != 0 ? offset : 0));
    return values;
}

}  // namespace

std::unique_ptr<scene::Survey> open(const std::filesystem::path& file, int band) {
    return std::make_unique<GdalSurvey>(file, band);
}

}  // namespace insonify::survey
