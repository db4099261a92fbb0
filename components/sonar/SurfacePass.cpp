#include "components/sonar/SurfacePass.hpp"

#include <algorithm>

#include "components/gpu/ReadBack.hpp"

namespace insonify::sonar {
namespace {

bool hasNormalMaps(const SurfacePass::Setup& setup) { return std::ranges::count(setup.defines, "HAVE_NORMAL_MAP") > 0; }

/** How many contexts are worth their memory; the device culls for one. */
size_t partCount(const gpu::EglContext& context, const SurfacePass::Setup& setup, const ThreadPool& threads) {
    return context.isSoftware() && !setup.cull_on_device
               ? std::min(setup.frusta.size(), static_cast<size_t>(threads.size()))
               : 1;
}

std::unique_ptr<DrawLists> makeLists(const SurfacePass::Setup& setup, const SurfaceScene& scene, Culler& culler,
                                     gpu::EglContext& context) {
    const DrawLists::Setup lists{setup.geometry, scene, culler, setup.slots, setup.frusta.size()};
    return setup.cull_on_device ? makeDeviceLists(lists, context) : makeProcessorLists(lists);
}

}  // namespace

SurfacePass::SurfacePass(gpu::EglContext& context, Setup setup, Culler& culler, ThreadPool& threads)
    : setup_(std::move(setup)),
      context_(context),
      culler_(culler),
      threads_(threads),
      scene_(setup_.geometry, setup_.laws, hasNormalMaps(setup_)),
      lists_(makeLists(setup_, scene_, culler, context)),
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
    parts_[part].painter.emplace(scene_, setup_.defines, setup_.near_plane, contextOf(part));
    makePictures(part);
}

void SurfacePass::makePictures(size_t part) {
    for (size_t frustum = part; frustum < pictures_.size(); frustum += parts_.size())
        pictures_[frustum] =
            std::make_unique<VisibilityBuffer>(setup_.frusta[frustum], hasNormalMaps(setup_), contextOf(part));
}

void SurfacePass::cull(size_t slot) {
    lists_->place(slot);
    onEachPart([&](size_t part) {
        for (size_t frustum = part; frustum < pictures_.size(); frustum += parts_.size())
            lists_->list(slot, frustum, setup_.frusta[frustum]);
    });
}

void SurfacePass::draw(size_t slot) {
    if (parts_.size() > 1 && setup_.slots > 1) {  // other contexts draw into what this one may still read
        const auto alone = context_.transferring();
        gpu::Fence::here().wait();
    }
    onEachPart([&](size_t part) {
        // A device that culls is asked for more than draws.
        const auto alone = setup_.cull_on_device ? context_.transferring() : std::unique_lock<std::shared_mutex>();
        const auto together = setup_.cull_on_device ? std::shared_lock<std::shared_mutex>() : context_.drawing();
        lists_->prepare(slot, setup_.frusta);
        drawPart(slot, part);
        if (context_.isSoftware()) gpu::Fence::here().wait();  // for other contexts; a card's own takes its turn
        if (parts_[part].own) parts_[part].own->check();
    });
}

void SurfacePass::drawPart(size_t slot, size_t part) {
    for (size_t frustum = part; frustum < pictures_.size(); frustum += parts_.size()) {
        if (!draws(slot, frustum)) continue;
        parts_[part].painter->draw(*pictures_[frustum], lists_->draws(slot, frustum));
    }
}

void SurfacePass::bindResults(size_t slot, size_t frustum) const {
    context_.requireStorage(scene_.planes().size() * sizeof(PlaneRecord), "the planes of all triangles");
    pictures_[frustum]->bindTexture(0);
    scene_.bindRecords();
    lists_->objects(slot).bindBase(GL_SHADER_STORAGE_BUFFER, OBJECTS_BINDING);
    lists_->draws(slot, frustum).commands->bindBase(GL_SHADER_STORAGE_BUFFER, COMMANDS_BINDING);
}

}  // namespace insonify::sonar
