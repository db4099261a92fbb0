#include "components/sonar/DrawLists.hpp"

#include <cmath>

namespace insonify::sonar {

Clip clipOf(const ObjectRecord& object, const ViewFrustum& frustum) {
    const glm::dvec4 x(object.row_x), y(object.row_y), z(object.row_z);
    const double cosine = std::cos(frustum.azimuth), sine = std::sin(frustum.azimuth);
    return {vec4((cosine * y - sine * x) / frustum.extent_u), vec4(z / frustum.extent_v), vec4(cosine * x + sine * y)};
}

NormalTransform normalTransformOf(const ObjectRecord& object, const ViewFrustum& frustum, float normal_scale) {
    const auto cosine = static_cast<float>(std::cos(frustum.azimuth)),
               sine = static_cast<float>(std::sin(frustum.azimuth));
    NormalTransform rows{
        {cosine * object.normal_x + sine * object.normal_y, cosine * object.normal_y - sine * object.normal_x,
         object.normal_z},
        {cosine * object.row_x + sine * object.row_y, cosine * object.row_y - sine * object.row_x, object.row_z}};
    rows.normal[0].w = normal_scale;
    return rows;
}

DrawLists::DrawLists(const Setup& setup) : setup_(setup) {
    for (size_t slot = 0; slot < setup.slots; ++slot) objects_.emplace_back(setup.geometry.objects.size());
}

void DrawLists::place(size_t slot) {
    objects_[slot].clear();
    for (const ObjectRecord& record : setup_.culler.records()) objects_[slot].push_back(record);
}

}  // namespace insonify::sonar
