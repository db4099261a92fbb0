#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "components/dataset/Store.hpp"

namespace insonify::dataset {

/** A page with the statistics of a data set: numbers of samples and of objects per class, their sizes and ranges, and
 *  examples with their boxes. It needs no network and no script. */
class StatisticsPage {
public:
    /** @param classes names of the classes from 1 on */
    StatisticsPage(std::string title, const std::vector<std::string>& classes)
        : title_(std::move(title)), classes_(classes) {}

    /** @param picture file in the folder of the page; empty: none */
    void add(const Json& record, const std::string& picture);
    std::string text() const;

private:
    /** Numbers by the label of a bar. */
    using Bars = std::vector<std::pair<std::string, uint64_t>>;
    struct OfClass {
        uint64_t objects = 0, samples = 0, pixels = 0;
        double nearest = 0, farthest = 0;  ///< [m]
    };

    /** Numbers of samples by the values of a setting. */
    struct OfSetting {
        std::map<double, uint64_t> numbers;
        std::map<std::string, uint64_t> others;
        void add(const Json& value);
        /** Adds a bar per value, or one bar for all numbers if there are too many. */
        void addBars(const std::string& property, Bars& bars) const;
    };

    static std::string drawn(const std::string& caption, const Bars& bars);
    std::string tableOfClasses() const;
    static std::string example(const Json& record, const std::string& picture);

    const std::string title_;
    const std::vector<std::string>& classes_;
    uint64_t samples_ = 0;
    std::map<std::string, uint64_t> parts_, scenes_;
    std::map<std::string, OfSetting> settings_;  ///< By property.
    std::map<uint32_t, OfClass> of_class_;
    std::map<int, uint64_t> areas_, ranges_;  ///< By power of two of pixels; by steps of range.
    std::map<size_t, uint64_t> objects_in_picture_;
    std::vector<std::string> examples_;
};

}  // namespace insonify::dataset
