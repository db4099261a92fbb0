#pragma once
#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace insonify::scene {

/** A rectangle of the posts of a survey. */
struct PostWindow {
    int column = 0, row = 0, columns = 0, rows = 0;

    bool isEmpty() const { return columns <= 0 || rows <= 0; }
    bool holds(const PostWindow& other) const {
        return column <= other.column && row <= other.row && other.column + other.columns <= column + columns &&
               other.row + other.rows <= row + rows;
    }
    friend bool operator==(const PostWindow&, const PostWindow&) = default;
};

/** The reason why a survey cannot be read any further. */
class SurveyError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/** A surveyed sea floor: elevations at posts of a grid on a map, in a file that is read by blocks. Only the requested
 *  windows are read, so a file, or the files of a mosaic, may be larger than memory. */
class Survey {
public:
    virtual ~Survey() = default;

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /** Returns the distance from one post to the next, east and north [m]. North is usually negative: most files store
     *  rows from north to south. */
    glm::dvec2 spacing() const { return spacing_; }
    /** Returns the unit of the values as the file names it; empty if the file names none. */
    const std::string& unit() const { return unit_; }
    /** Returns the easting and northing of a post [m]. Column and row may be fractions. */
    glm::dvec2 place(double column, double row) const { return first_ + spacing_ * glm::dvec2(column, row); }
    /** Returns the column and row at an easting and northing. */
    glm::dvec2 postAt(const glm::dvec2& place) const { return (place - first_) / spacing_; }

    /** Returns the values of a window, row by row, as they are in the file [m]; NaN where the file has none. Throws
     *  SurveyError with the reason. */
    virtual std::vector<float> read(const PostWindow& window) const = 0;

protected:
    int columns_ = 0, rows_ = 0;
    glm::dvec2 first_{0}, spacing_{1};
    std::string unit_;
};

using SurveyOpener = std::unique_ptr<Survey> (*)(const std::filesystem::path& file, int band);

/** Opens a band of a file by the component library survey. Throws types::ConfigError if the library is absent, or if
 *  the file is not a survey, is in degrees, or is rotated against north. */
std::unique_ptr<Survey> openSurvey(const std::filesystem::path& file, int band);

/** Replaces the opener that openSurvey() uses, for programs that are linked with their opener. */
void setSurveyOpener(SurveyOpener opener);

}  // namespace insonify::scene
