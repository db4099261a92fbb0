#include "components/sonar/SurfacePainter.hpp"

#include <cmath>

namespace insonify::sonar {
namespace {

VisibilityBuffer::Clip clip(const ObjectRecord& object, const ViewFrustum& frustum) {
    const glm::dvec4 x(object.row_x), y(object.row_y), z(object.row_z);
    const double cosine = std::cos(frustum.azimuth), sine = std::sin(frustum.azimuth);
    return {vec4((cosine * y - sine * x) / frustum.extent_u), vec4(z / frustum.extent_v), vec4(cosine * x + sine * y)};
}

VisibilityBuffer::NormalTransform normalTransform(const ObjectRecord& object, const ViewFrustum& frustum,
                                                  float normal_scale) {
    const auto cosine = static_cast<float>(std::cos(frustum.azimuth)),
               sine = static_cast<float>(std::sin(frustum.azimuth));
    VisibilityBuffer::NormalTransform rows{
        {cosine * object.normal_x + sine * object.normal_y, cosine * object.normal_y - sine * object.normal_x,
         object.normal_z},
        {cosine * object.row_x + sine * object.row_y, cosine * object.row_y - sine * object.row_x, object.row_z}};
    rows.normal[0].w = normal_scale;
    return rows;
}

}  // namespace

SurfacePainter::SurfacePainter(const types::Geometry& geometry, const SurfaceScene& scene,
                               const std::vector<std::string>& defines, double near_plane, gpu::EglContext& context)
    : geometry_(geometry),
      scene_(scene),
      near_plane_(near_plane),
      software_(context.isSoftware()),
      program_(context.programs().raster("surface.vert.glsl", "surface.frag.glsl", defines)) {
    const auto at = [&](const char* name) { return glGetUniformLocation(program_.id(), name); };
    uniforms_ = {at("extent"), at("pixel_size"), at("near_plane"), at("mapped")};
    scene_.describe(vertices_);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glClearDepth(0);
}

void SurfacePainter::draw(const VisibilityBuffer& picture) const {
    picture.clear();
    if (picture.empty()) return;
    program_.use();
    setUniforms(picture.frustum());
    vertices_.instanceRows(1, picture.deviceClips(), 3);
    if (scene_.withNormalMaps()) vertices_.instanceRows(7, picture.deviceNormalTransforms(), 6);
    vertices_.bind();
    drawGroups(picture);
    picture.resolve();
}

void SurfacePainter::list(VisibilityBuffer& picture, const std::vector<ObjectRecord>& placed) const {
    picture.commands.clear();
    picture.clips.clear();
    picture.normal_transforms.clear();
    picture.draws.clear();
    for (const Culler::DrawRange& range : picture.ranges) {
        const SurfaceScene::MeshPlace& place = scene_.place(geometry_.objects[range.object].mesh);
        picture.draws.push_back({range.index_count, 1, place.first_index + range.first_index, place.first_vertex,
                                 static_cast<uint32_t>(picture.commands.size())});
        picture.clips.push_back(clip(placed[range.object], picture.frustum()));
        if (scene_.withNormalMaps())
            picture.normal_transforms.push_back(
                normalTransform(placed[range.object], picture.frustum(),
                                geometry_.materials[static_cast<size_t>(range.material)].normal_scale));
        picture.commands.push_back({range.object, place.first_triangle, static_cast<uint32_t>(range.material), 0});
    }
}

void SurfacePainter::setUniforms(const ViewFrustum& frustum) const {
    glUniform2f(uniforms_.extent, static_cast<float>(frustum.extent_u), static_cast<float>(frustum.extent_v));
    const double side = frustum.samples == 4 ? 2 : 1;
    glUniform2f(uniforms_.pixel_size, static_cast<float>(side * frustum.du()), static_cast<float>(side * frustum.dv()));
    glUniform1f(uniforms_.near_plane, static_cast<float>(near_plane_));
}

void SurfacePainter::drawGroups(const VisibilityBuffer& picture) const {
    const auto map = [&](size_t i) {
        return scene_.withNormalMaps() ? geometry_.materials[picture.commands[i].material].normal_map : -1;
    };
    for (size_t first = 0, last = 0; first < picture.draws.size(); first = last) {
        while (last < picture.draws.size() && map(last) == map(first)) ++last;
        scene_.bindNormalMap(map(first));
        glUniform1i(uniforms_.mapped, map(first) >= 0);
        drawRuns(picture, first, last);
    }
}

/** Runs [first, last). Mesa's software renderer would take indirect commands one by one all the same, but look for each
 *  through what all contexts draw: see EglContext::drawing(). */
void SurfacePainter::drawRuns(const VisibilityBuffer& picture, size_t first, size_t last) const {
    const auto offset = [](size_t bytes) { return reinterpret_cast<const void*>(bytes); };
    if (!software_) {
        picture.deviceDraws().bind(GL_DRAW_INDIRECT_BUFFER);
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT,
                                    offset(first * sizeof(VisibilityBuffer::DrawCommand)),
                                    static_cast<GLsizei>(last - first), sizeof(VisibilityBuffer::DrawCommand));
        return;
    }
    for (size_t i = first; i < last; ++i) {
        const VisibilityBuffer::DrawCommand& range = picture.draws[i];
        glDrawElementsInstancedBaseVertexBaseInstance(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                                                      offset(range.first_index * sizeof(uint32_t)), 1,
                                                      static_cast<GLint>(range.base_vertex), range.base_instance);
    }
}

}  // namespace insonify::sonar
