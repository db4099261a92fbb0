#include "components/dds/Writer.hpp"

#include <dds/dds.h>

#include "components/dds/Qos.hpp"
#include "types/ConfigError.hpp"

namespace insonify::dds {

Writer::Writer(Node& node, const std::string& dds_topic, const std::string& ros_type, const std::string& type_hash,
               const Quality& quality)
    : topic_(node.makeTopic(dds_topic, ddsType(ros_type))) {
    const Qos qos = makeQos(quality, type_hash);
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

}  // namespace insonify::dds
