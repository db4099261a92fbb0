#include "components/dataset/Run.hpp"

#include <map>
#include <memory>
#include <stdexcept>
#include <string_view>

namespace insonify::dataset {
namespace {

template <class List>
void append(List& list, const List& more) {
    list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

void Run::add(const types::SonarPtr& added, const types::SonarTruthPtr& its_truth) {
    const types::Sonar& ping = *added;
    const types::SonarTruth& truth = *its_truth;
    if (!pings_.empty() && (ping.bin_count != pings_[0]->bin_count || ping.beam_count != pings_[0]->beam_count))
        throw std::runtime_error("the pings of one sample differ in their beams or bins");
    pings_.push_back(added);
    truths_.push_back(its_truth);
    if (pings_.size() == 1) return;
    if (pings_.size() == 2) {
        ping_ = *pings_[0];
        truth_ = *truths_[0];
    }
    ping_.beam_count += ping.beam_count;
    append(ping_.bearings, ping.bearings);
    append(ping_.bins, ping.bins);
    append(ping_.timestamps, ping.timestamps);
    truth_.beam_count += truth.beam_count;
    append(truth_.bearings, truth.bearings);
    std::map<std::string_view, const void*> lists;
    types::SonarTruth::forEachArray(
        truth, [&](const char* name, const auto& list, auto) { lists[name] = std::addressof(list); });
    types::SonarTruth::forEachArray(truth_, [&]<class List>(const char* name, List& list, auto) {
        append(list, *static_cast<const List*>(lists.at(name)));
    });
}

}  // namespace insonify::dataset
