#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

#include "components/log/Export.hpp"
#include "components/log/Reader.hpp"
#include "components/log/TypeNames.hpp"

namespace insonify::log {
namespace {

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

/** Writes a line for each point, or for each cell. */
void writePart(CsvFile& csv, const types::PointCloud& cloud, types::Time time) {
    for (size_t k = 0; k < cloud.points.size(); ++k)
        csv.line(time, cloud.points[k].x, cloud.points[k].y, cloud.points[k].z, cloud.intensity(k));
}
void writePart(CsvFile& csv, const types::DepthMap& map, types::Time time) {
    for (size_t cell = 0; cell < map.distances.size(); ++cell)
        csv.line(time, cell / map.horizontal_size, cell % map.horizontal_size, map.distances[cell],
                 map.remissions.empty() ? 0 : map.remissions[cell]);
}

template <class T>
void writeParts(Reader& log, const std::string& stream, const std::filesystem::path& path, const char* header) {
    CsvFile csv(path, header);
    log.forEach<T>(stream,
                   [&](const T& sample, const SampleRef& at) { writePart(csv, sample, sampleTime(sample, at.time)); });
    csv.close();
}

/** Returns a text in quotes, with its quotes doubled. */
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string(2, c) : std::string(1, c);
    return result + '"';
}

template <class T>
void writeValues(Reader& log, const std::string& stream, const std::filesystem::path& path) {
    CsvFile csv(path, "time,value");
    log.forEach<T>(stream, [&](const T& value, const SampleRef& at) {
        if constexpr (Text<T>)
            csv.line(at.time, quoted(value));
        else
            csv.line(at.time, types::numberOf(value));
    });
    csv.close();
}

template <class T>
void writeRows(Reader& log, const std::string& stream, const std::filesystem::path& path) {
    std::string header = "time";
    types::Columns<T>::forEach(T{}, [&](const char*, const auto& names, const auto&) {
        for (const char* name : names) header += std::string(",") + name;
    });
    CsvFile csv(path, header);
    std::vector<double> row;
    log.forEach<T>(stream, [&](const T& sample, const SampleRef& at) {
        row.clear();
        types::Columns<T>::forEach(sample, [&](const char*, const auto&, const auto& numbers) {
            row.insert(row.end(), numbers.begin(), numbers.end());
        });
        csv.line(sampleTime(sample, at.time), fmt::format("{}", fmt::join(row, ",")));
    });
    csv.close();
}

}  // namespace

void exportCsv(Reader& log, const std::string& stream, const std::filesystem::path& path) {
    const Stream& declared = log.streams()[log.indexOf(stream)];
    if (holdsPings(declared)) return writePings(log, stream, path);
    if (declared.holds<types::PointCloud>())
        return writeParts<types::PointCloud>(log, stream, path, "time,x,y,z,intensity");
    if (declared.holds<types::DepthMap>())
        return writeParts<types::DepthMap>(log, stream, path, "time,row,column,distance,remission");
    bool done = false;
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (!declared.holds<T>()) return;
        if constexpr (types::Arrayed<T>)
            writeGrids<T>(log, stream, path);
        else if constexpr (types::Tabular<T>)
            writeRows<T>(log, stream, path);
        else if constexpr (types::Scalar<T> || Text<T>)
            writeValues<T>(log, stream, path);
        else
            return;
        done = true;
    });
    if (!done)
        throw types::ConfigError(
            log.path(), stream,
            "holds " + declared.type +
                "; streams that can be text: pings, beams and scans of sonars, truth, returns and "
                "elements of pings, points, maps of distances, ranges, poses, readings of navigation's "
                "sensors, numbers and texts "
                "(pictures: .png and .npz)");
}

}  // namespace insonify::log
