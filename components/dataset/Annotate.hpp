#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "components/dataset/Instances.hpp"
#include "components/output/PlainPicture.hpp"
#include "types/Sonar.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::dataset {

/** Pixels from (x, y) on, both from the upper left corner. */
struct Box {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const Box&) const = default;
};

/** One instance as a picture shows it, or a ghost. */
struct Annotation {
    int32_t object = 0;          ///< The first of its objects, an index into the truth's list; -1: it is a ghost.
    std::vector<int32_t> parts;  ///< All of its objects.
    std::string name;
    uint32_t category = 0;                    ///< From 1.
    bool is_shadow = false;                   ///< It is the object's shadow, not its echo.
    Box box;                                  ///< Holds its pixels and the middle of each of its cells.
    uint32_t area = 0;                        ///< [px]
    uint32_t bins = 0;                        ///< Of the ping, of which it is the strongest.
    double energy = 0;                        ///< Sum of these bins, its share of each; linear.
    double range_min = 0, range_max = 0;      ///< [m]
    double bearing_min = 0, bearing_max = 0;  ///< [rad], positive to port; above pi across +-180 degrees.
    std::vector<uint32_t> runs;  ///< Pixels column by column: so many that are not of it, so many that are, and so on.
};

/** All that a picture shows, and to which object each pixel belongs. */
struct Annotated {
    std::vector<Annotation> annotations;  ///< In order of the truth's objects.
    std::vector<uint16_t> labels;         ///< Of each pixel, row by row: number of its annotation from 1; 0: none.
};

/** Finds which instances a picture shows, with AnnotationConfig::shadows which shadows, and with
 *  AnnotationConfig::ghosts which ghosts. A cell is of the instance whose object gives most energy to one of its bins,
 * if its share there is at least `min_share`, it has a class, and the cell's grey level is at least `min_level`. Where
 * most of a bin's energy came by a mirror, it is no object's: cells of such bins that touch are a ghost. What has fewer
 *  than `min_pixels` pixels is not annotated, and its pixels belong to none.
 *  @param picture that took the ping; @param bin_width exact [m]; @param ranges of each beam of a range image, which
 * has one bin [m]. Throws std::runtime_error for a truth of another grid. */
Annotated annotate(const types::Sonar& ping, const types::SonarTruth& truth, const output::PlainPicture& picture,
                   const Classes& classes, const Instances& instances, const AnnotationConfig& config,
                   output::BinScale scale, double bin_width, std::span<const float> ranges = {});

}  // namespace insonify::dataset
