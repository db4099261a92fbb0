#include "components/sonar/multipath/PathCells.hpp"

#include <algorithm>

namespace insonify::sonar {

CellAngles::CellAngles(const TracedView& traced, const TracedTile& tile, int sample, int merged) {
    const AngularView& view = traced.cells;
    const TileShape::Extent at = traced.shape.at[sample], covered = traced.shape.size[merged];
    const int column = tile.first_column + at.columns;
    const size_t left = view.at(column), low = 2 * static_cast<size_t>(tile.first_row + at.rows);
    const auto across = static_cast<size_t>(covered.columns), up = static_cast<size_t>(covered.rows);
    const AngularView::Elevation& e = view.elevations[low + up];
    const bool cones = view.conical;
    const AngularView::Direction a =
        cones ? AngularView::computeAzimuth(view.bearings[left + across], e) : view.azimuths[left + across];
    const auto edge = [&](size_t i) { return cones ? coneAzimuth(view.bearings[i], e.angle) : view.bearings[i]; };
    cell = view.beam_of[static_cast<size_t>(column)];
    middle = {e.cosine * a.cosine, e.cosine * a.sine, e.sine};
    per_azimuth = {-e.cosine * a.sine, e.cosine * a.cosine, 0};
    per_elevation = {-e.sine * a.cosine, -e.sine * a.sine, e.cosine};
    width = edge(left + 2 * across) - edge(left);
    height = view.height(low / 2, up);
    lean = cones && std::abs(a.sine) < 0.997 ? a.sine / a.cosine * e.sine / e.cosine : 0;
    size = width * (view.elevations[low + 2 * up].sine - view.elevations[low].sine) / view.cell();
    weighted = width * (view.elevations[low + 2 * up].weighted - view.elevations[low].weighted) / view.cell();
}

HalfPath computeHalfPath(const MirrorPlane& plane, const glm::dvec3& focus, const CellAngles& at) {
    const double g = glm::dot(plane.normal, at.middle) / plane.distance, r = 1 / g;
    const glm::dvec3 place = r * at.middle, from = place - focus;
    HalfPath path;
    path.back = glm::length(from);
    path.from_focus = from / path.back;
    const double range = 0.5 * (r + path.back), along = 1 + glm::dot(path.from_focus, at.middle);
    const auto change = [&](const glm::dvec3& turn) {
        const double of_range = -r * r * glm::dot(plane.normal, turn) / plane.distance;
        return -0.5 * (along * of_range + r * glm::dot(path.from_focus, turn)) / (range * range);
    };
    path.inverse = 1 / range;
    path.per_azimuth = change(at.per_azimuth);
    path.per_elevation = change(at.per_elevation);
    const double side = glm::dot(plane.normal, focus) - plane.distance;
    const bool same_side = side * plane.distance < 0;
    path.nearest = 2 / glm::length(same_side ? plane.image(focus) : focus);
    return path;
}

void HalfPath::moveAway(double late) {
    const auto moved = [late](double range) { return std::max(range + late, 1e-3); };
    const double range = moved(1 / inverse), change = 1 / (range * range * inverse * inverse);
    inverse = 1 / range;
    per_azimuth *= change;
    per_elevation *= change;
    nearest = 1 / moved(1 / nearest);
    back = moved(back);
}

MirrorPlane planeMet(const PlacedScene& scene, const TileHits& hits, int i) {
    const PlacedRun& run = scene.ranges[hits.command[i]];
    const PlaneRecord& plane = run.planes[hits.triangle[i]];
    const glm::dvec3 n(plane.normal), p(plane.point), normal = turned(run, plane.normal);
    const double distance =
        glm::dot(n, p - glm::dvec3(run.eye[0], run.eye[1], run.eye[2])) + static_cast<double>(plane.normal.w);
    const double length = glm::length(normal);
    return {normal / length, distance / length};
}

}  // namespace insonify::sonar
