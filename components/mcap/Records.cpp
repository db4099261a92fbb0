#include "components/mcap/Records.hpp"

namespace insonify::mcap {

void RecordWriter::raw(std::string_view data) { bytes_.insert(bytes_.end(), data.begin(), data.end()); }

}  // namespace insonify::mcap
