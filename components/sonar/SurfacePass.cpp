#include "components/sonar/SurfacePass.hpp"

#include <algorithm>

#include "components/gpu/ReadBack.hpp"

namespace insonify::sonar {
namespace {

bool hasNormalMaps(const SurfacePass::Setup& setup) { return std::ranges::count(setup.defines, "HAVE_NORMAL_MAP") > 0; }

/** How many contexts are worth their memory. */
size_t partCount(const gpu::EglContext& context, const SurfacePass::Setup& setup, const ThreadPool& threads) {
    return context.isSoftware() ? std::min(setup.frusta.size(), static_cast<size_t>(threads.size())) : 1;
}

}  // namespace

SurfacePass::SurfacePass(gpu::EglContext& context, Setup setup, ThreadPool& threads)
    : setup_(std::move(setup)),
      context_(context),
      threads_(threads),
      scene_(setup_.geometry, hasNormalMaps(setup_)),
      parts_(partCount(context, setup_, threads)),
      pictures_(setup_.frusta.size()) {
    gpu::Fence::here().wait();  // the other contexts must find the scene's buffers filled
    try {
        onEachPart([this](size_t part) { makePart(part); });
    } catch (...) {
        release();
        throw;
    }
}

void SurfacePass::resize(const std::vector<ViewFrustum>& frusta) {
    setup_.frusta = frusta;
    onEachPart([this](size_t part) { makePictures(part); });
}

SurfacePass::~SurfacePass() { release(); }

void SurfacePass::release() {
    onEachPart([this](size_t part) {
        for (size_t frustum = part; frustum < pictures_.size(); frustum += parts_.size()) pictures_[frustum].reset();
        parts_[part].painter.reset();
        parts_[part].own.reset();
    });
}

template <class Job>
void SurfacePass::onEachPart(const Job& job) {
    if (parts_.size() == 1) return job(0);
    threads_.run([&](int part, int) {
        if (static_cast<size_t>(part) < parts_.size()) job(static_cast<size_t>(part));
    });
}

void SurfacePass::makePart(size_t part) {
    if (part > 0) parts_[part].own.emplace(gpu::EglContext::Sharing{context_});
    parts_[part].painter.emplace(setup_.geometry, scene_, setup_.defines, setup_.near_plane, contextOf(part));
    makePictures(part);
}

void SurfacePass::makePictures(size_t part) {
    for (size_t frustum = part; frustum < pictures_.size(); frustum += parts_.size())
        pictures_[frustum] = std::make_unique<VisibilityBuffer>(setup_.frusta[frustum], hasNormalMaps(setup_),
                                                                setup_.draw_range_limit, contextOf(part));
}

void SurfacePass::cull(const Culler& culler) {
    placed_ = &culler.records();
    for (auto& picture : pictures_) culler.visible(picture->frustum(), picture->ranges);
}

template <class Use>
void SurfacePass::onDrawn(size_t part, const Use& use) {
    for (size_t frustum = part; frustum < pictures_.size(); frustum += parts_.size())
        if (draws(frustum)) use(*parts_[part].painter, *pictures_[frustum]);
}

void SurfacePass::draw() {
    onEachPart([this](size_t part) {
        onDrawn(part,
                [this](const SurfacePainter& painter, VisibilityBuffer& picture) { painter.list(picture, *placed_); });
        const auto alone = context_.transferring();
        onDrawn(part, [](const SurfacePainter& painter, VisibilityBuffer& picture) { painter.upload(picture); });
    });
    onEachPart([this](size_t part) {
        const auto together = context_.drawing();
        onDrawn(part, [](const SurfacePainter& painter, const VisibilityBuffer& picture) { painter.draw(picture); });
        if (context_.isSoftware()) gpu::Fence::here().wait();  // for other contexts; a card's own takes its turn
        if (parts_[part].own) parts_[part].own->check();
    });
}

void SurfacePass::bindResults(size_t frustum) const {
    context_.requireStorage(scene_.planes().size() * sizeof(PlaneRecord), "the planes of all triangles");
    pictures_[frustum]->bindTexture(0);
    scene_.bindRecords();
}

}  // namespace insonify::sonar
