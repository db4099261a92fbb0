// Surveys about a datum: each post is where its longitude and latitude are, in any projection.
#include <cpl_conv.h>
#include <fmt/format.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <ogr_spatialref.h>

#include <functional>
#include <random>

#include "components/scene/Bathymetry.hpp"
#include "components/scene/SceneTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"
#include "types/geometry/Angle.hpp"
#include "types/geometry/WorldFrame.hpp"

namespace insonify::survey {

using namespace scene;
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr int columns = 161, rows = 121;

/** A map, and the elevation on it: a slope of at most 0.3 in metres on the ground. */
struct Chart {
    int epsg = 0;           ///< 0: the file does not name its map.
    glm::dvec2 middle{0};   ///< Easting and northing, or longitude and latitude.
    glm::dvec2 spacing{5};  ///< From post to post, on the map.

    double elevation(glm::dvec2 at) const {
        const glm::dvec2 posts = (at - middle) / spacing;
        return -50 + 5 * std::sin(posts.x / 5) * std::cos(posts.y / 7);
    }
    glm::dvec2 first() const { return middle + spacing * glm::dvec2(-(columns - 1) / 2.0, (rows - 1) / 2.0); }
};

struct EarthTest : testing::Test {
    void SetUp() override {
        if (!test::refused([] { types::geodetic({0, 0, 0}, {}); }).empty())
            GTEST_SKIP() << "this build has no GeographicLib";
        config_.file = "given apart";
        config_.tile = 32;
        config_.reach = 150;
        Scene scene;
        scene.geometry = std::make_shared<const types::Geometry>();
        Bathymetry::addMaterials(scene, config_);
        rest_ = scene.geometry;
    }
    std::string write(const Chart& chart, const std::string& name = "survey.tif") {
        GDALRegister_GTiff();
        const std::string file = (folder_ / name).string();
        GDALDataset* const made = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(file.c_str(), columns, rows,
                                                                                           1, GDT_Float64, nullptr);
        const glm::dvec2 corner = chart.first() + chart.spacing * glm::dvec2(-0.5, 0.5);
        double transform[] = {corner.x, chart.spacing.x, 0, corner.y, 0, -chart.spacing.y};
        made->SetGeoTransform(transform);
        if (chart.epsg != 0) {
            OGRSpatialReference map;
            EXPECT_EQ(map.importFromEPSG(chart.epsg), OGRERR_NONE);
            made->SetSpatialRef(&map);
        }
        std::vector<double> values;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                values.push_back(chart.elevation(chart.first() + chart.spacing * glm::dvec2(column, -row)));
        EXPECT_EQ(made->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, columns, rows, values.data(), columns, rows,
                                                   GDT_Float64, 0, 0),
                  CE_None);
        GDALClose(made);
        return file;
    }
    /** Checks all posts of the floor about a place: they have the elevation that the chart has at their longitudes and
     *  latitudes. Returns how many there are.
     *  @param to_map from a place on the earth to the chart */
    size_t check(const Chart& chart, const types::Datum& datum, glm::dvec3 place,
                 const std::function<glm::dvec2(const types::Datum&)>& to_map) {
        Bathymetry floor(config_, write(chart), {}, datum);
        const types::GeometryPtr geometry = floor.about(place, rest_);
        size_t count = 0;
        double worst = 0, worst_post = 0;
        glm::dvec3 low(1e9), high(-1e9);
        for (const types::Object& object : geometry->objects)
            for (const glm::vec3& position : geometry->meshes.at(static_cast<size_t>(object.mesh)).positions) {
                const glm::dvec3 world(object.world_from_object * glm::dvec4(position, 1));
                const types::Datum at = geodetic(datum, types::Axes{types::WorldFrame::Enu}.worldFromRock(world));
                const glm::dvec2 on_map = to_map(at), post = (on_map - chart.first()) / chart.spacing;
                worst = std::max(worst, std::abs(at.height_m - datum.height_m - chart.elevation(on_map)));
                worst_post = std::max(worst_post, glm::length(post - glm::round(post)));
                low = glm::min(low, world), high = glm::max(high, world);
                ++count;
            }
        EXPECT_LT(worst, 2e-3) << "[m]";
        EXPECT_LT(worst_post, 1e-3) << "of the distance of posts";
        if (count > 0)
            for (int axis : {0, 1}) {
                EXPECT_LE(low[axis], place[axis] - config_.reach);
                EXPECT_GE(high[axis], place[axis] + config_.reach);
            }
        return count;
    }
    std::string refusal(const std::string& file, const types::Datum& datum) {
        return test::computeError<types::ConfigError>([&] { Bathymetry(config_, file, {}, datum); });
    }

    Folder folder_;
    BathymetryConfig config_;
    types::GeometryPtr rest_;
    std::mt19937_64 random_{7};
    double draw(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
};

/** Returns the place on the map of UTM or UPS whose zone has this place, by GeographicLib, where the survey uses PROJ.
 */
auto onGrid(const types::Datum& zone) {
    return [zone](const types::Datum& at) {
        const types::GridPlace place = gridPlace(zone, at);
        return glm::dvec2(place.easting, place.northing);
    };
}

/** Returns a chart about a place on the map of a zone. */
Chart chartAt(const types::Datum& zone, const types::Datum& place) {
    const types::GridPlace middle = gridPlace(zone, place);
    return {middle.epsg, glm::round(glm::dvec2(middle.easting, middle.northing)), {5, 5}};
}

TEST_F(EarthTest, PostsAreAtTheirLongitudesAndLatitudesInAnyZone) {
    const types::Datum middle_of_32{54, 9, 0}, middle_of_31{54, 3, 0}, north{88, 40, 0}, south{-75, 9, 0},
        arctic{89.9, 100, 0};
    struct Case {
        types::Datum zone, datum;
    };
    for (const Case& c : {Case{middle_of_32, {54.3, 9.0, 40}}, Case{middle_of_32, {54.3, 11.99, 40}},
                          Case{middle_of_31, {54.3, 5.9999, -3}}, Case{middle_of_31, {54.3, 6.001, 0}},
                          Case{south, {-75.5, 11.5, 12}}, Case{north, {87.5, -120, 0}}, Case{arctic, {89.999, 5, 0}},
                          Case{{-10, 177, 0}, {-10, 179.9999, 0}}, Case{{-10, -177, 0}, {-10, 180, 0}}}) {
        const Chart chart = chartAt(c.zone, c.datum);
        for (const glm::dvec3& place : {glm::dvec3(0), glm::dvec3(60, -120, -30)})
            EXPECT_GT(check(chart, c.datum, place, onGrid(c.zone)), 3'600u) << text(c.datum) << " in " << chart.epsg;
    }
}

TEST_F(EarthTest, TheFloorFollowsTheEarthFarFromTheDatum) {
    const types::Datum zone{54, 9, 0}, datum{54.3, 11.5, 40};
    Chart chart = chartAt(zone, datum);
    chart.spacing = {150, 150};
    config_.reach = 2'000;
    EXPECT_GT(check(chart, datum, {5'000, 7'000, 0}, onGrid(zone)), 700u);
    Bathymetry floor(config_, write(chart), {}, datum);
    const types::GeometryPtr geometry = floor.about({5'000, 7'000, 0}, rest_);
    double lowest = 0;
    for (const types::Object& object : geometry->objects)
        for (const glm::vec3& p : geometry->meshes.at(static_cast<size_t>(object.mesh)).positions)
            lowest = std::min(lowest, (object.world_from_object * glm::dvec4(p, 1)).z);
    EXPECT_LT(lowest, -60) << "9 km away the earth is 6 m below the level of the datum, and the floor is from -55 m up";
}

TEST_F(EarthTest, AMapInDegreesIsReadAboutADatum) {
    const auto inDegrees = [](const types::Datum& at) { return glm::dvec2(at.longitude_deg, at.latitude_deg); };
    const Chart chart{4326, {10.25, 54.5}, {1.0 / 14'400, 1.0 / 21'600}};
    EXPECT_GT(check(chart, {54.5005, 10.2505, 3}, {10, 20, 0}, inDegrees), 3'600u);
    const Chart pacific{4326, {190.2, -20}, {1.0 / 21'600, 1.0 / 21'600}};  // some count longitudes from 0 to 360
    const auto turned = [](const types::Datum& at) { return glm::dvec2(at.longitude_deg + 360, at.latitude_deg); };
    EXPECT_GT(check(pacific, {-20, -169.8, 0}, {}, turned), 3'600u);
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { Bathymetry(config_, write(chart)); }),
                HasSubstr("is in degrees; give the deployment a datum"));
}

TEST_F(EarthTest, AMapOfAnotherScaleCoversTheReach) {
    constexpr double radius = 6'378'137;  // of EPSG:3857, a sphere
    const auto mercator = [](const types::Datum& at) {
        return glm::dvec2(radius * types::radians(at.longitude_deg),
                          radius * std::log(std::tan(types::radians(45 + at.latitude_deg / 2))));
    };
    const types::Datum datum{64, 10.25, 40};
    const Chart chart{3857, mercator(datum), {10, 10}};  // 4.4 m on the ground
    EXPECT_GT(check(chart, datum, {20, 30, -10}, mercator), 3'600u);
}

TEST_F(EarthTest, TheTurnAndTheScaleOfTheMapAreReported) {
    const types::Datum datum{54, 12, 0};
    const Bathymetry floor(config_, write(chartAt({54, 9, 0}, datum)), {}, datum);
    EXPECT_THAT(floor.placeText(),
                AllOf(HasSubstr("easting 696"), HasSubstr("turned by 2.42"), HasSubstr("a metre on it is 0.9999")))
        << "atan(tan(3 deg) sin(54 deg)) is 2.428 deg; the scale is 0.9996 / cos(0.031 / 2 ..)";
    EXPECT_EQ(Bathymetry(config_, write(chartAt({54, 9, 0}, datum))).placeText(), "");
}

TEST_F(EarthTest, RandomDatumsInRandomZonesAgree) {
    config_.reach = 60;
    for (int round = 0; round < 12; ++round) {
        const types::Datum datum{draw(-79, 83), draw(-180, 180), draw(-100, 100)};
        const types::Datum zone{datum.latitude_deg, datum.longitude_deg + draw(-2.9, 2.9), 0};
        if (gridPlace(zone, datum).epsg % 100 > 60) continue;
        EXPECT_GT(check(chartAt(zone, datum), datum, {draw(-80, 80), draw(-80, 80), 0}, onGrid(zone)), 500u)
            << text(datum) << " " << text(zone);
    }
}

TEST_F(EarthTest, ADatumThatDoesNotFitASurveyIsRefused) {
    const types::Datum datum{54.3, 10.2, 0};
    const Chart chart = chartAt({54, 9, 0}, datum);
    const std::string good = write(chart, "good.tif");
    EXPECT_EQ(refusal(good, datum), "");
    EXPECT_THAT(refusal(write({0, chart.middle, {5, 5}}, "bare.tif"), datum),
                AllOf(HasSubstr("does not name its map"), HasSubstr("gdal_edit.py -a_srs")));
    for (const types::Datum& outside : {types::Datum{54.32, 10.2, 0},
                                        {54.3, 10.21, 0},
                                        {10.2, 54.3, 0},
                                        {0, 0, 0},
                                        {90, 0, 0},
                                        {-90, 0, 0},
                                        {54.3, -169.8, 0}})
        EXPECT_THAT(refusal(good, outside),
                    AllOf(HasSubstr("good.tif: reaches from easting"), HasSubstr("outside: give")))
            << text(outside);
    const std::string local = (folder_ / "local.tif").string();
    std::filesystem::copy_file(write({0, chart.middle, {5, 5}}, "other.tif"), local);
    GDALDataset* const opened = GDALDataset::Open(local.c_str(), GDAL_OF_UPDATE);
    OGRSpatialReference grid;
    grid.SetLocalCS("a basin");
    opened->SetSpatialRef(&grid);
    GDALClose(opened);
    EXPECT_THAT(refusal(local, datum), HasSubstr("local.tif"));
}

TEST_F(EarthTest, AVehicleOutsideOfTheSurveyHasNoFloor) {
    const types::Datum datum{54.3, 10.2, 0};
    Bathymetry floor(config_, write(chartAt({54, 9, 0}, datum)), {}, datum);
    for (const glm::dvec3& place : {glm::dvec3(5e3, 0, 0), glm::dvec3(1e300, -1e300, 0), glm::dvec3(0, 1e7, 0)})
        EXPECT_TRUE(floor.about(place, rest_)->objects.empty());
    EXPECT_FALSE(floor.about({}, rest_)->objects.empty()) << "and it is there again";
}

TEST_F(EarthTest, ASceneHasOneZero) {
    const types::Datum datum{54.3, 10.2, 0};
    SceneConfig config;
    config.datum = datum;
    config.bathymetry = config_;
    config.bathymetry->file = write(chartAt({54, 9, 0}, datum));
    const auto refusals = [&] {
        SceneTask task("scene");
        task.config.set(config);
        return test::countRefusals(task);
    };
    EXPECT_THAT(refusals(), testing::IsEmpty());
    config.bathymetry->easting = config.bathymetry->northing = 1;
    EXPECT_THAT(refusals(),
                testing::ElementsAre(AllOf(HasSubstr("bathymetry.easting: is given"), HasSubstr("give one"))));
    config.bathymetry->easting = config.bathymetry->northing = std::nullopt;
    config.bathymetry->map.emplace().meaning.classes = {{"1", "rock"}};
    config.bathymetry->map->file = write({4326, {10.2, 54.3}, {1e-4, 1e-4}}, "classes.tif");
    EXPECT_THAT(refusals(), testing::ElementsAre(AllOf(HasSubstr("bathymetry.map.file"),
                                                       HasSubstr("is in degrees, and the survey in metres"))));
    std::swap(config.bathymetry->file, config.bathymetry->map->file);
    EXPECT_THAT(refusals(), testing::ElementsAre(AllOf(HasSubstr("bathymetry.map.file"),
                                                       HasSubstr("is in metres, and the survey in degrees"))));
    std::swap(config.bathymetry->file, config.bathymetry->map->file);
    config.bathymetry->map.reset();
    config.datum = types::Datum{10.2, 54.3, 0};
    EXPECT_THAT(refusals(), testing::ElementsAre(AllOf(HasSubstr("bathymetry.file"), HasSubstr("outside: give"))));
}

}  // namespace
}  // namespace insonify::survey
