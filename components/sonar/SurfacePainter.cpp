#include "components/sonar/SurfacePainter.hpp"

#include <cmath>

namespace insonify::sonar {
namespace {

SlabPicture::Clip clip(const ObjectRecord& object, const Slab& slab) {
    const glm::dvec4 x(object.row_x), y(object.row_y), z(object.row_z);
    const double cosine = std::cos(slab.azimuth), sine = std::sin(slab.azimuth);
    return {vec4((cosine * y - sine * x) / slab.extent_u), vec4(z / slab.extent_v), vec4(cosine * x + sine * y)};
}

SlabPicture::Bend bend(const ObjectRecord& object, const Slab& slab, float normal_scale) {
    const auto cosine = static_cast<float>(std::cos(slab.azimuth)), sine = static_cast<float>(std::sin(slab.azimuth));
    SlabPicture::Bend rows{
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

void SurfacePainter::draw(const SlabPicture& picture) const {
    picture.clear();
    if (picture.empty()) return;
    program_.use();
    setUniforms(picture.slab());
    vertices_.instanceRows(1, picture.deviceClips(), 3);
    if (scene_.withNormalMaps()) vertices_.instanceRows(7, picture.deviceBends(), 6);
    vertices_.bind();
    drawGroups(picture);
    picture.resolve();
}

void SurfacePainter::list(SlabPicture& picture, const std::vector<ObjectRecord>& placed) const {
    picture.commands.clear();
    picture.clips.clear();
    picture.bends.clear();
    picture.draws.clear();
    for (const Culler::Run& run : picture.runs) {
        const SurfaceScene::MeshPlace& place = scene_.place(geometry_.objects[run.object].mesh);
        picture.draws.push_back({run.index_count, 1, place.first_index + run.first_index, place.first_vertex,
                                 static_cast<uint32_t>(picture.commands.size())});
        picture.clips.push_back(clip(placed[run.object], picture.slab()));
        if (scene_.withNormalMaps())
            picture.bends.push_back(bend(placed[run.object], picture.slab(),
                                         geometry_.materials[static_cast<size_t>(run.material)].normal_scale));
        picture.commands.push_back({run.object, place.first_triangle, static_cast<uint32_t>(run.material), 0});
    }
}

void SurfacePainter::setUniforms(const Slab& slab) const {
    glUniform2f(uniforms_.extent, static_cast<float>(slab.extent_u), static_cast<float>(slab.extent_v));
    const double side = slab.samples == 4 ? 2 : 1;
    glUniform2f(uniforms_.pixel_size, static_cast<float>(side * slab.du()), static_cast<float>(side * slab.dv()));
    glUniform1f(uniforms_.near_plane, static_cast<float>(near_plane_));
}

void SurfacePainter::drawGroups(const SlabPicture& picture) const {
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
void SurfacePainter::drawRuns(const SlabPicture& picture, size_t first, size_t last) const {
    const auto offset = [](size_t bytes) { return reinterpret_cast<const void*>(bytes); };
    if (!software_) {
        picture.deviceDraws().bind(GL_DRAW_INDIRECT_BUFFER);
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, offset(first * sizeof(SlabPicture::DrawCommand)),
                                    static_cast<GLsizei>(last - first), sizeof(SlabPicture::DrawCommand));
        return;
    }
    for (size_t i = first; i < last; ++i) {
        const SlabPicture::DrawCommand& run = picture.draws[i];
        glDrawElementsInstancedBaseVertexBaseInstance(GL_TRIANGLES, static_cast<GLsizei>(run.count), GL_UNSIGNED_INT,
                                                      offset(run.first_index * sizeof(uint32_t)), 1,
                                                      static_cast<GLint>(run.base_vertex), run.base_instance);
    }
}

}  // namespace insonify::sonar
