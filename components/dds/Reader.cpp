#include "components/dds/Reader.hpp"

#include <dds/dds.h>

#include "components/dds/Qos.hpp"
#include "types/ConfigError.hpp"

namespace insonify::dds {

Reader::Reader(Node& node, const std::string& dds_topic, const std::string& ros_type, const std::string& type_hash,
               const Quality& quality, std::function<void()> arrived, size_t largest)
    : arrived_(std::make_unique<std::function<void()>>(std::move(arrived))),
      topic_(node.makeTopic(dds_topic, ddsType(ros_type), largest)) {
    dds_listener_t* listener = dds_create_listener(arrived_.get());
    const auto tell = [](dds_entity_t, void* called) { (*static_cast<std::function<void()>*>(called))(); };
    if (*arrived_) dds_lset_data_available(listener, tell);
    const Qos qos = makeQos(quality, type_hash);
    const dds_entity_t made = dds_create_reader(node.participant(), topic_.handle(), qos.get(), listener);
    dds_delete_listener(listener);
    if (made <= 0) throw types::ConfigError("", "topics", dds_topic + " cannot be read: " + dds_strretcode(made));
    entity_ = Entity(made);
}

Reader::~Reader() {
    const Entity gone = std::move(entity_);  // before what its listener calls; waits for one that runs
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

bool Reader::hears(uint64_t sender) const {
    dds_builtintopic_endpoint_t* found = dds_get_matched_publication_data(entity_.handle(), sender);
    if (found) dds_builtintopic_free_endpoint(found);
    return found;
}

}  // namespace insonify::dds
