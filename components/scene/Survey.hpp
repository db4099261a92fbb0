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

/** Why a survey cannot be read on. */
class SurveyError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/** A sea floor as it was surveyed: elevations at posts of a grid on a map, in a file that is read by blocks. Only what
 * is asked for is read, so a file, or the files that a mosaic names, may be larger than memory. */
class Survey {
public:
    virtual ~Survey() = default;

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /** From one post to the next, east and north; north is negative where rows go south, as they mostly do [m]. */
    glm::dvec2 spacing() const { return spacing_; }
    /** Unit of its values, as the file names it; empty: it names none. */
    const std::string& unit() const { return unit_; }
    /** Easting and northing of a post, whose numbers need not be whole [m]. */
    glm::dvec2 place(double column, double row) const { return first_ + spacing_ * glm::dvec2(column, row); }
    /** Column and row of an easting and northing. */
    glm::dvec2 postAt(const glm::dvec2& place) const { return (place - first_) / spacing_; }

    /** Values of a window, row by row, as the file has them [m]; NaN where it has none. Throws SurveyError with the
     *  reason. */
    virtual std::vector<float> read(const PostWindow& window) const = 0;

protected:
    int columns_ = 0, rows_ = 0;
    glm::dvec2 first_{0}, spacing_{1};
    std::string unit_;
};

using SurveyOpener = std::unique_ptr<Survey> (*)(const std::filesystem::path& file, int band);

/** Opens a band of a file, by the component library survey. Throws types::ConfigError when that is absent, or the file
 * is none, lies in degrees, or is turned against north. */
std::unique_ptr<Survey> openSurvey(const std::filesystem::path& file, int band);

/** Makes openSurvey do so by another function: for programs that are linked with it. */
void setSurveyOpener(SurveyOpener opener);

}  // namespace insonify::scene
