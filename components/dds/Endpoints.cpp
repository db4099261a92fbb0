#include "components/dds/Endpoints.hpp"

#include <dds/dds.h>

#include "types/text/ConfigError.hpp"

namespace insonify::dds {
namespace {

struct DeleteQos {
    void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, DeleteQos>;

/** Returns the quality of service of a ROS 2 writer or reader; `type_hash` as "RIHS01_...", or empty; `pairs` announced
 *  before it. Only the last samples are kept, so a writer does not wait for readers. */
Qos makeQos(const Quality& quality, const std::string& type_hash, const std::string& pairs) {
    Qos qos(dds_create_qos());
    const bool reliable = quality.reliability == Reliability::Reliable;
    dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_durability(qos.get(), quality.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
    // What late readers get has a history of its own, by default of one sample.
    if (quality.transient_local)
        dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, quality.depth, DDS_LENGTH_UNLIMITED,
                                    DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    const dds_data_representation_id_t plain = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos.get(), 1, &plain);
    if (quality.lifespan_s > 0) dds_qset_lifespan(qos.get(), DDS_SECS(quality.lifespan_s));
    const std::string reported = pairs + (type_hash.empty() ? "" : "typehash=" + type_hash + ";");
    if (!reported.empty()) dds_qset_userdata(qos.get(), reported.data(), reported.size());
    return qos;
}

}  // namespace

Writer::Writer(Node& node, const std::string& dds_topic, const std::string& ros_type, const std::string& type_hash,
               const Quality& quality, const std::string& pairs)
    : topic_(node.makeTopic(dds_topic, ddsType(ros_type))) {
    const Qos qos = makeQos(quality, type_hash, pairs);
    const dds_entity_t made = dds_create_writer(node.participant(), topic_.handle(), qos.get(), nullptr);
    if (made <= 0) throw types::ConfigError("", "topics", dds_topic + " cannot be written: " + dds_strretcode(made));
    entity_ = Entity(made);
}

bool Writer::write(const Bytes& message) {
    const dds_return_t done = dds_write(handle(), &message);
    if (done != DDS_RETCODE_OK) failure_ = dds_strretcode(done);
    return done == DDS_RETCODE_OK;
}

bool Writer::hasReaders() const {
    dds_publication_matched_status_t status{};
    return dds_get_publication_matched_status(handle(), &status) == DDS_RETCODE_OK && status.current_count > 0;
}

Reader::Reader(Node& node, const std::string& dds_topic, const std::string& ros_type, const std::string& type_hash,
               const Quality& quality, std::function<void()> arrived, size_t maximum, const std::string& pairs)
    : arrived_(std::make_unique<std::function<void()>>(std::move(arrived))),
      topic_(node.makeTopic(dds_topic, ddsType(ros_type), maximum)) {
    dds_listener_t* listener = dds_create_listener(arrived_.get());
    const auto notify = [](dds_entity_t, void* called) { (*static_cast<std::function<void()>*>(called))(); };
    if (*arrived_) dds_lset_data_available(listener, notify);
    const Qos qos = makeQos(quality, type_hash, pairs);
    const dds_entity_t made = dds_create_reader(node.participant(), topic_.handle(), qos.get(), listener);
    dds_delete_listener(listener);
    if (made <= 0) throw types::ConfigError("", "topics", dds_topic + " cannot be read: " + dds_strretcode(made));
    entity_ = Entity(made);
}

Reader::~Reader() {
    const Entity gone = std::move(entity_);  // before the function that its listener calls; waits for a running call
}

bool Reader::take(Bytes& message, uint64_t& sender) {
    dds_sample_info_t info{};
    void* into = &message;
    while (dds_take(entity_.handle(), &into, &info, 1, 1) == 1)
        if (info.valid_data) {
            sender = info.publication_handle;
            return true;
        }
    return false;
}

bool Reader::receives(uint64_t sender) const {
    dds_builtintopic_endpoint_t* found = dds_get_matched_publication_data(entity_.handle(), sender);
    if (found) dds_builtintopic_free_endpoint(found);
    return found;
}

}  // namespace insonify::dds
