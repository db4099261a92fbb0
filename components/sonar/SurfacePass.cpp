#include "components/sonar/SurfacePass.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::sonar {

SurfacePass::SurfacePass(const types::Geometry& geometry, const std::vector<Slab>& slabs, const std::vector<std::string>& defines,
                         double near_plane, size_t run_limit)
    : geometry_(geometry),
      with_normal_maps_(std::find(defines.begin(), defines.end(), "HAVE_NORMAL_MAP") != defines.end()),
      scene_(geometry, with_normal_maps_),
      program_(gpu::Program::raster("surface.vert.glsl", "surface.frag.glsl", defines)),
      picture_(with_normal_maps_ ? GL_RGBA32UI : GL_RG32UI, slabs.front().columns, slabs.front().rows),
      depth_(GL_DEPTH_COMPONENT32F, slabs.front().columns, slabs.front().rows),
      target_(picture_, depth_),
      objects_(geometry.objects.size() * sizeof(ObjectRecord)),
      records_(run_limit * sizeof(CommandRecord)),
      commands_(run_limit * sizeof(DrawCommand)),
      near_plane_(near_plane) {
    record_list_.reserve(run_limit);
    command_list_.reserve(run_limit);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glClearDepth(0);
}

void SurfacePass::place(const std::vector<ObjectRecord>& records) {
    placed_ = &records;
    if (!records.empty()) objects_.write(records.data(), records.size() * sizeof(ObjectRecord));
}

void SurfacePass::draw(const Slab& slab, const std::vector<Culler::Run>& runs) {
    target_.bind();
    glViewport(0, 0, slab.columns, slab.rows);
    const GLuint miss[4] = {};
    glClearBufferuiv(GL_COLOR, 0, miss);
    glClear(GL_DEPTH_BUFFER_BIT);
    if (runs.empty()) return;
    upload(runs);
    program_.use();
    setUniforms(slab);
    scene_.bind();
    objects_.bindBase(GL_SHADER_STORAGE_BUFFER, OBJECTS_BINDING);
    records_.bindBase(GL_SHADER_STORAGE_BUFFER, COMMANDS_BINDING);
    commands_.bind(GL_DRAW_INDIRECT_BUFFER);
    drawGroups();
}

void SurfacePass::bindResults() const {
    picture_.bind(0);
    scene_.bind();
    objects_.bindBase(GL_SHADER_STORAGE_BUFFER, OBJECTS_BINDING);
    records_.bindBase(GL_SHADER_STORAGE_BUFFER, COMMANDS_BINDING);
}

void SurfacePass::read(std::vector<uint32_t>& words) const {
    glGetTextureImage(picture_.id(), 0, channels() == 4 ? GL_RGBA_INTEGER : GL_RG_INTEGER, GL_UNSIGNED_INT,
                      static_cast<GLsizei>(words.size() * sizeof(uint32_t)), words.data());
}

void SurfacePass::setUniforms(const Slab& slab) const {
    const auto at = [&](const char* name) { return glGetUniformLocation(program_.id(), name); };
    glUniform2f(at("slab_axis"), static_cast<float>(std::cos(slab.azimuth)), static_cast<float>(std::sin(slab.azimuth)));
    glUniform2f(at("extent"), static_cast<float>(slab.extent_u), static_cast<float>(slab.extent_v));
    glUniform2f(at("pixel_size"), static_cast<float>(slab.du()), static_cast<float>(slab.dv()));
    glUniform1f(at("near_plane"), static_cast<float>(near_plane_));
}

void SurfacePass::upload(const std::vector<Culler::Run>& runs) {
    record_list_.clear();
    command_list_.clear();
    for (const Culler::Run& run : runs) {
        const SurfaceScene::MeshPlace& place = scene_.place(geometry_.objects[run.object].mesh);
        command_list_.push_back({run.index_count, 1, place.first_index + run.first_index, place.first_vertex,
                                 static_cast<uint32_t>(record_list_.size())});
        record_list_.push_back({run.object, place.first_triangle, static_cast<uint32_t>(run.material), 0});
    }
    records_.write(record_list_.data(), record_list_.size() * sizeof(CommandRecord));
    commands_.write(command_list_.data(), command_list_.size() * sizeof(DrawCommand));
}

void SurfacePass::drawGroups() const {
    const auto map = [&](size_t i) {
        return with_normal_maps_ ? geometry_.materials[record_list_[i].material].normal_map : -1;
    };
    for (size_t first = 0, last = 0; first < command_list_.size(); first = last) {
        while (last < command_list_.size() && map(last) == map(first)) ++last;
        scene_.bindNormalMap(map(first));
        glUniform1i(glGetUniformLocation(program_.id(), "mapped"), map(first) >= 0);
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, reinterpret_cast<const void*>(first * sizeof(DrawCommand)),
                                    static_cast<GLsizei>(last - first), sizeof(DrawCommand));
    }
}

}  // namespace insonify::sonar
