// The floor of a survey: places of its posts, its extent, and invalid files.
#include <fmt/format.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <glm/geometric.hpp>
#include <set>
#include <thread>

#include "components/scene/Bathymetry.hpp"
#include "components/scene/SceneTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Refused.hpp"
#include "types/geometry/Extent.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::survey {

using namespace scene;
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/** Elevation at an easting and northing: no two posts have the same. */
double elevation(double east, double north) { return -50 + 0.01 * (east - 1000) + 0.001 * (north - 5000); }

struct BathymetryTest : testing::Test {
    std::string write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    /** An ESRI grid of posts 2 m apart with this number of columns; its south-west post is at easting 1000, northing
     *  5000. */
    std::string grid(const std::string& name, int columns, int rows, int first_column = 0) {
        std::vector<float> values;
        for (int row = rows - 1; row >= 0; --row)
            for (int column = first_column; column < first_column + columns; ++column)
                values.push_back(column == hole_.x && row == hole_.y
                                     ? -9999
                                     : static_cast<float>(elevation(1000 + 2 * column, 5000 + 2 * row)));
        write(name + ".hdr", fmt::format("ncols {}\nnrows {}\nxllcenter {}\nyllcenter 5000\ncellsize 2\nNODATA_value "
                                         "-9999\nbyteorder LSBFIRST\n",
                                         columns, rows, 1000 + 2 * first_column));
        return write(name + ".flt", {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
    }
    static std::string shortened(const std::string& file) {
        fs::resize_file(file, fs::file_size(file) / 2);
        return file;
    }
    /** The same grid as a GeoTIFF of strips, cut to half of its bytes. */
    std::string cutTiff(const std::string& name, int columns, int rows) {
        const std::string file = (folder_ / name).string();
        GDALRegister_GTiff();
        GDALRegister_EHdr();
        GDALDataset* from = GDALDataset::Open(grid("from", columns, rows).c_str());
        GDALClose(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(file.c_str(), from, false, nullptr,
                                                                               nullptr, nullptr));
        GDALClose(from);
        return shortened(file);
    }
    types::GeometryPtr about(Bathymetry& floor, glm::dvec3 place) { return floor.about(place, rest_); }
    /** A mosaic of values `spacing` apart, whose south-west value is at an easting and northing; NaN: none. */
    std::string mosaic(const std::string& name, int columns, int rows, double east, double north, double spacing,
                       auto&& value) {
        std::vector<float> values;
        for (int row = rows - 1; row >= 0; --row)
            for (int column = 0; column < columns; ++column) {
                const auto at = static_cast<float>(value(east + spacing * column, north + spacing * row));
                values.push_back(std::isnan(at) ? -9999 : at);
            }
        write(name + ".hdr", fmt::format("ncols {}\nnrows {}\nxllcenter {}\nyllcenter {}\ncellsize {}\nNODATA_value "
                                         "-9999\nbyteorder LSBFIRST\n",
                                         columns, rows, east, north, spacing));
        return write(name + ".flt", {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
    }
    /** Value of a tile's map at a vertex, bilinear: by `getValue(texel)`. */
    static double mapAt(const types::Mesh& mesh, size_t vertex, auto&& getValue) {
        const types::SurfaceMap& map = *mesh.maps.at(0).map;
        const glm::vec2 at = mesh.map_uvs[vertex] * glm::vec2(map.width, map.height) - 0.5f, low = glm::floor(at),
                        share = at - low;
        double sum = 0;
        for (int corner = 0; corner < 4; ++corner) {
            const int x = std::clamp(static_cast<int>(low.x) + (corner & 1), 0, map.width - 1),
                      y = std::clamp(static_cast<int>(low.y) + (corner >> 1), 0, map.height - 1);
            const double weight = (corner & 1 ? share.x : 1 - share.x) * (corner & 2 ? share.y : 1 - share.y);
            if (weight > 1e-4) sum += weight * getValue(map, static_cast<size_t>(y * map.width + x));
        }
        return sum;
    }

    Folder folder_;
    glm::ivec2 hole_{-1};
    BathymetryConfig config_ = [] {
        BathymetryConfig config;
        config.file = "given apart";
        config.easting = 1000;
        config.northing = 5000;
        config.tile = 8;
        config.reach = 20;
        return config;
    }();
    types::GeometryPtr rest_ = [this] {
        Scene scene;
        scene.geometry = std::make_shared<const types::Geometry>();
        Bathymetry::addMaterials(scene, config_);
        return scene.geometry;
    }();
};

/** Positions of all tiles. */
std::vector<glm::vec3> getPositions(const types::Geometry& geometry) {
    std::vector<glm::vec3> positions;
    for (const types::Mesh& mesh : geometry.meshes)
        positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    return positions;
}

TEST_F(BathymetryTest, AFloorFarFromTheOriginHasTheShapeOfOneNearIt) {
    const std::string file = grid("floor", 60, 40);
    const glm::dvec3 place(30, -50, -40), far(6'500'000.0625, 500'000.125, 0);
    Bathymetry near_by(config_, file);
    const types::GeometryPtr here = about(near_by, place);
    config_.northing = *config_.northing - far.x, config_.easting = *config_.easting + far.y;
    Bathymetry far_off(config_, file);
    const types::GeometryPtr there = about(far_off, place + far);
    ASSERT_EQ(here->objects.size(), there->objects.size());
    for (size_t i = 0; i < here->objects.size(); ++i) {
        const auto getWorld = [i](const types::Geometry& geometry, size_t vertex) {
            const types::Object& object = geometry.objects[i];
            const glm::vec3 position = geometry.meshes.at(static_cast<size_t>(object.mesh)).positions.at(vertex);
            EXPECT_LT(glm::length(glm::dvec2(position)), 8192) << "32 bits resolve it";
            return glm::dvec3(object.world_from_object * glm::dvec4(position, 1));
        };
        const size_t count = here->meshes.at(static_cast<size_t>(here->objects[i].mesh)).positions.size();
        ASSERT_EQ(count, there->meshes.at(static_cast<size_t>(there->objects[i].mesh)).positions.size());
        for (size_t vertex = 0; vertex < count; ++vertex)
            ASSERT_LT(glm::distance(getWorld(*there, vertex) - far, getWorld(*here, vertex)), 1e-3);
    }
}

TEST_F(BathymetryTest, PostsAreNorthAndWestOfTheOriginAndFaceUp) {
    Bathymetry floor(config_, grid("floor", 60, 40));
    const types::GeometryPtr geometry = about(floor, {30, -50, -40});
    ASSERT_GT(geometry->objects.size(), 1u);
    EXPECT_EQ(geometry->objects.size(), geometry->meshes.size());
    for (const types::Object& object : geometry->objects) {
        EXPECT_EQ(object.name, "bathymetry");
        EXPECT_TRUE(object.transient);
        const types::Mesh& mesh = geometry->meshes.at(static_cast<size_t>(object.mesh));
        EXPECT_EQ(geometry->materials.at(static_cast<size_t>(mesh.clusters.at(0).material)).name, "bathymetry");
        for (const glm::vec3& p : mesh.positions) EXPECT_NEAR(p.z, elevation(1000 - p.y, 5000 + p.x), 2e-5);
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const glm::vec3 a = mesh.positions[mesh.indices[i]];
            EXPECT_GT(glm::cross(mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a).z,
                      0);
        }
    }
}

TEST_F(BathymetryTest, KeepsMeshesOfTilesAndReadsTheNextTilesAhead) {
    const std::string file = grid("floor", 200, 200);
    Bathymetry floor(config_, file), scout(config_, file);
    types::GeometryPtr before = about(floor, {30, -200, -40});
    int changes = 0;
    for (double way = 30; way < 360; way += 0.5) {
        std::set<types::MeshPtr> known;
        for (size_t i = 0; i < before->meshes.size(); ++i) known.insert(before->meshes.shared(i));
        const std::set<types::MeshPtr> old = known;
        const types::GeometryPtr wanted = about(scout, {way, -200, -40});
        const auto isKnown = [&](const types::Mesh& mesh) {
            return std::ranges::any_of(known, [&](const auto& each) { return each->positions == mesh.positions; });
        };
        for (int waits = 0; waits < 10'000 && !std::ranges::all_of(wanted->meshes, isKnown); ++waits) {
            if (waits > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));  // the worker needs some time
            const auto meshes = floor.ahead();
            known.insert(meshes->begin(), meshes->end());
        }
        const types::GeometryPtr geometry = about(floor, {way, -200, -40});
        size_t same = 0, foreseen = 0, all = geometry->meshes.size();
        for (size_t i = 0; i < all; ++i) {
            same += old.contains(geometry->meshes.shared(i));
            foreseen += known.contains(geometry->meshes.shared(i));
        }
        EXPECT_GE(same, all / 2);
        ASSERT_EQ(foreseen, all) << "no tile is new to those who look ahead, at " << way;
        changes += geometry != before;
        before = geometry;
    }
    EXPECT_GT(changes, 15);
}

TEST_F(BathymetryTest, TheFloorDoesNotDependOnTheVehiclesSpeed) {
    const std::string file = grid("floor", 200, 200);
    for (double step : {0.5, 7.0, 45.0, 170.0}) {
        Bathymetry floor(config_, file);
        for (double way = 30; way < 360; way += step) {
            Bathymetry fresh(config_, file);
            floor.forget();
            const types::GeometryPtr geometry = about(floor, {way, -way, -40});
            ASSERT_EQ(getPositions(*geometry), getPositions(*about(fresh, {way, -way, -40}))) << way;
            if (step < 1) way += 5;
        }
    }
}

TEST_F(BathymetryTest, TheFloorCoversTheReachAndAtMostTwoTilesMore) {
    Bathymetry floor(config_, grid("floor", 200, 200));
    int made = 0;
    types::GeometryPtr before;
    for (double way = 30; way < 360; way += 0.7) {
        const glm::dvec3 place(way, -360 + way, -40);
        const types::GeometryPtr geometry = about(floor, place);
        made += geometry != before;
        before = geometry;
        const types::Extent extent = types::getExtent(*geometry);
        for (int axis : {0, 1}) {
            const glm::dvec2 ends = axis == 0 ? glm::dvec2(0, 398) : glm::dvec2(-398, 0);
            EXPECT_LE(extent.low[axis], std::max(place[axis] - 20, ends.x) + 1e-9);
            EXPECT_GE(extent.high[axis], std::min(place[axis] + 20, ends.y) - 1e-9);
            EXPECT_LE(extent.size()[axis], 40 + 4 * 16) << "two tiles more, and what it is kept for";
        }
    }
    EXPECT_LT(made, 60) << "kept while it reaches far enough";
    EXPECT_GT(made, 10);
}

TEST_F(BathymetryTest, AVehicleThatHoversAtTheEdgeOfATileHasOneFloor) {
    Bathymetry floor(config_, grid("floor", 200, 200));
    for (double way = 30; way < 100; way += 0.5) {
        about(floor, {way, -200, -40});
        const types::GeometryPtr there = about(floor, {way + 0.01, -200, -40});
        for (int i = 0; i < 4; ++i) EXPECT_EQ(about(floor, {way + (i % 2) * 0.01, -200, -40}), there);
    }
}

TEST_F(BathymetryTest, AForgottenFloorFollowsFromThePlaceAlone) {
    Bathymetry floor(config_, grid("floor", 200, 200)), fresh(config_, grid("floor", 200, 200));
    about(floor, {91.5, -200, -40});
    const types::GeometryPtr kept = about(floor, {89.9, -200, -40});
    floor.forget();
    const types::GeometryPtr anew = about(floor, {89.9, -200, -40});
    EXPECT_EQ(getPositions(*anew), getPositions(*about(fresh, {89.9, -200, -40})));
    EXPECT_NE(getPositions(*anew), getPositions(*kept)) << "places chosen so that it matters";
}

TEST_F(BathymetryTest, TheDefaultOriginIsTheMiddleOfTheSurvey) {
    config_.easting = config_.northing = std::nullopt;
    Bathymetry floor(config_, grid("floor", 61, 41));
    config_.easting = 1060, config_.northing = 5040;
    Bathymetry same(config_, grid("floor", 61, 41));
    EXPECT_EQ(getPositions(*about(floor, {0, 0, 0})), getPositions(*about(same, {0, 0, 0})));
}

TEST_F(BathymetryTest, DepthsGoDown) {
    config_.positive_down = true;
    Bathymetry floor(config_, grid("floor", 30, 30));
    for (const glm::vec3& p : getPositions(*about(floor, {20, -20, 0})))
        EXPECT_NEAR(p.z, -elevation(1000 - p.y, 5000 + p.x), 2e-5);
}

TEST_F(BathymetryTest, UnsurveyedPostsAreAHole) {
    const std::string whole = grid("whole", 30, 30);
    hole_ = {10, 12};
    const std::string pierced = grid("pierced", 30, 30);
    Bathymetry floor(config_, whole), rest(config_, pierced);
    const auto triangles = [&](Bathymetry& of) { return about(of, {24, -20, 0})->triangleCount(); };
    EXPECT_EQ(triangles(floor) - triangles(rest), 6u) << "those about one post";
    types::Snapshot snapshot;
    snapshot.geometry = about(rest, {24, -20, 0});
    EXPECT_GE(types::nearestPoint(snapshot, {24, -20, -49.8}).distance, 1);
}

TEST_F(BathymetryTest, TheFilesOfAMosaicAreOneFloor) {
    grid("west", 30, 40);
    grid("east", 30, 40, 30);
    std::string sources;
    for (const auto& [name, column] : {std::pair("west", 0), std::pair("east", 30)})
        sources += fmt::format(
            "<SimpleSource><SourceFilename relativeToVRT=\"1\">{}.flt</SourceFilename><SourceBand>1"
            "</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"30\" ySize=\"40\"/><DstRect xOff=\"{}\" "
            "yOff=\"0\" xSize=\"30\" ySize=\"40\"/></SimpleSource>",
            name, column);
    const std::string mosaic =
        write("mosaic.vrt",
              "<VRTDataset rasterXSize=\"60\" rasterYSize=\"40\"><GeoTransform>999, 2, 0, 5079, 0, -2"
              "</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\">" +
                  sources + "</VRTRasterBand></VRTDataset>");
    Bathymetry floor(config_, grid("whole", 60, 40)), tiled(config_, mosaic);
    EXPECT_EQ(getPositions(*about(tiled, {40, -60, 0})), getPositions(*about(floor, {40, -60, 0})));
    // A mosaic whose tiles are elsewhere could show any file.
    fs::create_directory(folder_ / "apart");
    const std::vector<char> bytes = toBytes(mosaic);
    std::string text(bytes.begin(), bytes.end());
    for (const char* tile : {"\">west", "\">east"}) text.insert(text.find(tile) + 2, "../");
    EXPECT_THAT(test::refused([&] { Bathymetry(config_, write("apart/mosaic.vrt", text)); }),
                testing::Contains(HasSubstr("which is outside of its folder")));
}

TEST_F(BathymetryTest, AMosaicIsPlacedByItsMapOnAnyGrid) {
    config_.map.emplace();
    config_.map->file = "given apart";
    config_.map->meaning.decibels = {-60, 0};
    config_.map->meaning.values = {-60, 0};
    const auto levelAt = [](double east, double north) { return -40 + 0.05 * (east - 1000) + 0.1 * (north - 5000); };
    struct Grid {
        double east, north, spacing;
    };
    for (const Grid& g : {Grid{995, 4990, 0.5}, {1000, 5000, 2}, {990.3, 4993.7, 0.7}, {980, 4980, 5}}) {
        const std::string file = mosaic("levels", static_cast<int>(150 / g.spacing), static_cast<int>(120 / g.spacing),
                                        g.east, g.north, g.spacing, levelAt);
        Bathymetry floor(config_, grid("floor", 60, 40), file);
        const types::GeometryPtr geometry = about(floor, {30, -50, -40});
        ASSERT_GT(geometry->meshes.size(), 1u);
        double worst = 0;
        for (const types::Mesh& mesh : geometry->meshes) {
            ASSERT_EQ(mesh.maps.size(), 1u);
            ASSERT_EQ(mesh.map_uvs.size(), mesh.positions.size());
            for (size_t i = 0; i < mesh.positions.size(); ++i) {
                const glm::vec3& p = mesh.positions[i];
                const double decibels = mapAt(mesh, i, [](const auto& map, size_t texel) {
                    return 10 * std::log10(static_cast<double>(map.strengths.at(texel)));
                });
                worst = std::max(worst, std::abs(decibels - levelAt(1000 - p.y, 5000 + p.x)));
            }
        }
        EXPECT_LT(worst, 0.01) << g.spacing;
    }
}

TEST_F(BathymetryTest, AMosaicOfClassesSetsMaterialsWhereItHasValues) {
    config_.map.emplace();
    config_.map->file = "given apart";
    config_.map->meaning.classes = {{"3", "rock"}, {"7", "clay"}};
    rest_ = [&] {
        Scene scene;
        scene.geometry = std::make_shared<const types::Geometry>();
        Bathymetry::addMaterials(scene, config_);
        return scene.geometry;
    }();
    EXPECT_EQ(rest_->materials.at(0).max_map_strength, 1);
    const std::string file = mosaic("classes", 60, 80, 1000, 5000, 1, [](double east, double) {
        return east < 1020 ? 3 : east < 1040 ? 7 : NAN;  // and it ends at 1059
    });
    Bathymetry floor(config_, grid("floor", 60, 40), file);
    std::map<std::string, int> seen;
    for (const types::Mesh& mesh : about(floor, {30, -50, -40})->meshes)
        for (size_t i = 0; i < mesh.positions.size(); ++i) {
            const double east = 1000 - mesh.positions[i].y, north = 5000 + mesh.positions[i].x;
            if (std::abs(east - 1020) < 2 || std::abs(east - 1040) < 2 || north > 5078) continue;
            if (mesh.maps.empty()) {
                EXPECT_GT(east, 1058);
                continue;
            }
            const double number = mapAt(
                mesh, i, [](const auto& map, size_t texel) { return static_cast<double>(map.classes.at(texel)); });
            const int material =
                number == types::SurfaceMap::no_class ? 0 : mesh.maps[0].map->materials.at(static_cast<size_t>(number));
            const std::string& name = rest_->materials.at(static_cast<size_t>(material)).name;
            EXPECT_EQ(name, east < 1020 ? "rock" : east < 1040 ? "clay" : "bathymetry") << east;
            ++seen[name];
        }
    EXPECT_EQ(seen.size(), 3u);
}

TEST_F(BathymetryTest, AWrongMosaicIsReportedAtItsKey) {
    SceneConfig config;
    config.bathymetry = config_;
    config.bathymetry->file = grid("floor", 30, 30);
    MosaicConfig& map = config.bathymetry->map.emplace();
    map.file = "none.tif";
    map.meaning.classes = {{"1", "rock"}};
    const auto refusals = [&] {
        SceneTask task("scene");
        task.config.set(config);
        return test::countRefusals(task);
    };
    EXPECT_THAT(refusals(),
                testing::Contains(testing::AllOf(HasSubstr("bathymetry.map.file"), HasSubstr("is not there"))));
    map.file = mosaic("fine", 2000, 20, 1000, 5000, 0.001, [](double, double) { return 1; });
    EXPECT_THAT(refusals(), testing::Contains(HasSubstr("values on a tile of the survey; at most 4096 a side")));
    map.file = mosaic("classes", 30, 30, 1000, 5000, 2, [](double, double) { return 1; });
    EXPECT_THAT(refusals(), testing::IsEmpty());
    map.meaning.classes = {{"1", "rok"}};
    EXPECT_THAT(refusals(), testing::Contains(HasSubstr("bathymetry.map.classes.1: is rok; did you mean rock?")));
}

TEST_F(BathymetryTest, OutsideOfTheSurveyThereIsTheSceneAlone) {
    Bathymetry floor(config_, grid("floor", 30, 30));
    for (const glm::dvec3& place : {glm::dvec3(-1e3, 0, 0), glm::dvec3(1e300, -1e300, 0), glm::dvec3(0, 1e6, 0)})
        EXPECT_TRUE(about(floor, place)->objects.empty());
    EXPECT_FALSE(about(floor, {20, -20, 0})->objects.empty()) << "and it is there again";
}

TEST_F(BathymetryTest, FilesThatAreNoSurveyAreRefused) {
    write("degrees.prj", R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
                         R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]])");
    const std::string vrt =
        "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\">%<VRTRasterBand dataType=\"Float32\" band=\"1\"/>"
        "</VRTDataset>";
    const auto with = [&](const std::string& transform) {
        return std::string(vrt).replace(vrt.find('%'), 1, transform);
    };
    std::string in_feet = with("<GeoTransform>0, 2, 0, 0, 0, -2</GeoTransform>");
    in_feet.replace(in_feet.find("/></VRT"), 2, "><UnitType>ft</UnitType></VRTRasterBand>");
    struct Case {
        std::string file, words;
        int band = 1;
        double reach = 20;
    };
    for (const Case& c :
         {Case{(folder_ / "none.tif").string(), "is not there"}, Case{folder_.path().string(), "may be GeoTIFF"},
          Case{write("text.txt", "a text"), "supported file format.); may be GeoTIFF"},
          Case{write("empty.tif", ""), "may be GeoTIFF, BAG"},
          Case{grid("degrees", 9, 9), "or project it to metres: gdalwarp"},
          Case{write("nowhere.vrt", with("")), "has no place on the map"},
          Case{shortened(grid("short", 9, 9)), "ends too early: has 162 of 324 bytes"},
          Case{write("turned.vrt", with("<GeoTransform>0, 2, 0.1, 0, 0.1, -2</GeoTransform>")),
               "is rotated against north"},
          Case{write("flat.vrt", with("<GeoTransform>0, 0, 0, 0, 0, -2</GeoTransform>")), "posts 0 m and -2 m apart"},
          Case{write("feet.vrt", in_feet), "has elevations in ft; may be metres"},
          Case{grid("one", 9, 9), "has 1 bands, but no band 2", 2},
          Case{grid("fine", 9, 9), "at most 4096: lower reach", 1, 5000}}) {
        BathymetryConfig config = config_;
        config.band = c.band;
        config.reach = c.reach;
        EXPECT_THAT([&] { Bathymetry(config, c.file); }, testing::ThrowsMessage<types::ConfigError>(HasSubstr(c.words)))
            << c.file;
    }
}

TEST_F(BathymetryTest, AFileThatEndsTooEarlyIsAnErrorOfTheTaskAndTheRunContinues) {
    SceneConfig config;
    config.bathymetry = config_;
    config.bathymetry->file = cutTiff("short.tif", 200, 200);
    SceneTask task("scene");
    test::Writer<types::Pose> vehicle("vehicle");
    test::Reader<types::SnapshotPtr> out;
    vehicle.port.connectTo(task.pose, framework::ConnPolicy::data());
    task.snapshot.connectTo(out.port, framework::ConnPolicy::buffer(8));
    task.config.set(config);
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const auto snapshotAt = [&](double north) {
        types::Pose pose;
        pose.position = {north, -200, -10};
        vehicle.port.write(pose);
        task.update();
        types::SnapshotPtr snapshot;
        return out.port.readNew(snapshot) ? snapshot : nullptr;
    };
    EXPECT_FALSE(snapshotAt(100)) << "rows that the file lacks";
    EXPECT_EQ(task.state(), framework::TaskState::RunTimeError);
    EXPECT_THAT(task.lastError(), HasSubstr("short.tif cannot be read any further; GDAL: "));
    const types::SnapshotPtr there = snapshotAt(300);
    ASSERT_TRUE(there);
    EXPECT_FALSE(there->geometry->objects.empty());
    EXPECT_EQ(task.state(), framework::TaskState::Running);
}

TEST_F(BathymetryTest, TheFloorHasTheConfiguredMaterialAndAWrongNameIsReported) {
    SceneConfig config;
    config.bathymetry = config_;
    config.bathymetry->file = grid("floor", 30, 30);
    config.materials["bathymetry"].lambert_db = -27;
    SceneTask task("scene");
    task.config.set(config);
    EXPECT_THAT(test::countRefusals(task), testing::IsEmpty());
    config.materials["bathimetry"].lambert_db = -20;
    task.config.set(config);
    EXPECT_THAT(test::countRefusals(task), testing::ElementsAre(HasSubstr("did you mean bathymetry?")));
}

}  // namespace
}  // namespace insonify::survey
