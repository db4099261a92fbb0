#include "components/log/Export.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>
#include <tuple>
#include <type_traits>
#include <vector>

#include "components/log/NpzFile.hpp"
#include "components/log/Reader.hpp"
#include "components/log/TypeNames.hpp"
#include "types/geometry/WorldFrame.hpp"

namespace insonify::log {
namespace {

using Path = std::filesystem::path;
using types::DepthMap;
using types::Image;
using types::PointCloud;
using types::Sonar;

/** Consecutive samples of one shape. */
struct Run {
    std::vector<size_t> shape;
    std::vector<SampleRef> samples;

    /** Shape of all samples together. */
    std::vector<size_t> whole() const {
        std::vector<size_t> all = shape;
        all.insert(all.begin(), samples.size());
        return all;
    }
};

template <types::Arrayed T>
std::vector<size_t> getShape(const T& sample) {
    return sample.shape();
}
std::vector<size_t> getShape(const Sonar& ping) { return {ping.beam_count, ping.bin_count}; }
std::vector<size_t> getShape(const Image& picture) {
    return {picture.size.height, picture.size.width, picture.pixel_size};
}
std::vector<size_t> getShape(const DepthMap& map) { return {map.vertical_size, map.horizontal_size}; }

void readShaped(Reader& log, const SampleRef& at, Sonar& ping) { readPing(log, at, ping); }
void readShaped(Reader& log, const SampleRef& at, Image& picture) {
    log.read(at, picture);
    if (!picture.holdsPixels())
        throw types::ConfigError(log.path(), log.streams()[at.stream].name,
                                 "a picture is compressed or has other numbers of pixels than it says");
}

template <types::Arrayed T>
void readShaped(Reader& log, const SampleRef& at, T& sample) {
    log.read(at, sample);
    if (const char* diagnostic = sample.diagnostic())
        throw types::ConfigError(log.path(), log.streams()[at.stream].name, std::string("a sample ") + diagnostic);
}

void readShaped(Reader& log, const SampleRef& at, DepthMap& map) {
    log.read(at, map);
    if (const char* const diagnostic = map.diagnostic())
        throw types::ConfigError(log.path(), log.streams()[at.stream].name, std::string("a map ") + diagnostic);
    map.remissions.resize(map.distances.size());
}

template <class T>
std::vector<Run> runsOfOneShape(Reader& log, const std::string& stream) {
    std::vector<Run> runs;
    T sample;
    log.forEachRef(stream, [&](const SampleRef& at) {
        readShaped(log, at, sample);
        if (runs.empty() || runs.back().shape != getShape(sample)) runs.push_back({getShape(sample), {}});
        runs.back().samples.push_back(at);
    });
    if (runs.empty()) runs.push_back({getShape(T{}), {}});
    return runs;
}

void writeRun(Reader& log, const Run& run, NpzFile& npz, Sonar ping) {
    const size_t count = run.samples.size();
    std::vector<double> bearings, time, bin_duration, speed_of_sound;
    std::vector<float> range;
    npz.begin("bins", numpyType<float>(), run.whole());
    for (const SampleRef& at : run.samples) {
        readPing(log, at, ping);
        npz.append(ping.bins.data(), ping.bins.size() * sizeof(float));
        for (const types::Angle& bearing : ping.bearings) bearings.push_back(bearing.rad);
        time.push_back(ping.time.seconds());
        bin_duration.push_back(ping.binSeconds());
        speed_of_sound.push_back(static_cast<double>(ping.speed_of_sound));
        for (uint32_t k = 0; k < ping.bin_count; ++k) range.push_back(static_cast<float>(ping.binStart(k + 0.5)));
    }
    npz.end();
    npz.array("bearings", {count, run.shape[0]}, bearings);
    npz.array("time", {count}, time);
    npz.array("bin_duration", {count}, bin_duration);
    npz.array("speed_of_sound", {count}, speed_of_sound);
    npz.array("range_m", {count, run.shape[1]}, range);
}

/** Writes time and bearings; for samples of bins also their ranges and the names of the first sample's objects, for
 *  travel times the speed of sound. */
template <types::Arrayed T>
void writeGrid(Reader& log, const Run& run, NpzFile& npz, T sample) {
    constexpr bool has_travel_times = std::is_same_v<T, types::SonarDetections>;
    std::vector<double> time, bearings, speed_of_sound;
    std::vector<float> range;
    std::vector<std::string> objects;
    for (const SampleRef& at : run.samples) {
        log.read(at, sample);
        time.push_back(sampleTime(sample, at.time).seconds());
        for (const types::Angle& bearing : sample.bearings) bearings.push_back(bearing.rad);
        if constexpr (has_travel_times) speed_of_sound.push_back(static_cast<double>(sample.speed_of_sound));
        if constexpr (types::NamesObjects<T>) {
            if (objects.empty()) objects = sample.objects;
            for (uint32_t k = 0; k < sample.bin_count; ++k)
                range.push_back(static_cast<float>(sample.binStart(k + 0.5)));
        }
    }
    const size_t count = run.samples.size();
    npz.array("time", {count}, time);
    npz.array("bearings", {count, run.shape[0]}, bearings);
    if constexpr (has_travel_times) npz.array("speed_of_sound", {count}, speed_of_sound);
    if constexpr (types::NamesObjects<T>) {
        npz.array("range_m", {count, run.shape[1]}, range);
        npz.texts("objects", objects);
    }
}

/** Writes, for signals of elements, time, the positions of elements and samples, and the wavelength and speed of
 *  sound. */
void writeGrid(Reader& log, const Run& run, NpzFile& npz, types::SonarElements sample) {
    std::vector<double> time, positions, weights, wavelength, speed_of_sound, range;
    for (const SampleRef& at : run.samples) {
        log.read(at, sample);
        time.push_back(sampleTime(sample, at.time).seconds());
        positions.insert(positions.end(), sample.positions.begin(), sample.positions.end());
        weights.insert(weights.end(), sample.weights.begin(), sample.weights.end());
        wavelength.push_back(sample.wavelength);
        speed_of_sound.push_back(sample.speed_of_sound);
        for (size_t i = 0; i < sample.sample_count; ++i) range.push_back(sample.range(i));
    }
    const size_t count = run.samples.size();
    npz.array("time", {count}, time);
    npz.array("positions", {count, run.shape[0]}, positions);
    npz.array("weights", {count, run.shape[0]}, weights);
    npz.array("wavelength", {count}, wavelength);
    npz.array("speed_of_sound", {count}, speed_of_sound);
    npz.array("range_m", {count, run.shape[1]}, range);
}

template <types::Arrayed T>
void writeRun(Reader& log, const Run& run, NpzFile& npz, T sample) {
    writeGrid(log, run, npz, T{});
    const T names;
    T::forEachArray(names, [&]<class Number>(const std::string& wanted, const auto&, std::type_identity<Number>) {
        npz.begin(wanted, numpyType<Number>(), run.whole());
        for (const SampleRef& at : run.samples) {
            log.read(at, sample);
            T::forEachArray(sample, [&](const std::string& name, const auto& numbers, auto) {
                if (name == wanted) npz.append(numbers.data(), numbers.size() * sizeof(numbers[0]));
            });
        }
        npz.end();
    });
}

void writeRun(Reader& log, const Run& run, NpzFile& npz, Image picture) {
    std::vector<double> time;
    npz.begin("pixels", numpyType<uint8_t>(), run.whole());
    for (const SampleRef& at : run.samples) {
        log.read(at, picture);
        for (size_t row = 0; row < picture.size.height; ++row)
            npz.append(picture.image.data() + row * picture.row_size, size_t{picture.size.width} * picture.pixel_size);
        time.push_back(sampleTime(picture, at.time).seconds());
    }
    npz.end();
    npz.array("time", {time.size()}, time);
}

void writeRun(Reader& log, const Run& run, NpzFile& npz, DepthMap map) {
    std::vector<float> remissions;
    std::vector<double> time, vertical, horizontal;
    npz.begin("distances", numpyType<float>(), run.whole());
    for (const SampleRef& at : run.samples) {
        readShaped(log, at, map);
        npz.append(map.distances.data(), map.distances.size() * sizeof(float));
        remissions.insert(remissions.end(), map.remissions.begin(), map.remissions.end());
        time.push_back(sampleTime(map, at.time).seconds());
        vertical = map.vertical_interval, horizontal = map.horizontal_interval;
    }
    npz.end();
    npz.array("remissions", run.whole(), remissions);
    npz.array("time", {time.size()}, time);
    npz.array("vertical_interval", {vertical.size()}, vertical);
    npz.array("horizontal_interval", {horizontal.size()}, horizontal);
}

/** Writes all points one after the other, each with its time. */
void writePoints(Reader& log, const std::string& stream, NpzFile& npz) {
    std::vector<double> time, points, intensity;
    log.forEach<PointCloud>(stream, [&](const PointCloud& cloud, const SampleRef& at) {
        for (size_t k = 0; k < cloud.points.size(); ++k) {
            const glm::dvec3& p = cloud.points[k];
            time.push_back(sampleTime(cloud, at.time).seconds());
            points.insert(points.end(), {p.x, p.y, p.z});
            intensity.push_back(cloud.intensity(k));
        }
    });
    npz.array("time", {time.size()}, time);
    npz.array("points", {time.size(), 3}, points);
    npz.array("intensity", {time.size()}, intensity);
}

/** Writes one text; nothing if it is empty. */
void writeMeta(NpzFile& npz, const std::string& meta) {
    if (!meta.empty()) npz.text("meta", meta);
}

std::vector<Path> writeCloud(Reader& log, const std::string& stream, const Path& path, const std::string& meta) {
    NpzFile npz(path);
    writePoints(log, stream, npz);
    writeMeta(npz, meta);
    npz.close();
    return {path};
}

template <class T>
std::vector<Path> writeRuns(Reader& log, const std::string& stream, const Path& path, const std::string& meta) {
    const std::vector<Run> runs = runsOfOneShape<T>(log, stream);
    std::vector<Path> files;
    for (const Run& run : runs) {
        Path file = path;
        if (runs.size() > 1) file.replace_extension("." + std::to_string(files.size()) + path.extension().string());
        NpzFile npz(file);
        writeRun(log, run, npz, T{});
        writeMeta(npz, meta);
        npz.close();
        files.push_back(file);
    }
    return files;
}

/** The arrays of samples in tables: those of types::Columns, and the velocities of a stream of poses if one of them
 *  states a velocity. */
template <class T>
class TableArrays {
public:
    TableArrays(Reader& log, const std::string& stream) {
        if constexpr (std::is_same_v<T, types::Pose>)
            log.forEach<T>(stream, [this](const T& pose, const SampleRef&) {
                const auto& [v, w] = std::tie(pose.velocity, pose.angular_velocity);
                for (const double each : {v.x, v.y, v.z, w.x, w.y, w.z}) has_velocity_ |= !std::isnan(each);
            });
    }
    void forEach(const T& sample, auto&& visit) const {
        types::Columns<T>::forEach(sample, visit);
        if constexpr (std::is_same_v<T, types::Pose>)
            if (has_velocity_) {
                const auto& [v, w] = std::tie(sample.velocity, sample.angular_velocity);
                visit("velocity", std::array{"vx", "vy", "vz"}, std::array{v.x, v.y, v.z});
                visit("angular_velocity", std::array{"wx", "wy", "wz"}, std::array{w.x, w.y, w.z});
            }
    }

private:
    bool has_velocity_ = false;
};

template <class T>
void writeRows(Reader& log, const std::string& stream, const Path& path, const std::string& meta) {
    std::vector<double> time;
    std::vector<std::vector<double>> arrays;
    const TableArrays<T> table(log, stream);
    log.forEach<T>(stream, [&](const T& sample, const SampleRef& at) {
        time.push_back(sampleTime(sample, at.time).seconds());
        table.forEach(sample, [&, i = size_t{0}](const char*, const auto&, const auto& numbers) mutable {
            if (i == arrays.size()) arrays.emplace_back();
            arrays[i].insert(arrays[i].end(), numbers.begin(), numbers.end());
            ++i;
        });
    });
    NpzFile npz(path);
    npz.array("time", {time.size()}, time);
    table.forEach(T{}, [&, i = size_t{0}](const char* name, const auto& names, const auto&) mutable {
        arrays.resize(std::max(arrays.size(), i + 1));
        npz.array(name, {time.size(), names.size()}, arrays[i++]);
    });
    writeMeta(npz, meta);
    npz.close();
}

void writeValue(NpzFile& npz, const std::vector<std::string>& texts) { npz.texts("value", texts); }
template <class Number>
void writeValue(NpzFile& npz, const std::vector<Number>& numbers) {
    npz.array("value", {numbers.size()}, numbers);
}

template <class T>
auto getValue(const T& sample) {
    if constexpr (types::Scalar<T>)
        return types::getNumber(sample);
    else
        return sample;
}

template <class T>
void writeValues(Reader& log, const std::string& stream, const Path& path, const std::string& meta) {
    std::vector<double> time;
    std::vector<decltype(getValue(T{}))> values;
    log.forEach<T>(stream, [&](const T& sample, const SampleRef& at) {
        time.push_back(at.time.seconds());
        values.push_back(getValue(sample));
    });
    NpzFile npz(path);
    npz.array("time", {time.size()}, time);
    writeValue(npz, values);
    writeMeta(npz, meta);
    npz.close();
}

using types::Sonar;

/** A text file written by lines; close() throws std::runtime_error when a line is missing. */
class CsvFile {
public:
    CsvFile(const std::filesystem::path& path, const std::string& header) : path_(path), file_(path) {
        if (!file_) throw types::ConfigError(path, "", "cannot be written: " + std::generic_category().message(errno));
        file_ << header << '\n';
    }
    /** Writes a line of numbers, each in its shortest exact form; times with six decimals. */
    template <class... Values>
    void line(types::Time time, const Values&... values) {
        text_.clear();
        fmt::format_to(std::back_inserter(text_), "{:.6f}", time.seconds());
        (fmt::format_to(std::back_inserter(text_), ",{}", values), ...);
        text_.push_back('\n');
        file_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    }
    void close() {
        file_.close();
        if (!file_) throw std::runtime_error(path_.string() + ": cannot be written: the disk may be full");
    }

private:
    std::filesystem::path path_;
    std::ofstream file_;
    fmt::memory_buffer text_;
};

void writePing(CsvFile& csv, const Sonar& ping) {
    for (size_t beam = 0; beam < ping.beam_count; ++beam)
        for (size_t bin = 0; bin < ping.bin_count; ++bin)
            csv.line(ping.time, beam, ping.bearings[beam].rad, bin, ping.bins[beam * ping.bin_count + bin]);
}

void writePings(Reader& log, const std::string& stream, const std::filesystem::path& path) {
    CsvFile csv(path, "time,beam,bearing,bin,value");
    Sonar ping;
    log.forEachRef(stream, [&](const SampleRef& at) {
        readPing(log, at, ping);
        writePing(csv, ping);
    });
    csv.close();
}

/** Returns the place of a row of a sample: the bearing of a beam, the position of an element. */
template <types::Arrayed T>
double rowPlace(const T& sample, size_t row) {
    return sample.bearings[row].rad;
}
double rowPlace(const types::SonarElements& signals, size_t row) { return signals.positions[row]; }

/** Returns the columns with the indices of a sample's numbers. */
template <types::Arrayed T>
const char* placeColumns(const T& sample) {
    return sample.shape().size() == 2 ? "time,beam,bearing,bin" : "time,beam,bearing";
}
const char* placeColumns(const types::SonarElements&) { return "time,element,position,sample"; }

/** Writes a line for each bin, or for each beam if there is one number per beam. */
template <types::Arrayed T>
void writeGrids(Reader& log, const std::string& stream, const std::filesystem::path& path) {
    std::string header = placeColumns(T{});
    const T names;
    T::forEachArray(names, [&](const char* name, const auto&, auto) { header += std::string(",") + name; });
    CsvFile csv(path, header);
    log.forEach<T>(stream, [&](const T& sample, const SampleRef& at) {
        if (const char* diagnostic = sample.diagnostic())
            throw types::ConfigError(log.path(), stream, std::string("a sample ") + diagnostic);
        const std::vector<size_t> shape = sample.shape();
        const size_t bins = shape.size() == 2 ? shape[1] : 1;
        for (size_t i = 0; i < shape[0] * bins; ++i) {
            std::string row = fmt::format("{},{}", i / bins, rowPlace(sample, i / bins));
            if (shape.size() == 2) row += fmt::format(",{}", i % bins);
            T::forEachArray(sample,
                            [&](const char*, const auto& numbers, auto) { row += fmt::format(",{}", numbers[i]); });
            csv.line(sampleTime(sample, at.time), row);
        }
    });
    csv.close();
}

/** Returns the columns of a point that has these in the world, with a comma before each. */
std::string onEarth(const EarthColumns& earth, const glm::dvec3& point) {
    const types::Datum at = geodetic(earth.datum, types::Axes{types::WorldFrame::Enu}.worldFromRock(point));
    if (!earth.on_grid) return fmt::format(",{},{},{}", at.latitude_deg, at.longitude_deg, at.height_m);
    const types::GridPlace on_map = gridPlace(earth.datum, at);
    return fmt::format(",{},{},{},{}", on_map.easting, on_map.northing, at.height_m, on_map.epsg);
}

/** Writes a line for each point, or for each cell. */
void writePart(CsvFile& csv, const types::PointCloud& cloud, types::Time time,
               const std::optional<EarthColumns>& earth) {
    for (size_t k = 0; k < cloud.points.size(); ++k) {
        const glm::dvec3& p = cloud.points[k];
        csv.line(time, p.x, p.y, p.z, fmt::format("{}{}", cloud.intensity(k), earth ? onEarth(*earth, p) : ""));
    }
}
void writePart(CsvFile& csv, const types::DepthMap& map, types::Time time, const std::optional<EarthColumns>&) {
    for (size_t cell = 0; cell < map.distances.size(); ++cell)
        csv.line(time, cell / map.horizontal_size, cell % map.horizontal_size, map.distances[cell],
                 map.remissions.empty() ? 0 : map.remissions[cell]);
}

template <class T>
void writeParts(Reader& log, const std::string& stream, const std::filesystem::path& path, const std::string& header,
                const std::optional<EarthColumns>& earth = {}) {
    CsvFile csv(path, header);
    log.forEach<T>(stream, [&](const T& sample, const SampleRef& at) {
        writePart(csv, sample, sampleTime(sample, at.time), earth);
    });
    csv.close();
}

/** Returns a text in quotes, with its quotes doubled. */
std::string quoteCsv(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string(2, c) : std::string(1, c);
    return result + '"';
}

template <class T>
void writeValues(Reader& log, const std::string& stream, const std::filesystem::path& path) {
    CsvFile csv(path, "time,value");
    log.forEach<T>(stream, [&](const T& value, const SampleRef& at) {
        if constexpr (Text<T>)
            csv.line(at.time, quoteCsv(value));
        else
            csv.line(at.time, types::getNumber(value));
    });
    csv.close();
}

template <class T>
void writeRows(Reader& log, const std::string& stream, const std::filesystem::path& path) {
    const TableArrays<T> table(log, stream);
    std::string header = "time";
    table.forEach(T{}, [&](const char*, const auto& names, const auto&) {
        for (const char* name : names) header += std::string(",") + name;
    });
    CsvFile csv(path, header);
    std::vector<double> row;
    log.forEach<T>(stream, [&](const T& sample, const SampleRef& at) {
        row.clear();
        table.forEach(sample, [&](const char*, const auto&, const auto& numbers) {
            row.insert(row.end(), numbers.begin(), numbers.end());
        });
        csv.line(sampleTime(sample, at.time), fmt::format("{}", fmt::join(row, ",")));
    });
    csv.close();
}

/** Calls `write` with the type of a stream's samples. Returns false where samples of the type are not written. */
bool writeByType(const Stream& declared, const auto& write) {
    bool done = false;
    types::forEachSampleType([&]<class T>(std::type_identity<T> type) {
        if constexpr (types::Arrayed<T> || types::Tabular<T> || types::Scalar<T> || Text<T>)
            if (declared.holds<T>()) write(type), done = true;
    });
    return done;
}

}  // namespace

std::vector<Path> exportNpz(Reader& log, const std::string& stream, const Path& path, const std::string& meta) {
    const Stream& declared = log.streams()[log.findIndex(stream)];
    if (holdsPings(declared)) return writeRuns<Sonar>(log, stream, path, meta);
    if (declared.holds<Image>()) return writeRuns<Image>(log, stream, path, meta);
    if (declared.holds<DepthMap>()) return writeRuns<DepthMap>(log, stream, path, meta);
    if (declared.holds<PointCloud>()) return writeCloud(log, stream, path, meta);
    std::vector<Path> files{path};
    const auto write = [&]<class T>(std::type_identity<T>) {
        if constexpr (types::Arrayed<T>)
            files = writeRuns<T>(log, stream, path, meta);
        else if constexpr (types::Tabular<T>)
            writeRows<T>(log, stream, path, meta);
        else
            writeValues<T>(log, stream, path, meta);
    };
    if (!writeByType(declared, write))
        throw types::ConfigError(
            log.path(), stream,
            "holds " + declared.type +
                "; streams that can be arrays: pings, beams and scans of sonars, truth, returns "
                "and elements of pings, points, maps of distances, ranges, poses, readings of navigation's sensors, "
                "pictures, numbers and texts");
    return files;
}

void exportCsv(Reader& log, const std::string& stream, const std::filesystem::path& path,
               const std::optional<EarthColumns>& earth) {
    const Stream& declared = log.streams()[log.findIndex(stream)];
    if (holdsPings(declared)) return writePings(log, stream, path);
    if (declared.holds<types::PointCloud>())
        return writeParts<types::PointCloud>(
            log, stream, path,
            std::string("time,x,y,z,intensity") + (!earth           ? ""
                                                   : earth->on_grid ? ",easting,northing,height_m,epsg"
                                                                    : ",latitude_deg,longitude_deg,height_m"),
            earth);
    if (declared.holds<types::DepthMap>())
        return writeParts<types::DepthMap>(log, stream, path, "time,row,column,distance,remission");
    const auto write = [&]<class T>(std::type_identity<T>) {
        if constexpr (types::Arrayed<T>)
            writeGrids<T>(log, stream, path);
        else if constexpr (types::Tabular<T>)
            writeRows<T>(log, stream, path);
        else
            writeValues<T>(log, stream, path);
    };
    if (!writeByType(declared, write))
        throw types::ConfigError(
            log.path(), stream,
            "holds " + declared.type +
                "; streams that can be text: pings, beams and scans of sonars, truth, returns and "
                "elements of pings, points, maps of distances, ranges, poses, readings of navigation's "
                "sensors, numbers and texts "
                "(pictures: .png and .npz)");
}

}  // namespace insonify::log
