#include "components/dds/RawType.hpp"

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>

namespace insonify::dds {
namespace {

/** A sample in transit, shared by Cyclone's caches. */
struct Serdata : ddsi_serdata {
    explicit Serdata(size_t maximum) : bytes(new char[maximum]), capacity(maximum) {}
    std::unique_ptr<char[]> bytes;  ///< Uninitialised.
    size_t capacity;
    uint32_t size = 0;
};

/** Cyclone's type together with our data. */
struct RawType : ddsi_sertype {
    size_t maximum = 0;  ///< Max message accepted from the network [B].
};

const RawType& own(const ddsi_sertype* type) { return *static_cast<const RawType*>(type); }

/** Reuses samples, so that a steady stream allocates nothing. Thread-safe. */
class Pool {
public:
    /** Returns null if memory is exhausted: no exception may leave through Cyclone, which drops such a sample. */
    Serdata* take(const ddsi_sertype* type, ddsi_serdata_kind kind, size_t size) noexcept try {
        Serdata* data = find(size);
        if (!data) data = new Serdata(size + size / 8 + 64);  // the next message may be slightly longer
        ddsi_serdata_init(data, type, kind);
        data->size = static_cast<uint32_t>(size);
        return data;
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
    void giveBack(Serdata* data) {
        std::unique_ptr<Serdata> mine(data);
        std::lock_guard lock(mutex_);
        if (free_.size() < free_.capacity()) free_.push_back(std::move(mine));
    }

private:
    /** Returns a sample that is large enough but not much too large. It has 3 extra bytes, because the wire is read in
     *  whole words. */
    Serdata* find(size_t size) {
        std::lock_guard lock(mutex_);
        const auto fits = [&](const auto& data) {
            return data->capacity >= size + 3 && data->capacity <= 2 * size + 256;
        };
        const auto found = std::ranges::find_if(free_, fits);
        if (found == free_.end()) return nullptr;
        std::swap(*found, free_.back());
        Serdata* data = free_.back().release();
        free_.pop_back();
        return data;
    }

    std::mutex mutex_;
    std::vector<std::unique_ptr<Serdata>> free_ = [] {
        std::vector<std::unique_ptr<Serdata>> room;
        room.reserve(24);
        return room;
    }();
};

/** Outlives Cyclone's threads. */
Pool& pool() {
    static Pool* const one = new Pool;
    return *one;
}

const Serdata& own(const ddsi_serdata* data) { return *static_cast<const Serdata*>(data); }

Serdata* copyOf(const ddsi_sertype* type, ddsi_serdata_kind kind, const char* bytes, size_t size) {
    Serdata* data = pool().take(type, kind, (size + 3) / 4 * 4);
    if (!data) return nullptr;
    if (size > 0) std::memcpy(data->bytes.get(), bytes, size);
    std::memset(data->bytes.get() + size, 0, data->size - size);
    return data;
}

ddsi_serdata* fromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* chain, size_t size) {
    if (size > own(type).maximum) return copyOf(type, kind, nullptr, 0);
    Serdata* data = pool().take(type, kind, size);
    if (!data) return nullptr;
    uint32_t filled = 0;
    for (; chain; chain = chain->nextfrag) {
        if (chain->maxp1 <= filled || chain->min > filled || chain->maxp1 > size) continue;
        const auto* payload = NN_RMSG_PAYLOADOFF(chain->rmsg, NN_RDATA_PAYLOAD_OFF(chain));
        std::memcpy(data->bytes.get() + filled, payload + (filled - chain->min), chain->maxp1 - filled);
        filled = chain->maxp1;
    }
    if (filled == size) return data;
    pool().giveBack(data);
    return nullptr;
}

ddsi_serdata* fromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* pieces, size_t size) {
    if (size > own(type).maximum) return copyOf(type, kind, nullptr, 0);
    Serdata* data = pool().take(type, kind, size);
    if (!data) return nullptr;
    size_t filled = 0;
    for (ddsrt_msg_iovlen_t i = 0; i < count && filled < size; ++i) {
        const size_t part = std::min<size_t>(pieces[i].iov_len, size - filled);
        std::memcpy(data->bytes.get() + filled, pieces[i].iov_base, part);
        filled += part;
    }
    return filled == size ? data : (pool().giveBack(data), nullptr);
}

ddsi_serdata* fromSample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
    const Bytes& bytes = *static_cast<const Bytes*>(sample);
    return copyOf(type, kind, bytes.data(), kind == SDK_DATA ? bytes.size() : 0);
}

bool toSample(const ddsi_serdata* data, void* sample, void**, void*) noexcept try {
    static_cast<Bytes*>(sample)->assign(own(data).bytes.get(), own(data).bytes.get() + own(data).size);
    return true;
} catch (const std::bad_alloc&) {
    return false;
}

void copyOut(const ddsi_serdata* data, size_t offset, size_t size, void* to) {
    std::memcpy(to, own(data).bytes.get() + offset, size);
}

ddsi_serdata* refer(const ddsi_serdata* data, size_t offset, size_t size, ddsrt_iovec_t* piece) {
    piece->iov_base = own(data).bytes.get() + offset;
    piece->iov_len = size;
    return ddsi_serdata_ref(data);
}

// Without a key, all samples belong to one instance without content.
ddsi_serdata* untyped(const ddsi_sertype* type) { return copyOf(type, SDK_KEY, nullptr, 0); }

const ddsi_serdata_ops data_operations = {
    .eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; },
    .get_size = [](const ddsi_serdata* data) { return own(data).size; },
    .from_ser = fromFragments,
    .from_ser_iov = fromPieces,
    .from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) { return untyped(type); },
    .from_sample = fromSample,
    .to_ser = copyOut,
    .to_ser_ref = refer,
    .to_ser_unref = [](ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); },
    .to_sample = toSample,
    .to_untyped = [](const ddsi_serdata* data) { return untyped(data->type); },
    .untyped_to_sample =
        [](const ddsi_sertype*, const ddsi_serdata*, void* sample, void**, void*) {
            static_cast<Bytes*>(sample)->clear();
            return true;
        },
    .free = [](ddsi_serdata* data) { pool().giveBack(static_cast<Serdata*>(data)); },
    .print = [](const ddsi_sertype*, const ddsi_serdata*, char* text, size_t size) -> size_t {
        if (size > 0) text[0] = 0;
        return 0;
    },
    .get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash, bool) { *hash = {}; },
    .get_sample_size = nullptr,  // shared memory is not used
    .from_iox_buffer = nullptr,
};

// Samples are the caller's vectors; Cyclone never lends its own.
const ddsi_sertype_ops type_operations = {
    .version = ddsi_sertype_v0,
    .arg = nullptr,
    .free =
        [](ddsi_sertype* type) {
            ddsi_sertype_fini(type);
            delete static_cast<RawType*>(type);
        },
    .zero_samples = [](const ddsi_sertype*, void*, size_t) {},
    .realloc_samples = [](void**, const ddsi_sertype*, void*, size_t, size_t) { std::abort(); },
    .free_samples = [](const ddsi_sertype*, void**, size_t, dds_free_op_t) {},
    .equal = [](const ddsi_sertype* a, const ddsi_sertype* b) { return own(a).maximum == own(b).maximum; },
    .hash = [](const ddsi_sertype*) { return uint32_t{0}; },
    .type_id = nullptr,
    .type_map = nullptr,
    .type_info = nullptr,
    .derive_sertype = nullptr,
    .get_serialized_size = nullptr,
    .serialize_into = nullptr,
};

}  // namespace

ddsi_sertype* makeRawType(const std::string& type_name, size_t maximum) {
    auto type = std::make_unique<RawType>();
    ddsi_sertype_init(type.get(), type_name.c_str(), &type_operations, &data_operations, true);
    type->maximum = maximum;
    return type.release();
}

}  // namespace insonify::dds
