#pragma once
#include <dds/dds.h>

#include <memory>
#include <string>

#include "components/dds/Node.hpp"

namespace insonify::dds {

struct DeleteQos {
    void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, DeleteQos>;

/** For a writer or reader as ROS 2 makes it; `type_hash` as "RIHS01_...", or empty. As it
 *  keeps the last samples only, a writer waits for no reader. */
inline Qos makeQos(const Quality& quality, const std::string& type_hash) {
    Qos qos(dds_create_qos());
    const bool reliable = quality.reliability == Reliability::Reliable;
    dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_durability(qos.get(), quality.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
    const dds_data_representation_id_t plain = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos.get(), 1, &plain);
    const std::string told = "typehash=" + type_hash + ";";
    if (!type_hash.empty()) dds_qset_userdata(qos.get(), told.data(), told.size());
    return qos;
}

}  // namespace insonify::dds
